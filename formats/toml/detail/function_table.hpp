#pragma once
/// \file [[function]] of a system file, and the text files that its tables may come from.
#include "formats/records/function_spec.hpp"
#include "formats/toml/detail/fields.hpp"

namespace bough::toml_files {

/// A table of a MATLAB or HDF5 file keeps its file and columns and has no points yet.
records::FunctionRecord read_function(const Fields& fields, const std::string& path, Diagnostics& diagnostics);

}  // namespace bough::toml_files
