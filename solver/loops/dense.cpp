// G row by row: generalized forces of a unit wrench at the ends of a constraint, no response, no multiplier.
#include <algorithm>
#include <optional>

#include "solver/loops/loops.hpp"

namespace bough::solver {

namespace {

/// Transpose of run_rates along the bodies between two markers and the ground.
class ForceSweep {
 public:
  ForceSweep(const Tree& tree, const TreeData& data)
      : tree_(tree), data_(data), forces_(Matrix6Xd::Zero(6, tree.size())) {}

  /// Adds to `row` (num_u) the generalized forces of a wrench at each marker, in the basis of its body.
  void add(int marker_a, const Vector6d& on_a, int marker_b, const Vector6d& on_b, Eigen::Ref<VectorXd> row) {
    int a = load(marker_a, on_a, row), b = load(marker_b, on_b, row);
    while (a >= 0 || b >= 0) {  // a parent is before its children
      const int body = std::max(a, b);
      carry(body, row);
      if (a == body) a = tree_[body].parent;
      if (b == body) b = tree_[body].parent;
    }
  }

 private:
  int load(int marker, const Vector6d& wrench, Eigen::Ref<VectorXd> row) {
    const int body = tree_.markers[static_cast<size_t>(marker)].body;
    if (body < 0) return body;
    const MarkerMotion& motion = data_.markers[static_cast<size_t>(marker)];
    const Vector3d f = wrench.head<3>();
    forces_.col(body).head<3>() += f;
    forces_.col(body).tail<3>() += motion.r.cross(f) + wrench.tail<3>();
    row.segment(tree_[body].eta_dot_offset(), motion.J.cols()).noalias() += motion.J.transpose() * wrench;
    return body;
  }

  void carry(int body, Eigen::Ref<VectorXd> row) {
    const TreeBody& tb = tree_[body];
    const BodyData& d = data_[body];
    const Vector6d F = forces_.col(body);
    forces_.col(body).setZero();
    for (int i = 0; i < d.num_free; ++i) row[tb.u_offset + d.free[i]] += d.H.col(i).dot(F);
    const int n = tb.num_modes();
    if (n > 0 && tb.on_child.moves) row.segment(tb.eta_dot_offset(), n).noalias() -= d.Jc.transpose() * F;
    if (tb.parent < 0) return;
    if (tb.on_parent.moves) {
      const TreeBody& parent = tree_[tb.parent];
      forces_.col(tb.parent).noalias() += d.X.leftCols<6>().transpose() * F;
      row.segment(parent.eta_dot_offset(), parent.num_modes()).noalias() +=
          d.X.rightCols(parent.num_modes()).transpose() * F;
    } else {
      const Vector3d f = d.R_PB * F.head<3>();
      forces_.col(tb.parent).head<3>() += f;
      forces_.col(tb.parent).tail<3>() += d.r_PoBo.cross(f) + d.R_PB * F.tail<3>();
    }
  }

  const Tree& tree_;
  const TreeData& data_;
  Matrix6Xd forces_;  ///< about the origin of each body, in its basis; zero between two calls
};

}  // namespace

MatrixXd calc_dense_rows(const Loops& loops, const Tree& tree, const TreeData& tree_data, const LoopData& data) {
  // A copy only where a coordinate is held: its column is that of the coordinate set free.
  std::optional<TreeData> copy;
  if (std::any_of(tree_data.mode.begin(), tree_data.mode.end(), [](HingeMode m) { return m != HingeMode::Free; })) {
    copy = tree_data;
    set_modes(tree, std::vector<HingeMode>(static_cast<size_t>(tree.num_u), HingeMode::Free), *copy);
    calc_position(tree, tree_data.t, tree_data.q, *copy);
  }
  const TreeData& free = copy ? *copy : tree_data;
  free.demand(Stage::Position);
  LoopData own = data;
  calc_closure_positions(loops, tree, free, own);
  // Columns of the transpose are contiguous.
  MatrixXd transposed = MatrixXd::Zero(tree.num_u, get_gaps(loops, data).size());
  ForceSweep sweep(tree, free);
  int at = 0;
  for (const LoopBlock& block : own.blocks) {
    for (const int i : block.constraints) {
      const Constraint& c = loops[i];
      for (int k = 0; c.closure && k < c.num_rows(); ++k) {
        // W as the multipliers have it: a fit that ends elsewhere in rounding may turn its basis.
        const MarkerWrenches wrenches = calc_marker_wrenches(tree, free, c.parent_marker, c.child_marker,
                                                             own[i].relative, Vector6d(data[i].own.W.col(k)));
        sweep.add(c.parent_marker, wrenches.on_parent, c.child_marker, wrenches.on_child, transposed.col(at + k));
      }
      for (const CouplerTerm& term : c.terms) transposed(term.u_row, at) += term.ratio;
      at += c.num_rows();
    }
  }
  return transposed.transpose();
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
