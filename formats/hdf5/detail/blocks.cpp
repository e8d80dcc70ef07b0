// Reading the blocks that flexible-body and modes files share.
#include <algorithm>

#include "formats/hdf5/detail/reader.hpp"

namespace bough::hdf5 {

records::BodyMesh read_mesh(FileReader& file) {
  records::BodyMesh mesh;
  if (!file.has("/mesh")) return mesh;
  mesh.grid_id = file.read_integers("/mesh/grid_id");
  const auto num_grids = static_cast<long>(mesh.grid_id.size());
  mesh.grid_xyz = file.read_matrix("/mesh/grid_xyz");
  std::vector<std::pair<int, std::string>> order;
  for (const auto& name : file.get_children("/mesh/elements")) {
    order.emplace_back(file.read_integer_attribute("/mesh/elements/" + name, "order", 0), name);
  }
  std::sort(order.begin(), order.end());
  for (const auto& [unused, name] : order) {
    const std::string path = "/mesh/elements/" + name;
    records::BodyMesh::Block block;
    block.type = file.read_attribute(path, "type");
    block.connectivity = file.read_integer_matrix(path + "/connectivity");
    block.element_id = file.read_integers(path + "/id");
    if (block.connectivity.size() > 0 &&
        (block.connectivity.minCoeff() < 0 || block.connectivity.maxCoeff() >= num_grids)) {
      file.error("hdf5.value", path + "/connectivity points past the " + std::to_string(num_grids) + " grids",
                 "write the file again");
      block.connectivity.setZero();
    }
    mesh.blocks.push_back(std::move(block));
  }
  return mesh;
}

std::vector<Eigen::MatrixXd> read_mode_shapes(FileReader& file, long num_nodes, long num_modes) {
  const NumberArray array = file.read_array("/modes/phi", {num_nodes, 6, num_modes});
  std::vector<Eigen::MatrixXd> phi(static_cast<std::size_t>(num_nodes), Eigen::MatrixXd(6, num_modes));
  const double* x = array.data.data();
  for (auto& node : phi) {
    for (int i = 0; i < 6; ++i) {
      for (long j = 0; j < num_modes; ++j) node(i, j) = *x++;
    }
  }
  return phi;
}

std::vector<records::ModeKind> read_mode_kinds(FileReader& file) {
  std::vector<records::ModeKind> kinds;
  for (const auto& word : file.read_strings("/modes/kind")) {
    kinds.push_back(word == "constraint"   ? records::ModeKind::Constraint
                    : word == "attachment" ? records::ModeKind::Attachment
                    : word == "residual"   ? records::ModeKind::Residual
                                           : records::ModeKind::Normal);
    if (!word.empty() && word != "normal" && word != "constraint" && word != "attachment" && word != "residual") {
      file.error("hdf5.value", "/modes/kind has '" + word + "', expected normal, constraint, attachment or residual",
                 "write the file again");
    }
  }
  return kinds;
}

}  // namespace bough::hdf5
