// Minimal coordinates of a plant with closed loops.
#include <algorithm>

#include "solver/linear/plant.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {
namespace {

constexpr double kDependent = 1e-9;  // of the largest pivot
/// Modes follow only where no hinge coordinate can.
constexpr double kModeWeight = 1e-3;

[[noreturn]] void fail_dead(const Loops& loops, const Assembly& found) {
  const Constraint& c = loops[std::max(0, found.worst)];
  throw ComputationError("linear.dead-point", c.at,
                         "the loop of constraint '" + c.name +
                             "' cannot follow its independent coordinates there: they stand at or near a dead point",
                         "linearize somewhere else, or start there, so that others are chosen as independent");
}

}  // namespace

void Plant::choose_independent(double t, const VectorXd& q) {
  if (data_->loops.blocks.empty()) return;
  calc_position(system_.tree, t, q, data_->tree);
  calc_closure_positions(system_.loops, system_.tree, data_->tree, data_->loops);
  const MatrixXd G = calc_dense_rows(system_.loops, system_.tree, data_->tree, data_->loops);
  const VectorXd sizes = calc_row_sizes(system_.loops, data_->loops);
  MatrixXd own(G.rows(), num_dofs());
  for (int j = 0; j < num_dofs(); ++j)
    own.col(j) = G.col(rows_[static_cast<size_t>(j)]) * step(j) * (is_mode(j) ? kModeWeight : 1);
  // A row of a rotation and one of a displacement count alike in any unit of length.
  for (Eigen::Index i = 0; i < own.rows(); ++i)
    if (sizes[i] > 0) own.row(i) /= sizes[i];
  grip_.assign(static_cast<size_t>(system_.num_u()), AssemblyPriority::Fixed);
  if (own.cols() == 0) return;
  Eigen::ColPivHouseholderQR<MatrixXd> factor;
  factor.setThreshold(kDependent);
  factor.compute(own);
  std::vector<bool> follows(dofs_.size(), false);
  for (Eigen::Index k = 0; k < factor.rank(); ++k)
    follows[static_cast<size_t>(factor.colsPermutation().indices()[k])] = true;
  position_grip_ = grip_;
  std::vector<bool> is_bound = follows;  // dependent positions: all, or some if constraints act on rates only
  if (has_rate_rows(system_.loops, data_->loops)) {
    std::vector<int> columns;
    for (size_t j = 0; j < dofs_.size(); ++j)
      if (follows[j]) columns.push_back(static_cast<int>(j));
    is_bound.assign(dofs_.size(), false);
    const MatrixXd positions = own(list_position_rows(system_.loops, data_->loops), columns);
    if (positions.size() > 0) {
      Eigen::ColPivHouseholderQR<MatrixXd> bound;
      bound.setThreshold(kDependent);
      bound.compute(positions);
      for (Eigen::Index k = 0; k < bound.rank(); ++k)
        is_bound[static_cast<size_t>(columns[static_cast<size_t>(bound.colsPermutation().indices()[k])])] = true;
    }
  }
  std::vector<Dof> kept_dofs;
  std::vector<int> rows;
  for (size_t j = 0; j < dofs_.size(); ++j) {
    if (is_bound[j]) position_grip_[static_cast<size_t>(rows_[j])] = AssemblyPriority::Free;
    if (follows[j]) {
      grip_[static_cast<size_t>(rows_[j])] = AssemblyPriority::Free;
      if (is_bound[j]) continue;
      paths_.push_back(dofs_[j]);
      path_rows_.push_back(rows_[j]);
      continue;
    }
    kept_dofs.push_back(dofs_[j]);
    rows.push_back(rows_[j]);
  }
  dofs_ = std::move(kept_dofs);
  rows_ = std::move(rows);
}

void Plant::close_positions(VectorXd& q) const {
  const Assembly found =
      assemble_positions(system_.loops, system_.tree, t_, position_grip_, q, data_->tree, data_->loops);
  if (!found.is_closed) fail_dead(system_.loops, found);
}

/// Dependent rates at the positions of the tree: the rates of all coordinates (num_u rows), a column for the unit rate
/// of each dof. The rows of the loops depend on positions alone: one factor serves all columns.
MatrixXd Plant::calc_follow() const {
  const TreeData& tree = data_->tree;
  MatrixXd rates = MatrixXd::Zero(system_.num_u(), 1 + num_dofs());
  for (int j = 0; j < num_dofs(); ++j) rates.col(1 + j) = expand(VectorXd::Unit(num_dofs(), j));
  for (int row = 0; row < system_.num_u(); ++row)
    if (tree.mode[static_cast<size_t>(row)] != HingeMode::Free) rates.row(row).setConstant(tree.given_u[row]);
  if (has_loops()) close_rates(rates);
  return rates.rightCols(num_dofs()).colwise() - VectorXd(rates.col(0));
}

/// Small displacements of all coordinates (num_u rows), a column for each dof and path coordinate. After
/// calc_kinematics.
MatrixXd Plant::calc_position_follow(const OperatingPoint& point) const {
  calc_kinematics(system_, *data_, point.t, point.q, calc_speeds(point));
  const int n = num_dofs(), m = num_paths();
  MatrixXd follow(system_.num_u(), n + m);
  for (int j = 0; j < n; ++j) follow.col(j) = expand_positions(VectorXd::Unit(n, j), VectorXd::Zero(m));
  for (int j = 0; j < m; ++j) follow.col(n + j) = expand_positions(VectorXd::Zero(n), VectorXd::Unit(m, j));
  calc_closure_positions(system_.loops, system_.tree, data_->tree, data_->loops);
  const std::vector<int> rows = list_position_rows(system_.loops, data_->loops);
  if (rows.empty()) return follow;
  const MatrixXd G = calc_dense_rows(system_.loops, system_.tree, data_->tree, data_->loops)(rows, Eigen::all);
  std::vector<int> bound;
  for (int row = 0; row < system_.num_u(); ++row)
    if (position_grip_[static_cast<size_t>(row)] == AssemblyPriority::Free) bound.push_back(row);
  follow(bound, Eigen::all) =
      -MatrixXd(G(Eigen::all, bound)).completeOrthogonalDecomposition().solve(MatrixXd(G * follow));
  return follow;
}

void Plant::close_rates(Eigen::Ref<MatrixXd> rates) const {
  calc_closure_positions(system_.loops, system_.tree, data_->tree, data_->loops);
  const Assembly found = assemble_rates(system_.loops, system_.tree, grip_, rates, data_->tree, data_->loops);
  if (!found.is_closed) fail_dead(system_.loops, found);
}

VectorXd Plant::calc_speeds(const OperatingPoint& point) const {
  if (!has_loops()) return expand(point.u);
  calc_kinematics(system_, *data_, point.t, point.q, expand(point.u));
  VectorXd u = data_->tree.u;
  close_rates(u);
  return u;
}

}  // namespace bough::solver
