#pragma once
/// \file Two columns of a text file of numbers.
#include <string>
#include <vector>

#include "base/diagnostic.hpp"

namespace bough::toml_files {

/// A column by its heading, or by its number from 1.
struct ColumnChoice {
  std::string x, y;  ///< both empty: the file has two columns and no others
};

/// Text of numbers in columns (comma, semicolon, tab or spaces between; # comments; one heading line allowed, whose
/// names may be in quotation marks). Reports "toml.table-file" (cannot be read, no such column, not as many numbers
/// as the first line) and "toml.nan" with the line of that file.
void read_columns(const std::string& path, const SourceLocation& asked_at, const ColumnChoice& choice,
                  std::vector<double>& x, std::vector<double>& y, Diagnostics& diagnostics);

}  // namespace bough::toml_files
