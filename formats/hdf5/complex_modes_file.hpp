#pragma once
/// \file Complex modes of decks in HDF5 (docs/formats/modes.md).
#include <string>

#include "formats/records/complex_modes.hpp"

namespace bough::hdf5 {

/// Format "bough-complex-modes". Throws ComputationError "hdf5.write".
void write_complex_modes(const records::ComplexModesResult& modes, const std::string& path);

/// Throws InputError, as the readers of the other formats.
records::ComplexModesResult read_complex_modes(const std::string& path);

}  // namespace bough::hdf5
