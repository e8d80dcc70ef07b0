#include "fe/statics/finite_ties.hpp"

#include <algorithm>
#include <set>

#include "base/rotation.hpp"

namespace bough::fe {
namespace {

using Eigen::Index;

/// Grids of a mean at most: its share of the tangent stiffness is dense, 36 numbers per pair of grids.
constexpr std::size_t kMaxMeanGrids = 1000;

}  // namespace

FiniteTies::FiniteTies(const records::Deck& deck, const Model& model)
    : model_(model), arms_(model), means_(deck, model, arms_), others_(means_.others()) {
  for (const RigidArm& arm : arms_.list())
    order_.push_back({arm.node, -1, arm.translates, arm.rotates, arm.arm, {arm.parent}});
  std::vector<Tie> rest;
  for (const MeanTie& tie : means_.list()) {
    const auto& members = means_.get_mean(tie).members;
    if (members.size() > kMaxMeanGrids) {
      others_.push_back(model.node(tie.node).id);
      continue;
    }
    rest.push_back({tie.node, tie.mean, tie.translates, tie.rotates, tie.arm, {}});
    for (const MeanMember& member : members) rest.back().of.push_back(member.node);
  }
  while (!rest.empty()) {
    const auto is_ready = [&](const Tie& tie) {
      return std::none_of(rest.begin(), rest.end(), [&](const Tie& other) {
        return std::find(tie.of.begin(), tie.of.end(), other.node) != tie.of.end();
      });
    };
    const auto ready = std::stable_partition(rest.begin(), rest.end(), [&](const Tie& tie) { return !is_ready(tie); });
    BOUGH_DEMAND(ready != rest.end());
    order_.insert(order_.end(), ready, rest.end());
    rest.erase(ready, rest.end());
  }
}

std::vector<int> FiniteTies::list_nodes() const {
  std::set<int> nodes;
  for (const Tie& tie : order_) {
    nodes.insert(tie.node);
    nodes.insert(tie.of.begin(), tie.of.end());
  }
  return {nodes.begin(), nodes.end()};
}

MeanMotion FiniteTies::calc_mean(const Tie& tie, const DeformedState& state) const {
  Matrix3Xd u(3, static_cast<Index>(tie.of.size()));
  std::vector<Matrix3d> rotations;
  for (const int k : tie.of) {
    u.col(static_cast<Index>(rotations.size())) = state.u.segment<3>(first_gdof(k));
    rotations.push_back(state.R[static_cast<std::size_t>(k)]);
  }
  return MeanMotion(means_.get_mean(tie.mean), u, rotations);
}

void FiniteTies::follow(DeformedState& state) const {
  for (const Tie& tie : order_) {
    Vector3d u;
    Matrix3d R;
    if (tie.mean < 0) {
      R = state.R[static_cast<std::size_t>(tie.of[0])];
      u = state.u.segment<3>(first_gdof(tie.of[0])) + R * tie.arm - tie.arm;
    } else {
      const MeanMotion mean = calc_mean(tie, state);
      R = mean.R();
      u = mean.calc_displacement(tie.arm);
    }
    if (tie.translates) state.u.segment<3>(first_gdof(tie.node)) = u;
    if (tie.rotates) state.R[static_cast<std::size_t>(tie.node)] = R;
  }
}

/// 6 x 6n: variation of a node by that of those that it follows.
MatrixXd FiniteTies::calc_tangent(const Tie& tie, const DeformedState& state) const {
  if (tie.mean >= 0) return calc_mean(tie, state).calc_tangent(tie.arm);
  MatrixXd A = MatrixXd::Identity(6, 6);
  A.topRightCorner<3, 3>() = -skew(state.R[static_cast<std::size_t>(tie.of[0])] * tie.arm);
  return A;
}

SparseRows FiniteTies::calc_basis(const DeformedState& state) const {
  const auto num_gdofs = static_cast<std::size_t>(model_.num_gdofs());
  using Row = std::vector<std::pair<int, double>>;
  std::vector<Row> rows(num_gdofs);  // of dofs that follow; empty: the dof itself
  std::vector<char> follows(num_gdofs, 0);
  for (const Tie& tie : order_) {
    const MatrixXd A = calc_tangent(tie, state);
    for (int i = tie.translates ? 0 : 3; i < (tie.rotates ? 6 : 3); ++i) {
      Row row;
      for (Index j = 0; j < A.cols(); ++j) {
        if (A(i, j) == 0) continue;
        const int from = first_gdof(tie.of[static_cast<std::size_t>(j / 6)]) + static_cast<int>(j % 6);
        if (!follows[static_cast<std::size_t>(from)]) row.emplace_back(from, A(i, j));
        for (const auto& [column, value] : rows[static_cast<std::size_t>(from)])
          row.emplace_back(column, A(i, j) * value);
      }
      const auto to = static_cast<std::size_t>(first_gdof(tie.node) + i);
      rows[to] = std::move(row);
      follows[to] = 1;
    }
  }
  Triplets entries;
  for (std::size_t i = 0; i < num_gdofs; ++i) {
    if (!follows[i]) entries.emplace_back(static_cast<int>(i), static_cast<int>(i), 1);
    for (const auto& [column, value] : rows[i]) entries.emplace_back(static_cast<int>(i), column, value);
  }
  SparseRows basis(model_.num_gdofs(), model_.num_gdofs());
  basis.setFromTriplets(entries.begin(), entries.end());
  return basis;
}

void FiniteTies::add_slopes(const DeformedState& state, VectorXd forces, Triplets& entries) const {
  for (auto tie = order_.rbegin(); tie != order_.rend(); ++tie) {
    Eigen::Matrix<double, 6, 1> at_node = Eigen::Matrix<double, 6, 1>::Zero();
    const int first = first_gdof(tie->node);
    if (tie->translates) at_node.head<3>().swap(forces.segment<3>(first));
    if (tie->rotates) at_node.tail<3>().swap(forces.segment<3>(first + 3));
    if (at_node.isZero(0)) continue;
    MatrixXd slope;
    if (tie->mean >= 0) {
      slope = calc_mean(*tie, state).calc_slope(tie->arm, at_node.head<3>(), at_node.tail<3>());
    } else {  // the moment r × f of an arm turns with it: δ(r × f) = f̃ r̃ δφ
      slope = MatrixXd::Zero(6, 6);
      slope.bottomRightCorner<3, 3>() =
          skew(Vector3d(at_node.head<3>())) * skew(state.R[static_cast<std::size_t>(tie->of[0])] * tie->arm);
    }
    const VectorXd on_others = calc_tangent(*tie, state).transpose() * at_node;
    const auto get_gdof = [&](Index row) {
      return first_gdof(tie->of[static_cast<std::size_t>(row / 6)]) + static_cast<int>(row % 6);
    };
    for (Index i = 0; i < slope.rows(); ++i) {
      forces[get_gdof(i)] += on_others[i];
      for (Index j = 0; j < slope.cols(); ++j)
        if (slope(i, j) != 0) entries.emplace_back(get_gdof(i), get_gdof(j), slope(i, j));
    }
  }
}

}  // namespace bough::fe
