#include "analysis/common/vtu_file.hpp"

namespace bough::analysis {

std::string make_vtu_text(const exports::Picture& picture, exports::VtuEncoding encoding, const std::string& file,
                          Diagnostics& diagnostics) {
  if (picture.num_missing > 0) {
    const auto shown = picture.mesh.grid_id.size();
    diagnostics.warning("export.partial-shapes", {file},
                        "mode shapes at " + std::to_string(shown) + " of " +
                            std::to_string(shown + static_cast<std::size_t>(picture.num_missing)) +
                            " grids, the others are not drawn",
                        "reduce with --full, or without a list of output nodes");
  }
  return exports::make_vtu(picture.mesh, picture.arrays, encoding, picture.cells);
}

}  // namespace bough::analysis
