#pragma once
/// \file The file that `compare -o` writes (docs/formats/comparison.md), and reading it back.
#include <string>

#include "formats/records/comparison.hpp"

namespace bough::hdf5 {

/// Format "bough-comparison". Throws ComputationError "hdf5.write".
void write_comparison(const records::Comparison& comparison, const std::string& path);
/// Every array and list of words of the file, each array with at most two dimensions.
records::Comparison read_comparison(const std::string& path);

}  // namespace bough::hdf5
