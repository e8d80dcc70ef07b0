#include "formats/records/flex_body.hpp"

#include "formats/records/special_nodes.hpp"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

namespace bough::records {

int FlexBody::find_node(int id) const {
  const auto it = std::find(node_id.begin(), node_id.end(), id);
  return it == node_id.end() ? -1 : static_cast<int>(it - node_id.begin());
}

bool is_special_node(const FlexBody& body, int k) {
  const auto& points = body.mesh.grid_id;
  if (points.empty() || !body.mesh.blocks.empty()) return false;
  return std::find(points.begin(), points.end(), body.node_id[static_cast<std::size_t>(k)]) == points.end();
}

int FlexBody::find_locator(int node, int direction) const {
  const auto it = std::find_if(locators.begin(), locators.end(),
                               [&](const Locator& l) { return l.node == node && l.direction == direction; });
  return it == locators.end() ? -1 : static_cast<int>(it - locators.begin());
}

void FlexBody::set_mesh_shapes(const MatrixXd& Phi) {
  const std::unordered_set<int> nodes(node_id.begin(), node_id.end());
  const auto is_drawn_without_shape = [&](const BodyMesh::Block& block) {
    return std::any_of(block.connectivity.reshaped().begin(), block.connectivity.reshaped().end(),
                       [&](int i) { return i >= 0 && nodes.count(mesh.grid_id[static_cast<std::size_t>(i)]) == 0; });
  };
  mesh_phi.resize(0, 0);
  if (std::none_of(mesh.blocks.begin(), mesh.blocks.end(), is_drawn_without_shape)) return;
  std::unordered_map<int, Eigen::Index> grid_of;
  for (std::size_t i = 0; i < mesh.grid_id.size(); ++i) grid_of[mesh.grid_id[i]] = static_cast<Eigen::Index>(i);
  mesh_phi = Eigen::MatrixXf::Zero(3 * static_cast<Eigen::Index>(mesh.grid_id.size()), Phi.cols());
  for (Eigen::Index row = 0; row < dof_map.rows(); ++row) {
    const int code = dof_map(row, 1);
    const auto grid = grid_of.find(dof_map(row, 0));
    if (grid != grid_of.end() && code >= 1 && code <= 3)
      mesh_phi.row(3 * grid->second + code - 1) = Phi.row(row).cast<float>();
  }
}

const MassIntegrals& FlexBody::integrals() const {
  if (integrals_method == "lumped") return lumped;
  if (integrals_method == "consistent") return consistent;
  return exact;
}

}  // namespace bough::records
