#include "solver/loops/loops.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace bough::solver {

int Loops::find(const std::string& name) const {
  for (int i = 0; i < size(); ++i) {
    if ((*this)[i].name == name) return i;
  }
  return -1;
}

namespace {

bool is_travel(const TreeBody& tb, int coordinate) {
  VectorXd q(tb.num_hinge_q());
  tb.hinge->set_neutral(q.data());
  HingeMotion motion;
  tb.hinge->calc_position(q.data(), motion);
  return motion.H.col(coordinate).tail<3>().isZero(0);
}

}  // namespace

void finish_loops(const Tree& tree, Loops& loops) {
  for (Constraint& c : loops.constraints) {
    std::set<int> path, roots;
    const auto add = [&](int b) {
      for (; b >= 0; b = tree[b].parent) {
        path.insert(b);
        if (tree[b].parent < 0) roots.insert(b);
      }
    };
    if (c.closure) {
      add(tree.markers[static_cast<size_t>(c.parent_marker)].body);
      add(tree.markers[static_cast<size_t>(c.child_marker)].body);
    }
    c.coupled_size = 0;
    for (const CouplerTerm& term : c.terms) {
      for (int b = 0; b < tree.size(); ++b) {
        if (term.u_row < tree[b].u_offset || term.u_row >= tree[b].eta_dot_offset()) continue;
        add(b);
        const double size = is_travel(tree[b], term.u_row - tree[b].u_offset) ? 1 : 1 / loops.length;
        c.coupled_size += std::pow(size * term.ratio, 2);
      }
    }
    c.path.assign(path.begin(), path.end());
    c.roots.assign(roots.begin(), roots.end());
    double mass = 0;
    for (const int b : c.path) mass += tree[b].body.mass();
    c.mobility = mass > 0 ? 1 / mass : 0;
  }
}

LoopData make_loop_data(const Loops& loops, const Tree& tree) {
  LoopData data;
  std::vector<ConstraintState> constraints;
  for (const Constraint& c : loops.constraints) {
    ConstraintState state;
    state.is_closed = c.active;
    state.q = VectorXd::Zero(c.num_q());
    // A quaternion has one row more than the rows that are left to move.
    if (c.closure && c.num_q() + c.num_rows() == 7) state.q[3] = 1;
    constraints.push_back(std::move(state));
    data.constraints.emplace_back();
  }
  set_constraint_states(loops, tree, constraints, data);
  return data;
}

namespace {

LoopBlock make_block(const Loops& loops, const Tree& tree, const std::vector<int>& constraints) {
  LoopBlock block;
  const auto num = static_cast<int>(constraints.size());
  std::vector<int> sizes, root(static_cast<size_t>(tree.size()));
  std::map<int, std::vector<int>> by_root;
  for (int b = 0; b < tree.size(); ++b)
    root[static_cast<size_t>(b)] = tree[b].parent < 0 ? b : root[static_cast<size_t>(tree[b].parent)];
  int rows = 0;
  for (int k = 0; k < num; ++k) {
    const int i = constraints[static_cast<size_t>(k)];
    block.constraints.push_back(i);
    block.first.push_back(rows);
    sizes.push_back(loops[i].num_rows());
    rows += sizes.back();
    for (const int r : loops[i].roots) by_root[r].push_back(k);
  }
  std::set<std::pair<int, int>> meets;  // the later one second
  for (const auto& [r, group] : by_root) {
    for (size_t a = 0; a < group.size(); ++a) {
      for (size_t b = a + 1; b < group.size(); ++b) meets.insert({group[a], group[b]});
    }
  }
  block.factor.arrange(sizes, {meets.begin(), meets.end()});
  block.rows = VectorXd::Zero(rows);
  block.reach.resize(static_cast<size_t>(num));
  for (const auto& pair : block.factor.pairs) {
    auto& reach = block.reach[static_cast<size_t>(pair.j)];
    const auto& path = loops[block.constraints[static_cast<size_t>(pair.i)]].path;
    reach.read.insert(reach.read.end(), path.begin(), path.end());
  }
  for (int k = 0; k < num; ++k) {
    auto& reach = block.reach[static_cast<size_t>(k)];
    std::sort(reach.read.begin(), reach.read.end());
    reach.read.erase(std::unique(reach.read.begin(), reach.read.end()), reach.read.end());
    const auto& own = loops[block.constraints[static_cast<size_t>(k)]].roots;
    for (const int b : reach.read) {
      if (std::binary_search(own.begin(), own.end(), root[static_cast<size_t>(b)])) reach.moved.push_back(b);
    }
  }
  return block;
}

}  // namespace

