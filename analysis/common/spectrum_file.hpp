#pragma once
/// \file CSV files of spectral densities.
#include <string>
#include <vector>

#include "solver/statespace/spectrum.hpp"

namespace bough::analysis {

/// Header "frequency_hz,NAME,..." of inputs, or any one name for all of them; then rows of numbers.
/// \param inputs  names of the model, a column of the density each if the header names some of them.
/// \param id      of the InputError with file and line: a negative or missing number, frequencies that do not rise, a
/// name that is no input.
statespace::Spectrum read_spectrum(const std::string& path, const std::vector<std::string>& inputs,
                                   const std::string& id);

}  // namespace bough::analysis
