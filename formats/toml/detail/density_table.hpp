#pragma once
/// \file Tables of spectral densities: [[psd]] of a file, psd of a source of a pointing budget.
#include "formats/records/input_density.hpp"
#include "formats/toml/detail/fields.hpp"

namespace bough::toml_files {

/// Reads one density; names of files are relative to `path`. Reports "linear.bad-psd" and those of read_columns.
records::InputDensity read_density(const Fields& table, const std::string& path, Diagnostics& diagnostics);

/// Reads a file and checks it against a schema. \return false if it has an error, which is reported.
bool read_checked(const std::string& path, const char* schema_text, Value& root, Diagnostics& diagnostics);

}  // namespace bough::toml_files
