#pragma once
/// \file `check` of what `static` and `matrices` write: what the file holds, without reading its numbers.
#include <nlohmann/json.hpp>
#include <string>

#include "base/diagnostic.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::cli {

/// Adds to text and json; reports "hdf5.missing".
void check_static(const std::string& path, const hdf5::FileInfo& info, std::string& text, nlohmann::json& json,
                  Diagnostics& diagnostics);
void check_matrices(const std::string& path, const hdf5::FileInfo& info, std::string& text, nlohmann::json& json,
                    Diagnostics& diagnostics);

}  // namespace bough::cli
