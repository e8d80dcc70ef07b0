#include "solver/system/impact.hpp"

#include <algorithm>
#include <cmath>

#include "solver/system/mobility.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {
namespace {

constexpr double kRounding = 1e-12;  // of the rates before
constexpr double kTwice = 1e-10;     // relative to the largest pivot: smaller pivots are redundant
constexpr int kMaxExchanges = 2000;

VectorXd solve_active(const MatrixXd& A, const VectorXd& target, const std::vector<int>& active) {
  VectorXd p = VectorXd::Zero(target.size());
  if (active.empty()) return p;
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> factor;
  factor.setThreshold(kTwice);
  factor.compute(A(active, active));
  p(active) = VectorXd(factor.solve(VectorXd(target(active))));
  return p;
}

// Factors the tree and its loops at the kinematics of `system_data`.
void factor_mass(const System& system, SystemData& system_data) {
  TreeData& data = system_data.tree;
  calc_factor(system.tree, data);
  if (system_data.loops.blocks.empty()) return;
  calc_closure_positions(system.loops, system.tree, data, system_data.loops);
  factor_loops(system.loops, system.tree, data, system_data.loops);
}

// Rates of the tree by a unit impulse along `row`; loops open.
VectorXd calc_tree_response(const System& system, TreeData& data, int row) {
  Sweep& s = start_response(data);
  s.tau[row] = 1;
  run_response(system.tree, data, s);
  return s.u_dot;
}

// M⁻¹ of a unit impulse along each row, loops closed: num_u x blows.
MatrixXd calc_responses(const System& system, SystemData& system_data, const std::vector<Impact>& blows) {
  TreeData& data = system_data.tree;
  MatrixXd D(system.tree.num_u, static_cast<Eigen::Index>(blows.size()));
  factor_mass(system, system_data);
  for (size_t j = 0; j < blows.size(); ++j) {
    VectorXd du = calc_tree_response(system, data, blows[j].row);
    if (!system_data.loops.blocks.empty()) remove_normal(system.loops, system.tree, data, system_data.loops, du);
    D.col(static_cast<Eigen::Index>(j)) = du;
  }
  for (int row = 0; row < system.tree.num_u; ++row) {
    if (data.mode[static_cast<size_t>(row)] != HingeMode::Free) D.row(row).setZero();
  }
  return D;
}

}  // namespace

VectorXd solve_impact_lcp(const MatrixXd& A, const VectorXd& v, const VectorXd& e) {
  const auto n = v.size();
  const VectorXd target = -(1 + e.array()) * v.array();
  const double slow = kRounding * v.cwiseAbs().maxCoeff();
  const double weak = slow / std::max(A.diagonal().maxCoeff(), std::numeric_limits<double>::min());
  std::vector<bool> is_active(static_cast<size_t>(n), true);
  VectorXd p;
  for (int round = 0; round < kMaxExchanges; ++round) {
    std::vector<int> active;
    for (int i = 0; i < n; ++i) {
      if (is_active[static_cast<size_t>(i)]) active.push_back(i);
    }
    p = solve_active(A, target, active);
    const VectorXd short_of = target - A * p;
    int wrong = 0;
    while (wrong < n && !(is_active[static_cast<size_t>(wrong)] ? p[wrong] < -weak : short_of[wrong] > slow)) ++wrong;
    if (wrong == n) return p.cwiseMax(0);
    is_active[static_cast<size_t>(wrong)] = !is_active[static_cast<size_t>(wrong)];
  }
  // Not reached if A is positive definite: apply the largest impact only.
  int hardest = 0;
  v.minCoeff(&hardest);
  return solve_active(A, target, {hardest}).cwiseMax(0);
}

Mobility calc_mobility(const System& system, SystemData& system_data, int row) {
  factor_mass(system, system_data);
  VectorXd du = calc_tree_response(system, system_data.tree, row);
  const double open = du[row];
  if (!system_data.loops.blocks.empty())
    remove_normal(system.loops, system.tree, system_data.tree, system_data.loops, du);
  return {open, du[row]};
}

void strike(const System& system, SystemData& system_data, double t, const Eigen::Ref<const VectorXd>& q,
            std::vector<Impact>& blows, Eigen::Ref<VectorXd> u, double& work) {
  TreeData& data = system_data.tree;
  const auto n = static_cast<Eigen::Index>(blows.size());
  calc_kinematics(system.tree, t, q, u, data);
  const double before = calc_energies(system, system_data).kinetic;
  const MatrixXd D = calc_responses(system, system_data, blows);
  MatrixXd A(n, n);
  VectorXd v(n), e(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Impact& own = blows[static_cast<size_t>(i)];
    BOUGH_DEMAND(data.mode[static_cast<size_t>(own.row)] == HingeMode::Free);
    v[i] = -own.side * data.u[own.row];
    e[i] = own.restitution;
    for (Eigen::Index j = 0; j < n; ++j) A(i, j) = own.side * blows[static_cast<size_t>(j)].side * D(own.row, j);
  }
  A = (0.5 * (A + A.transpose())).eval();
  VectorXd p = solve_impact_lcp(A, v, e);
  if (p.dot(2 * v + A * p) > kRounding * std::abs(p.dot(v))) {  // twice what it gives
    e.setConstant(e.minCoeff());
    p = solve_impact_lcp(A, v, e);
  }
  u = data.u;
  const VectorXd after = v + A * p;
  for (Eigen::Index i = 0; i < n; ++i) {
    Impact& own = blows[static_cast<size_t>(i)];
    own.impulse = -own.side * p[i];
    u += own.impulse * D.col(i);
  }
  // A rebounding coordinate gets its rate without round-off.
  const double close = 1e-9 * v.cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < n; ++i) {
    const Impact& own = blows[static_cast<size_t>(i)];
    if (p[i] > 0 && std::abs(after[i] + e[i] * v[i]) <= close) u[own.row] = own.side * e[i] * v[i] + 0.0;  // no -0
  }
  calc_velocity(system.tree, u, data);
  work += calc_energies(system, system_data).kinetic - before;
}

}  // namespace bough::solver
