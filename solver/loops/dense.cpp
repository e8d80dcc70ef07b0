// G by unit speeds: no response, no multiplier.
#include <algorithm>
#include <optional>

#include "solver/loops/loops.hpp"

namespace bough::solver {

MatrixXd calc_dense_rows(const Loops& loops, const Tree& tree, const TreeData& tree_data, const LoopData& data) {
  // A copy only where a coordinate is held: its column is that of the coordinate set free.
  std::optional<TreeData> copy;
  if (std::any_of(tree_data.mode.begin(), tree_data.mode.end(), [](HingeMode m) { return m != HingeMode::Free; })) {
    copy = tree_data;
    set_modes(tree, std::vector<HingeMode>(static_cast<size_t>(tree.num_u), HingeMode::Free), *copy);
    calc_position(tree, tree_data.t, tree_data.q, *copy);
  }
  const TreeData& free = copy ? *copy : tree_data;
  LoopData own = data;
  calc_closure_positions(loops, tree, free, own);
  MatrixXd G = MatrixXd::Zero(get_gaps(loops, data).size(), tree.num_u);
  Sweep sweep = free.response;
  for (int column = 0; column < tree.num_u; ++column) {
    run_rates(tree, free, VectorXd::Unit(tree.num_u, column), sweep);
    int at = 0;
    for (const LoopBlock& block : own.blocks) {
      for (const int i : block.constraints) {
        const int n = loops[i].num_rows();
        // W as the multipliers have it: a fit that ends elsewhere in rounding may turn its basis.
        const Constraint& c = loops[i];
        if (c.closure)
          G.col(column).segment(at, n) =
              data[i].own.W.leftCols(n).transpose() *
              calc_relative_response(tree, free, c.parent_marker, c.child_marker, own[i].relative, sweep);
        for (const CouplerTerm& term : loops[i].terms) {
          if (term.u_row == column) G(at, column) += term.ratio;
        }
        at += n;
      }
    }
  }
  return G;
}

void calc_dense_accelerations(const Loops& loops, const Tree& tree, const TreeData& tree_data, const LoopData& data,
                              Eigen::Ref<VectorXd> u_dot) {
  tree_data.demand(Stage::Acceleration);
  const MatrixXd G = calc_dense_rows(loops, tree, tree_data, data);
  MatrixXd mass;
  VectorXd force;
  calc_dense_equations(tree, tree_data, mass, force);
  std::vector<int> free;
  for (int row = 0; row < tree.num_u; ++row) {
    if (tree_data.mode[static_cast<size_t>(row)] == HingeMode::Free) free.push_back(row);
  }
  const auto n = static_cast<Eigen::Index>(free.size()), m = G.rows();
  MatrixXd system = MatrixXd::Zero(n + m, n + m);
  const MatrixXd own = G(Eigen::all, free);
  system.topLeftCorner(n, n) = mass(free, free);
  system.bottomLeftCorner(m, n) = own;
  system.topRightCorner(n, m) = own.transpose();
  VectorXd right(n + m);
  right << VectorXd(force(free)), own * VectorXd(tree_data.motion.u_dot(free));
  const VectorXd solution = system.completeOrthogonalDecomposition().solve(right);
  u_dot = tree_data.motion.u_dot;
  for (Eigen::Index i = 0; i < n; ++i) u_dot[free[static_cast<size_t>(i)]] = solution[i];
}

}  // namespace bough::solver