void set_constraint_states(const Loops& loops, const Tree& tree, const std::vector<ConstraintState>& constraints,
                           LoopData& data) {
  BOUGH_DEMAND(static_cast<int>(constraints.size()) == loops.size());
  data.blocks.clear();
  std::vector<int> leader(static_cast<size_t>(tree.size()));  // of the trees that constraints join
  std::iota(leader.begin(), leader.end(), 0);
  const auto find = [&](int r) {
    while (leader[static_cast<size_t>(r)] != r) r = leader[static_cast<size_t>(r)];
    return r;
  };
  for (int i = 0; i < loops.size(); ++i) {
    data[i].state = constraints[static_cast<size_t>(i)];
    data[i].lambda.setZero();
    if (!data[i].state.is_closed) continue;
    for (const int r : loops[i].roots) {
      const int a = find(loops[i].roots[0]), b = find(r);
      leader[static_cast<size_t>(std::max(a, b))] = std::min(a, b);
    }
  }
  std::vector<std::vector<int>> groups(static_cast<size_t>(tree.size()) + 1);
  for (int i = 0; i < loops.size(); ++i) {
    if (!data[i].state.is_closed) continue;
    const size_t group = loops[i].roots.empty() ? groups.size() - 1 : static_cast<size_t>(find(loops[i].roots[0]));
    groups[group].push_back(i);
  }
  for (const auto& group : groups) {
    if (!group.empty()) data.blocks.push_back(make_block(loops, tree, group));
  }
}

std::vector<ConstraintState> get_constraint_states(const LoopData& data) {
  std::vector<ConstraintState> constraints;
  for (const ConstraintData& c : data.constraints) constraints.push_back(c.state);
  return constraints;
}

ConstraintState find_as_closed(const Loops& loops, const Tree& tree, const TreeData& tree_data, int i) {
  tree_data.demand(Stage::Position);
  const Constraint& c = loops[i];
  ConstraintState state;
  state.q = VectorXd::Zero(c.num_q());
  if (!c.closure) {
    if (c.is_rate) return state;
    state.gap[0] = -c.offset;
    for (const CouplerTerm& term : c.terms) state.gap[0] += term.ratio * tree_data.q[term.q_row];
    return state;
  }
  RelativeMotion X;
  ClosureMotion own;
  calc_relative_position(tree, tree_data, c.parent_marker, c.child_marker, state, X);
  c.closure->find_start(X.R, X.p, state.q.data());
  c.closure->calc_position(X.R, X.p, state.q.data(), own);
  if (c.closure->is_hinge()) {
    state.R = X.R.transpose() * own.hinge.R_HpHc;
    state.p = X.R.transpose() * (own.hinge.p_HpHc - X.p);
  } else {
    state.gap.head(c.num_position_rows()) = own.gap.head(c.num_position_rows());
  }
  return state;
}

void calc_closure_positions(const Loops& loops, const Tree& tree, const TreeData& tree_data, LoopData& data) {
  tree_data.demand(Stage::Position);
  for (const LoopBlock& block : data.blocks) {
    for (const int i : block.constraints) {
      const Constraint& c = loops[i];
      ConstraintData& d = data[i];
      if (c.closure) {
        calc_relative_position(tree, tree_data, c.parent_marker, c.child_marker, d.state, d.relative);
        c.closure->calc_position(d.relative.R, d.relative.p, d.state.q.data(), d.own);
        if (!c.closure->is_hinge()) d.own.gap.head<2>() -= d.state.gap;
      } else {
        d.coupled = -c.offset - d.state.gap[0];
        if (c.is_rate) continue;
        for (const CouplerTerm& term : c.terms) d.coupled += term.ratio * tree_data.q[term.q_row];
      }
    }
  }
}

