#include "fe/model/model.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "base/rotation.hpp"
#include "fe/elements/stress_state.hpp"
#include "fe/model/builder.hpp"
#include "fe/model/coordinates.hpp"
#include "fe/model/named_grid.hpp"

namespace bough::fe {

Eigen::MatrixXi Model::calc_dof_map() const {
  Eigen::MatrixXi map(num_gdofs_, 2);
  for (const Node& node : nodes_)
    for (int i = 0; i < node.num_dofs; ++i) map.row(node.first_gdof + i) << node.id, (node.num_dofs == 1 ? 0 : i + 1);
  return map;
}

namespace {

/// Id and nodes of elements, by how they are drawn.
using Shapes = std::map<std::string, std::vector<std::pair<int, std::vector<int>>>>;

/// Returns true if an element is drawn; a scalar point has no position.
bool is_drawn(const ElementShape& shape, const std::vector<Node>& nodes) {
  return !shape.type.empty() && std::all_of(shape.nodes.begin(), shape.nodes.end(),
                                            [&](int k) { return nodes[static_cast<size_t>(k)].num_dofs == 6; });
}

Shapes list_shapes(const Model& model) {
  Shapes shapes;
  for (const auto& element : model.elements())
    if (ElementShape shape = element->shape(); is_drawn(shape, model.nodes()))
      shapes[shape.type].emplace_back(element->id(), std::move(shape.nodes));
  return shapes;
}

}  // namespace

records::BodyMesh Model::calc_mesh() const {
  records::BodyMesh mesh;
  std::vector<int> row(nodes_.size(), -1);
  for (size_t k = 0; k < nodes_.size(); ++k) {
    if (nodes_[k].num_dofs != 6) continue;
    row[k] = static_cast<int>(mesh.grid_id.size());
    mesh.grid_id.push_back(nodes_[k].id);
  }
  mesh.grid_xyz.resize(static_cast<int>(mesh.grid_id.size()), 3);
  for (size_t k = 0; k < nodes_.size(); ++k)
    if (row[k] >= 0) mesh.grid_xyz.row(row[k]) = nodes_[k].x.transpose();

  auto by_type = list_shapes(*this);
  for (const auto& [id, shape] : drawn_lines_) by_type[shape.type].emplace_back(id, shape.nodes);
  for (const auto& [type, members] : by_type) {
    records::BodyMesh::Block block;
    block.type = type;
    block.connectivity.resize(static_cast<int>(members.size()), static_cast<int>(members[0].second.size()));
    for (size_t e = 0; e < members.size(); ++e) {
      block.element_id.push_back(members[e].first);
      for (size_t i = 0; i < members[e].second.size(); ++i)
        block.connectivity(static_cast<int>(e), static_cast<int>(i)) = row[members[e].second[i]];
    }
    mesh.blocks.push_back(std::move(block));
  }
  return mesh;
}

void Model::add_stiffness(const Element& element, Eigen::Ref<MatrixXd> K) const {
  element.add_stiffness(1, K);
  if (prestressed_.empty()) return;
  if (const auto found = prestressed_.find(&element); found != prestressed_.end())
    element.stress_state()->add_geometric_stiffness(*found->second, 1, K);
}

int Model::find_fdof(int node_index, int component) const {
  BOUGH_DEMAND(node_index >= 0 && node_index < static_cast<int>(nodes_.size()));
  BOUGH_DEMAND(component >= 0 && component <= 6);
  return node_fdof_[node_index][component == 0 ? 0 : component - 1];
}

std::pair<int, int> Model::describe_fdof(int fdof) const {
  BOUGH_DEMAND(fdof >= 0 && fdof < num_fdofs());
  return {nodes_[fdof_node_[fdof]].id, fdof_component_[fdof]};
}

int Model::find_ldof(int grid, int component, const std::string& card, const SourceLocation& at,
                     Diagnostics& diagnostics) const {
  const int index = find_named_grid(*this, grid, card, at, diagnostics);
  if (index < 0) return -1;
  const Node& node = nodes_[index];
  const bool is_scalar = node.num_dofs == 1;
  if (is_scalar ? component > 1 : component < 1 || component > 6) {
    diagnostics.error("fe.bad-component", at,
                      card + " names component " + std::to_string(component) + " of grid " + std::to_string(grid) +
                          ", expected " + (is_scalar ? "0" : "1 to 6"),
                      "correct the component");
    return -1;
  }
  return node.first_gdof + (is_scalar ? 0 : component - 1);
}

std::string Model::name_dof(int ldof) const {
  const auto after =
      std::upper_bound(nodes_.begin(), nodes_.end(), ldof, [](int l, const Node& node) { return l < node.first_gdof; });
  const Node& node = *(after - 1);
  return "grid " + std::to_string(node.id) + " component " +
         std::to_string(node.num_dofs == 1 ? 0 : ldof - node.first_gdof + 1);
}

Model Model::with_transform(SparseRows T, const std::vector<int>& kept, OmittedSolution omitted) && {
  BOUGH_DEMAND(T.rows() == num_gdofs_ && T.cols() == static_cast<Eigen::Index>(kept.size()));
  T_ = std::move(T);
  omitted_ = std::move(omitted);
  checked_stiffness_ = nullptr;
  for (auto& slots : node_fdof_) slots.fill(-1);
  std::vector<int> node, component;
  for (const int f : kept) {
    const int k = fdof_node_[f], c = fdof_component_[f];
    node_fdof_[k][std::max(c - 1, 0)] = static_cast<int>(node.size());
    node.push_back(k);
    component.push_back(c);
  }
  fdof_node_ = std::move(node);
  fdof_component_ = std::move(component);
  return std::move(*this);
}

Model Model::with_stiffness(std::shared_ptr<const CheckedStiffness> stiffness) && {
  checked_stiffness_ = std::move(stiffness);
  return std::move(*this);
}

MatrixXd Model::calc_rigid_modes(const Vector3d& point) const {
  MatrixXd Phi_R = MatrixXd::Zero(num_gdofs_, 6);
  for (const Node& node : nodes_) {
    if (node.num_dofs != 6) continue;
    Phi_R.block<3, 3>(node.first_gdof, 0).setIdentity();
    Phi_R.block<3, 3>(node.first_gdof, 3) = -skew(node.x - point);
    Phi_R.block<3, 3>(node.first_gdof + 3, 3).setIdentity();
  }
  return Phi_R;
}

int Model::find_node(int id) const {
  const auto it = node_index_.find(id);
  return it == node_index_.end() ? -1 : it->second;
}

Matrix3d Model::calc_axes(int cid, const Vector3d& x, const SourceLocation& at, Diagnostics& diagnostics) const {
  return systems_->calc_axes(cid, x, at, diagnostics);
}

Vector3d Model::calc_point(int cid, const Vector3d& x, const SourceLocation& at, Diagnostics& diagnostics) const {
  return systems_->calc_point(cid, x, at, diagnostics);
}

Model Model::build(const records::Deck& deck, const ModelOptions& options, const ElementFactory& factory,
                   Diagnostics& diagnostics) {
  return ModelBuilder(deck, options, diagnostics).build(factory);
}

}  // namespace bough::fe
