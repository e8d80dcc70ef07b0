#pragma once
/// \file Spectral densities of the inputs of a linear model from the command line and from files.
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/records/input_density.hpp"
#include "formats/records/linear_model.hpp"
#include "solver/statespace/frequency_response.hpp"
#include "solver/statespace/random_outputs.hpp"

namespace bough::analysis {

/// Reads each item: a NUMBER for all inputs, NAME=NUMBER, a TOML file of [[psd]] or a CSV file of a column for each
/// input or one for all.
///
/// \param file  the linear model, for messages.
/// \throws InputError "linear.bad-psd" (negative, not Hermitian, indefinite), "linear.unknown-input", "cli.no-file".
statespace::InputSpectrum read_input_spectrum(const std::vector<std::string>& items, const records::LinearModel& model,
                                              const std::string& file);

/// Makes the spectrum of the densities of one source. Reports "linear.bad-psd", "linear.unknown-input".
statespace::InputSpectrum make_input_spectrum(const std::vector<records::InputDensity>& densities,
                                              const records::LinearModel& model, Diagnostics& diagnostics);

/// Sets the range to the band of the densities where it is open, and adds their corners; from 0 if G(0) is finite.
void choose_band(const records::LinearModel& model, const statespace::InputSpectrum& input,
                 statespace::FrequencyRange& range);

/// Files among the items.
std::vector<std::string> list_spectrum_files(const std::vector<std::string>& items);

/// \throws InputError "linear.bad-psd" where S is not positive semi-definite at one of the frequencies.
void check_input_spectrum(const statespace::InputSpectrum& input, const std::vector<double>& hz,
                          const std::vector<std::string>& items, const std::string& file);

}  // namespace bough::analysis
