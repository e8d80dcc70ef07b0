#include "fe/corotational/corotational_element.hpp"

#include <algorithm>
#include <cmath>

#include "base/rotation.hpp"
#include "fe/corotational/fitted_core.hpp"
#include "fe/elements/solve_in_range.hpp"
#include "fe/elements/stress_state.hpp"

namespace bough::fe {

namespace {

/// Weight of the nodes' rotations in the frame per mean square distance of the nodes: it decides the twist of a line,
/// and little else. Any value gives the same V to third order.
constexpr double kRotationWeight = 1e-3;
constexpr double kRigidTolerance = 1e-8;  // of K times rigid-body motion

}  // namespace

bool CorotationalElement::find_stiffness(const Element& element, const std::vector<Node>& nodes) {
  const int N = element.num_dofs();
  K_ = MatrixXd::Zero(N, N);
  element.add_stiffness(1, K_);
  return find_nodes(element, nodes) && is_free_of_rigid_motion();
}

bool follows_nodes(const Element& element, const std::vector<Node>& nodes) {
  return CorotationalElement().find_stiffness(element, nodes);
}

CorotationalElement::CorotationalElement(const Element& element, const std::vector<Node>& nodes) {
  follows_nodes_ = find_stiffness(element, nodes);
  if (!follows_nodes_) return;
  set_frame();
  const auto* connector = dynamic_cast<const Connector*>(&element);
  if (connector && !connector->data().ends.empty())
    fitted_ = std::make_shared<const FittedCore>(*connector);
  else
    set_local_strains(element);
}

/// True when the dofs are all translations of some grids, and all rotations of some of these.
bool CorotationalElement::find_nodes(const Element& element, const std::vector<Node>& nodes) {
  const auto& gdofs = element.gdofs();
  const auto find_row = [&](int dof) {
    const auto it = std::find(gdofs.begin(), gdofs.end(), dof);
    return it == gdofs.end() ? -1 : static_cast<int>(it - gdofs.begin());
  };
  std::vector<Vector3d> places;
  int num_rows = 0;
  for (const int index : element.nodes()) {
    if (std::find(grids_.begin(), grids_.end(), index) != grids_.end()) continue;
    grids_.push_back(index);
    const Node& node = nodes[static_cast<std::size_t>(index)];
    const int row = find_row(node.first_gdof);
    const auto is_block = [&](int first) {
      return first >= 0 && first + 2 < element.num_dofs() &&
             gdofs[static_cast<std::size_t>(first) + 2] == gdofs[static_cast<std::size_t>(first)] + 2;
    };
    if (node.num_dofs != 6 || !is_block(row)) return false;
    const int turn = find_row(node.first_gdof + 3);
    if (turn >= 0 && !is_block(turn)) return false;
    translations_.push_back(row);
    rotations_.push_back(turn);
    places.push_back(node.x);
    num_rows += turn >= 0 ? 6 : 3;
  }
  if (places.empty() || num_rows != element.num_dofs()) return false;
  arms_.resize(3, static_cast<Eigen::Index>(places.size()));
  for (Eigen::Index k = 0; k < arms_.cols(); ++k) arms_.col(k) = places[static_cast<std::size_t>(k)];
  arms_.colwise() -= arms_.rowwise().mean().eval();
  return true;
}

bool CorotationalElement::is_free_of_rigid_motion() const {
  // The row of a dof that the motion hardly strains has roundoff alone: its size is that of the diagonals.
  const VectorXd size = K_.diagonal().cwiseMax(0).cwiseSqrt();
  for (int c = 0; c < 6; ++c) {
    VectorXd u = VectorXd::Zero(K_.rows());
    for (std::size_t k = 0; k < translations_.size(); ++k) {
      const Vector3d e = Vector3d::Unit(c % 3);
      u.segment<3>(translations_[k]) = c < 3 ? e : Vector3d(e.cross(arms_.col(static_cast<Eigen::Index>(k))));
      if (c >= 3 && rotations_[k] >= 0) u.segment<3>(rotations_[k]) = e;
    }
    if (((K_ * u).array().abs() > kRigidTolerance * size.dot(u.cwiseAbs()) * size.array()).any()) return false;
  }
  return true;
}

void CorotationalElement::set_frame() {
  rotation_weight_ = kRotationWeight * arms_.squaredNorm() / static_cast<double>(arms_.cols());
  if (rotation_weight_ == 0) rotation_weight_ = 1;
  Matrix3d H = arms_ * arms_.transpose();
  for (const int row : rotations_)
    if (row >= 0) H += rotation_weight_ * Matrix3d::Identity();
  frame_inverse_ = invert_symmetric(H.trace() * Matrix3d::Identity() - H);
}

void CorotationalElement::set_local_strains(const Element& element) {
  const StressState* state = element.stress_state();
  const int N = num_dofs(), s = state ? state->num_internal_forces() : 0;
  F_ = MatrixXd::Zero(s, N);
  if (s == 0) return;
  state->calc_internal_forces_of(MatrixXd::Identity(N, N), F_);
  for (int m = 0; m < s; ++m) {
    MatrixXd P = MatrixXd::Zero(N, N);
    state->add_geometric_stiffness(VectorXd::Unit(s, m), 1, P);
    P_.push_back(0.5 * (P + P.transpose()));
  }
  E_ = F_ * solve_in_range(K_, F_.transpose());
}

}  // namespace bough::fe
