#pragma once
/// \file The file that `compare -o` writes (docs/formats/comparison.md).
#include <string>

#include "formats/records/comparison.hpp"

namespace bough::hdf5 {

/// Format "bough-comparison". Throws ComputationError "hdf5.write".
void write_comparison(const records::Comparison& comparison, const std::string& path);

}  // namespace bough::hdf5
