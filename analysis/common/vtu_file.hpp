#pragma once
/// \file Mode shapes on their way to a .vtu file.
#include <string>

#include "base/diagnostic.hpp"
#include "formats/export/vtu.hpp"

namespace bough::analysis {

/// The text; adds "export.partial-shapes" (warning) when some grids of `file` have no shape.
std::string make_vtu_text(const exports::Picture& picture, exports::VtuEncoding encoding, const std::string& file,
                          Diagnostics& diagnostics);

}  // namespace bough::analysis
