// G M⁻¹ Gᵀ and what is done with it: accelerations, projections, impulses.
#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/forces/applied.hpp"
#include "solver/loops/loops.hpp"

namespace bough::solver {

namespace {

constexpr int kMostProjections = 6;
constexpr double kClosed = 1e-14;
constexpr double kVoid = 1e-13;  // of the most that a row of that size moves in its block

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

bool meet(const std::vector<int>& a, const std::vector<int>& b) {
  for (const int x : a) {
    if (std::binary_search(b.begin(), b.end(), x)) return true;
  }
  return false;
}

// Squared size of a row: as a force, lengths over Loops::length.
double calc_size(const Loops& loops, const Constraint& c, const ConstraintData& d, int k) {
  if (!c.closure) return c.coupled_size;
  return d.own.W.col(k).head<3>().squaredNorm() + d.own.W.col(k).tail<3>().squaredNorm() / std::pow(loops.length, 2);
}

// Rows that move nothing but by rounding are made zero.
void drop_void_rows(const Loops& loops, const LoopData& data, LoopBlock& block) {
  double most = block.least;
  for (const bool drops : {false, true}) {
    for (size_t j = 0; j < block.constraints.size(); ++j) {
      const int i = block.constraints[j];
      for (int k = 0; k < loops[i].num_rows(); ++k) {
        const int row = block.first[j] + k;
        const double size = calc_size(loops, loops[i], data[i], k);
        if (!drops) {
          most = std::max(most, block.A(row, row) / size);
        } else if (block.A(row, row) < kVoid * most * size) {
          block.A.row(row).setZero();
          block.A.col(row).setZero();
        }
      }
    }
  }
}

// A of a block, column by column: the response to a unit row at the rows after it.
void factor_block(const Loops& loops, const Tree& tree, TreeData& tree_data, const LoopData& data, LoopBlock& block) {
  for (size_t j = 0; j < block.constraints.size(); ++j) {
    const Constraint& own = loops[block.constraints[j]];
    for (int k = 0; k < own.num_rows(); ++k) {
      Sweep& s = start_response(tree_data);
      add_row(own, data[block.constraints[j]], k, 1, tree, tree_data, s);
      for (auto b = own.path.rbegin(); b != own.path.rend(); ++b) solve_to_base(tree, *b, tree_data, s);
      for (const int b : block.bodies) solve_to_tip(tree, b, tree_data, s);
      for (size_t i = j; i < block.constraints.size(); ++i) {
        const Constraint& other = loops[block.constraints[i]];
        const int n = other.num_rows();
        const bool is_met = i == j || meet(own.roots, other.roots);
        block.A.block(block.first[i], block.first[j] + k, n, 1).setZero();
        if (!is_met) continue;
        const Vector6d rows = calc_rows(other, data[block.constraints[i]], tree, tree_data, s);
        for (int r = 0; r < n; ++r) block.A(block.first[i] + r, block.first[j] + k) = rows[r];
      }
    }
  }
  drop_void_rows(loops, data, block);
  block.factor.compute(block.A);
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
      // Taken off again it leaves springs and dampers, and of a driven coordinate what its motor gives.
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

void add_multipliers(const Loops& loops, const Tree& tree, const TreeData& tree_data, const LoopData& data, Sweep& s) {
  for (const LoopBlock& block : data.blocks) {
    for (const int i : block.constraints) {
      for (int k = 0; k < loops[i].num_rows(); ++k)
        add_row(loops[i], data[i], k, data[i].lambda[k], tree, tree_data, s);
    }
  }
}

void close_loops(const Loops& loops, const Tree& tree, TreeData& tree_data, LoopData& data,
                 Eigen::Ref<VectorXd> u_dot) {
  if (data.blocks.empty()) return;
  tree_data.demand(Stage::Acceleration);
  calc_closure_positions(loops, tree, tree_data, data);
  calc_closure_velocities(loops, tree, tree_data, data);
  for (LoopBlock& block : data.blocks) {
    factor_block(loops, tree, tree_data, data, block);
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

void project(const Loops& loops, const Tree& tree, double t, Eigen::Ref<VectorXd> q, Eigen::Ref<VectorXd> u,
             TreeData& tree_data, LoopData& data) {
  if (data.blocks.empty()) return;
  calc_position(tree, t, q, tree_data);
  calc_closure_positions(loops, tree, tree_data, data);
  double gap = calc_largest_gap(loops, data);
  for (int i = 0; i < kMostProjections && gap > kClosed; ++i) {
    calc_factor(tree, tree_data);
    solve_gaps(loops, tree, tree_data, data, false);
    Sweep& s = start_response(tree_data);
    add_multipliers(loops, tree, tree_data, data, s);
    run_response(tree, tree_data, s);
    displace(tree, s.u_dot, q);
    calc_position(tree, t, q, tree_data);
    calc_closure_positions(loops, tree, tree_data, data);
    const double before = std::exchange(gap, calc_largest_gap(loops, data));
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
