#pragma once
/// \file [body.matrices] of a body file, and what names a matrix.
#include <optional>

#include "formats/records/matrices_spec.hpp"
#include "formats/toml/detail/fields.hpp"

namespace bough::toml_files {

/// Empty without the table. `path`: the body file.
std::optional<records::MatricesSpec> read_matrices_spec(const Fields& body, const std::string& path,
                                                        Diagnostics& diagnostics);

}  // namespace bough::toml_files
