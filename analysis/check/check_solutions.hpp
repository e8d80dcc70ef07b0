#pragma once
/// \file `check` of the files of `static` and `matrices`: their contents, without reading the numbers.
#include <string>

#include "analysis/check/check.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::analysis {

/// Reports "hdf5.missing".
StaticCheck check_static(const std::string& path, const hdf5::FileInfo& info, Diagnostics& diagnostics);
MatricesCheck check_matrices(const std::string& path, const hdf5::FileInfo& info, Diagnostics& diagnostics);

}  // namespace bough::analysis
