#include "formats/hdf5/grids_file.hpp"

#include "formats/hdf5/detail/reader.hpp"

namespace bough::hdf5 {

std::string read_format(const std::string& path) {
  FileReader file(path);
  return file.read_attribute("/", "format");
}

std::optional<GridsFile> read_grids(const std::string& path) {
  FileReader file(path);
  if (!file.has("/grids/id") || !file.has("/grids/xyz")) return {};
  GridsFile grids;
  grids.id = file.read_integers("/grids/id", -1);
  grids.xyz = file.read_matrix("/grids/xyz", static_cast<long>(grids.id.size()), 3);
  file.throw_if_errors();
  return grids;
}

}  // namespace bough::hdf5
