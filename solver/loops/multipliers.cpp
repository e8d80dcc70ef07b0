// G M⁻¹ Gᵀ and what is done with it: accelerations, projections, impulses.
#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/forces/applied.hpp"
#include "solver/loops/loops.hpp"

namespace bough::solver {

namespace {

constexpr int kMaxProjections = 6;
constexpr double kClosed = 1e-14;
/// Smallest pivot of a row, relative to the largest of its constraint. Near a change point a row moves in proportion to
/// the square of the distance θ from it, and round-off of the position error makes an acceleration of 1e-15/θ³: at
/// θ = 1e-5 this exceeds the accelerations that the row controls.
constexpr double kVoid = 1e-10;

// Adds a share of row k of a constraint to a sweep that was started.
void add_row(const Constraint& c, const ConstraintData& d, int k, double share, const Tree& tree,
             const TreeData& tree_data, Sweep& s) {
  if (!c.closure) {
    for (const CouplerTerm& term : c.terms) s.tau[term.u_row] += share * term.ratio;
    return;
  }
  const MarkerWrenches w = calc_marker_wrenches(tree, tree_data, c.parent_marker, c.child_marker, d.relative,
                                                Vector6d(share * d.own.W.col(k)));
  add_response_wrench(tree, tree_data, c.parent_marker, w.on_parent, s);
  add_response_wrench(tree, tree_data, c.child_marker, w.on_child, s);
}

// G times the accelerations, or jumps, in a sweep: the rows of one constraint.
Vector6d calc_rows(const Constraint& c, const ConstraintData& d, const Tree& tree, const TreeData& tree_data,
                   const Sweep& s) {
  Vector6d rows = Vector6d::Zero();
  if (!c.closure) {
    for (const CouplerTerm& term : c.terms) rows[0] += term.ratio * s.u_dot[term.u_row];
    return rows;
  }
  const Vector6d A = calc_relative_response(tree, tree_data, c.parent_marker, c.child_marker, d.relative, s);
  for (int k = 0; k < c.num_rows(); ++k) rows[k] = d.own.W.col(k).dot(A);
  return rows;
}

// Squared size of a row: as a force, lengths over Loops::length.
double calc_size(const Loops& loops, const Constraint& c, const ConstraintData& d, int k) {
  if (!c.closure) return c.coupled_size;
  return d.own.W.col(k).head<3>().squaredNorm() + d.own.W.col(k).tail<3>().squaredNorm() / std::pow(loops.length, 2);
}

// Rows that move nothing but by rounding, or so little that rounding decides how they move (near a change point), are
// left out.
void drop_void_rows(const Loops& loops, const Constraint& c, const ConstraintData& d, int first, const MatrixXd& A,
                    SemidefiniteFactor& factor) {
  double max_mobility = c.mobility;
  for (int k = 0; k < c.num_rows(); ++k) max_mobility = std::max(max_mobility, A(k, k) / calc_size(loops, c, d, k));
  for (int k = 0; k < c.num_rows(); ++k)
    factor.set_void(first + k, A(k, k) < kVoid * max_mobility * calc_size(loops, c, d, k));
}

// A of a block, column by column: what a unit row does to the rows that share a tree with it.
void factor_block(const Loops& loops, const Tree& tree, TreeData& tree_data, const LoopData& data, LoopBlock& block) {
  auto pair = block.factor.pairs.begin();
  for (size_t j = 0; j < block.constraints.size(); ++j) {
    const Constraint& own = loops[block.constraints[j]];
    const auto diagonal = pair;
    while (pair != block.factor.pairs.end() && pair->j == static_cast<int>(j)) ++pair;
    for (int k = 0; k < own.num_rows(); ++k) {
      Sweep& s = start_response(tree, tree_data, block.reach[j].read);
      add_row(own, data[block.constraints[j]], k, 1, tree, tree_data, s);
      for (auto b = own.path.rbegin(); b != own.path.rend(); ++b) solve_to_base(tree, *b, tree_data, s);
      for (const int b : block.reach[j].moved) solve_to_tip(tree, b, tree_data, s);
      for (auto p = diagonal; p != pair; ++p) {
        const int i = block.constraints[static_cast<size_t>(p->i)];
        p->A.col(k) = calc_rows(loops[i], data[i], tree, tree_data, s).head(loops[i].num_rows());
      }
    }
    drop_void_rows(loops, own, data[block.constraints[j]], block.first[j], diagonal->A, block.factor);
  }
  block.factor.compute();
}

void keep_lambda(const Loops& loops, const LoopBlock& block, LoopData& data) {
  for (size_t j = 0; j < block.constraints.size(); ++j) {
    const int i = block.constraints[j], n = loops[i].num_rows();
    for (int k = 0; k < n; ++k) data[i].lambda[k] = block.rows[block.first[j] + k];
  }
}

// The constraints' wrenches as applied loads of the tree, with a sign.
void apply(const Loops& loops, const Tree& tree, const LoopData& data, double sign, TreeData& tree_data) {
  for (const LoopBlock& block : data.blocks) {
    for (const int i : block.constraints) {
      const Constraint& c = loops[i];
      for (const CouplerTerm& term : c.terms)
        tree_data.hinge_force[term.u_row] += sign * term.ratio * data[i].lambda[0];
      if (!c.closure) continue;
      const MarkerWrenches w = calc_marker_wrenches(tree, tree_data, c.parent_marker, c.child_marker, data[i].relative,
                                                    Vector6d(sign * calc_constraint_wrench(loops, data, i)));
      add_marker_wrench(tree, c.parent_marker, w.on_parent.head<3>(), w.on_parent.tail<3>(), tree_data);
      add_marker_wrench(tree, c.child_marker, w.on_child.head<3>(), w.on_child.tail<3>(), tree_data);
    }
  }
}

}  // namespace

VectorXd calc_row_sizes(const Loops& loops, const LoopData& data) {
  VectorXd sizes(get_gaps(loops, data).size());
  int at = 0;
  for (const LoopBlock& block : data.blocks) {
    for (const int i : block.constraints)
      for (int k = 0; k < loops[i].num_rows(); ++k) sizes[at++] = std::sqrt(calc_size(loops, loops[i], data[i], k));
  }
  return sizes;
}

void add_multipliers(const Loops& loops, const Tree& tree, const TreeData& tree_data, const LoopData& data, Sweep& s) {
  for (const LoopBlock& block : data.blocks) {
    for (const int i : block.constraints) {
      for (int k = 0; k < loops[i].num_rows(); ++k)
        add_row(loops[i], data[i], k, data[i].lambda[k], tree, tree_data, s);
    }
  }
}

void close_loops(const Loops& loops, const Tree& tree, TreeData& tree_data, LoopData& data, Eigen::Ref<VectorXd> u_dot,
                 bool is_factored) {
  if (data.blocks.empty()) return;
  tree_data.demand(Stage::Acceleration);
  if (!is_factored) {
    calc_closure_positions(loops, tree, tree_data, data);
    calc_closure_velocities(loops, tree, tree_data, data);
  }
  for (LoopBlock& block : data.blocks) {
    if (!is_factored) factor_block(loops, tree, tree_data, data, block);
    for (size_t j = 0; j < block.constraints.size(); ++j) {
      const int i = block.constraints[j];
      const ConstraintData& d = data[i];
      const Vector6d rows = calc_rows(loops[i], d, tree, tree_data, tree_data.motion);
      for (int k = 0; k < loops[i].num_rows(); ++k) {
        double& row = block.rows[block.first[j] + k];
        row = loops[i].closure ? d.own.bias[k] - d.own.W.col(k).dot(d.relative.bias) - rows[k] : -rows[k];
      }
    }
    block.factor.solve(block.rows);
    keep_lambda(loops, block, data);
  }
  // Once more with the multipliers, so that every acceleration and reaction of the tree knows of them.
  apply(loops, tree, data, 1, tree_data);
  solve(tree, tree_data, u_dot);
  apply(loops, tree, data, -1, tree_data);
  // The force of a coupler acts along its coordinates, not across their hinges: a motor or a brake does not carry it.
  for (const LoopBlock& block : data.blocks) {
    for (const int i : block.constraints) {
      for (const CouplerTerm& term : loops[i].terms) {
        if (tree_data.mode[static_cast<size_t>(term.u_row)] != HingeMode::Free)
          tree_data.transmitted[term.u_row] -= term.ratio * data[i].lambda[0];
      }
    }
  }
}

namespace {

// λ of the gaps in position (or of G u), for a response that takes them off.
void solve_gaps(const Loops& loops, const Tree& tree, TreeData& tree_data, LoopData& data, bool of_velocity) {
  for (LoopBlock& block : data.blocks) {
    factor_block(loops, tree, tree_data, data, block);
    for (size_t j = 0; j < block.constraints.size(); ++j) {
      const int i = block.constraints[j];
      const ConstraintData& d = data[i];
      for (int k = 0; k < loops[i].num_rows(); ++k) {
        double& row = block.rows[block.first[j] + k];
        if (loops[i].closure) {
          row = of_velocity ? -d.own.W.col(k).dot(d.relative.V) : -d.own.gap[k];
        } else {
          row = 0;
          for (const CouplerTerm& term : loops[i].terms) row -= term.ratio * tree_data.u[term.u_row];
          if (!of_velocity) row = -d.coupled;
        }
      }
    }
    block.factor.solve(block.rows);
    keep_lambda(loops, block, data);
  }
}

}  // namespace

void calc_closing_impulses(const Loops& loops, const Tree& tree, TreeData& tree_data, LoopData& data) {
  calc_closure_positions(loops, tree, tree_data, data);
  calc_closure_velocities(loops, tree, tree_data, data);
  solve_gaps(loops, tree, tree_data, data, true);
}

void factor_loops(const Loops& loops, const Tree& tree, TreeData& tree_data, LoopData& data) {
  for (LoopBlock& block : data.blocks) factor_block(loops, tree, tree_data, data, block);
}

void remove_normal(const Loops& loops, const Tree& tree, TreeData& tree_data, LoopData& data, Eigen::Ref<VectorXd> du) {
  if (data.blocks.empty()) return;
  Sweep& s = tree_data.response;
  run_rates(tree, tree_data, du, s);
  for (LoopBlock& block : data.blocks) {
    for (size_t j = 0; j < block.constraints.size(); ++j) {
      const int i = block.constraints[j], n = loops[i].num_rows();
      block.rows.segment(block.first[j], n) = -calc_rows(loops[i], data[i], tree, tree_data, s).head(n);
    }
    block.factor.solve(block.rows);
    keep_lambda(loops, block, data);
  }
  start_response(tree_data);
  add_multipliers(loops, tree, tree_data, data, s);
  run_response(tree, tree_data, s);
  for (Eigen::Index row = 0; row < du.size(); ++row) {
    if (tree_data.mode[static_cast<size_t>(row)] == HingeMode::Free) du[row] += s.u_dot[row];
  }
}

void project(const Loops& loops, const Tree& tree, double t, Eigen::Ref<VectorXd> q, Eigen::Ref<VectorXd> u,
             TreeData& tree_data, LoopData& data) {
  if (data.blocks.empty()) return;
  calc_position(tree, t, q, tree_data);
  calc_closure_positions(loops, tree, tree_data, data);
  double gap = calc_largest_position_error(loops, data);
  for (int i = 0; i < kMaxProjections && gap > kClosed; ++i) {
    calc_factor(tree, tree_data);
    solve_gaps(loops, tree, tree_data, data, false);
    Sweep& s = start_response(tree_data);
    add_multipliers(loops, tree, tree_data, data, s);
    run_response(tree, tree_data, s);
    displace(tree, s.u_dot, q);
    calc_position(tree, t, q, tree_data);
    calc_closure_positions(loops, tree, tree_data, data);
    const double before = std::exchange(gap, calc_largest_position_error(loops, data));
    if (gap > 0.5 * before) break;  // rounding
  }
  calc_velocity(tree, u, tree_data);
  calc_factor(tree, tree_data);
  calc_closure_velocities(loops, tree, tree_data, data);
  solve_gaps(loops, tree, tree_data, data, true);
  Sweep& s = start_response(tree_data);
  add_multipliers(loops, tree, tree_data, data, s);
  run_response(tree, tree_data, s);
  u += s.u_dot;
  calc_velocity(tree, u, tree_data);
}

}  // namespace bough::solver