void calc_closure_velocities(const Loops& loops, const Tree& tree, const TreeData& tree_data, LoopData& data) {
  tree_data.demand(Stage::Velocity);
  for (const LoopBlock& block : data.blocks) {
    for (const int i : block.constraints) {
      const Constraint& c = loops[i];
      ConstraintData& d = data[i];
      if (!c.closure) continue;
      calc_relative_velocity(tree, tree_data, c.parent_marker, c.child_marker, d.relative);
      c.closure->calc_velocity(d.relative.R, d.relative.p, d.relative.V, d.state.q.data(), d.own);
    }
  }
}

double calc_gap(const Loops& loops, const LoopData& data, int i) {
  const Constraint& c = loops[i];
  const ConstraintData& d = data[i];
  if (!c.closure) {
    double size = std::abs(c.offset);
    for (const CouplerTerm& term : c.terms) size = std::max(size, std::abs(term.ratio));
    return size > 0 ? std::abs(d.coupled) / size : 0;
  }
  if (!c.closure->is_hinge()) return d.own.gap.head(c.num_rows()).norm() / loops.length;
  const Vector6d gap = d.own.W.leftCols(c.num_rows()) * d.own.gap.head(c.num_rows());
  return std::max(gap.head<3>().norm() / loops.length, gap.tail<3>().norm());
}

double calc_largest_position_error(const Loops& loops, const LoopData& data, int* which) {
  double largest = 0;
  for (const LoopBlock& block : data.blocks) {
    for (const int i : block.constraints) {
      const double gap = calc_gap(loops, data, i);
      if (!std::isnan(largest) && !(gap <= largest)) {  // NaN is the largest
        largest = gap;
        if (which) *which = i;
      }
    }
  }
  return largest;
}

Vector6d calc_constraint_wrench(const Loops& loops, const LoopData& data, int i) {
  if (!loops[i].closure || !data[i].state.is_closed) return Vector6d::Zero();
  return data[i].own.W.leftCols(loops[i].num_rows()) * data[i].lambda.head(loops[i].num_rows());
}

std::vector<int> list_position_rows(const Loops& loops, const LoopData& data) {
  std::vector<int> rows;
  int at = 0;
  for (const LoopBlock& block : data.blocks) {
    for (const int i : block.constraints) {
      for (int k = 0; k < loops[i].num_position_rows(); ++k) rows.push_back(at + k);
      at += loops[i].num_rows();
    }
  }
  return rows;
}

bool has_rate_rows(const Loops& loops, const LoopData& data) {
  for (const LoopBlock& block : data.blocks) {
    for (const int i : block.constraints)
      if (loops[i].num_position_rows() < loops[i].num_rows()) return true;
  }
  return false;
}

VectorXd get_gaps(const Loops& loops, const LoopData& data) {
  int rows = 0;
  for (const LoopBlock& block : data.blocks) rows += static_cast<int>(block.rows.size());
  VectorXd gaps(rows);
  int at = 0;
  for (const LoopBlock& block : data.blocks) {
    for (const int i : block.constraints) {
      const int n = loops[i].num_rows();
      if (loops[i].closure)
        gaps.segment(at, n) = data[i].own.gap.head(n);
      else
        gaps[at] = data[i].coupled;
      at += n;
    }
  }
  return gaps;
}

void displace(const Tree& tree, const ConstVectorRef& step, Eigen::Ref<VectorXd> q) {
  double q_dot[7];
  for (const TreeBody& tb : tree.bodies) {
    tb.hinge->calc_q_dot(q.data() + tb.q_offset, step.data() + tb.u_offset, q_dot);
    for (int i = 0; i < tb.num_hinge_q(); ++i) q[tb.q_offset + i] += q_dot[i];
    for (int j = 0; j < tb.num_modes(); ++j) q[tb.eta_offset() + j] += step[tb.eta_dot_offset() + j];
  }
}

}  // namespace bough::solver
