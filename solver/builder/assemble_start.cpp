// Initial state that closes the loops, and its messages.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "solver/builder/build.hpp"
#include "solver/loops/assemble.hpp"

namespace bough::solver {

namespace {

using records::ConstraintRecord;
using records::ConstraintType;

// grip of positions and of rates, by row of u
void collect_grips(const records::SystemSpec& spec, const TreeOrder& order, const Tree& tree,
                   std::vector<AssemblyPriority>& positions, std::vector<AssemblyPriority>& rates) {
  positions.assign(static_cast<size_t>(tree.num_u), AssemblyPriority::Modal);
  rates = positions;
  for (int b = 0; b < tree.size(); ++b) {
    const TreeBody& tb = tree[b];
    const int h = order.hinge[static_cast<size_t>(b)];
    const auto get_grip = [&](bool is_given, HingeMode mode) {
      return mode != HingeMode::Free ? AssemblyPriority::Fixed
             : is_given              ? AssemblyPriority::Given
                                     : AssemblyPriority::Free;
    };
    for (int i = 0; i < tb.num_hinge_u(); ++i) {
      const auto row = static_cast<size_t>(tb.u_offset + i);
      const HingeMode mode = tb.mode[static_cast<size_t>(i)];
      const records::HingeRecord* hinge = h >= 0 ? &spec.hinges[static_cast<size_t>(h)] : nullptr;
      positions[row] = get_grip(hinge && !hinge->position.empty() && !hinge->is_guess, mode);
      rates[row] = get_grip(hinge && !hinge->rate.empty(), mode);
    }
  }
}

std::string describe_wrench(const ConstraintRecord& record, const Vector6d& w) {
  if (record.type == ConstraintType::Coupler || record.type == ConstraintType::RateCoupler) return "its force";
  std::ostringstream text;
  const auto describe = [&](const char* kind, const Vector3d& v) {
    if (v.norm() < 1e-6) return;
    text << (text.tellp() > 0 ? " with the " : "the ") << kind;
    for (int a = 0; a < 3; ++a) {
      if (v.cwiseAbs().sum() - std::abs(v[a]) < 1e-6) {
        text << " along "
             << "xyz"[a];
        return;
      }
    }
    text << " (" << v.x() << ", " << v.y() << ", " << v.z() << ")";
  };
  text.precision(4);
  describe("force", w.head<3>());
  describe("moment", w.tail<3>());
  return text.str();
}

void note_redundancies(const records::SystemSpec& spec, const std::vector<Redundancy>& found, const Loops& loops,
                       Diagnostics& diagnostics) {
  for (const Redundancy& r : found) {
    const Constraint& c = loops[r.constraint];
    const auto is_own = [&](const ConstraintRecord& record) { return record.name == c.name; };
    const ConstraintRecord& record = *std::find_if(spec.constraints.begin(), spec.constraints.end(), is_own);
    std::string list;
    for (Eigen::Index k = 0; k < r.wrenches.cols(); ++k)
      list += (list.empty() ? "" : ", ") + describe_wrench(record, r.wrenches.col(k));
    diagnostics.note("system.redundant-constraint", c.at,
                     "constraint " + quote(c.name) + " holds " + std::to_string(r.wrenches.cols()) + " of its " +
                         std::to_string(c.num_rows()) +
                         " directions twice: what the hinges and constraints before it " + "take as well is " + list +
                         " (at the child's frame, axes of the parent's)",
                     "reactions there are those of least norm; use a type with fewer rows");
  }
}

void note_moved(const Tree& tree, const VectorXd& q0, const VectorXd& u0, const VectorXd& q, const VectorXd& u,
                const SourceLocation& at, Diagnostics& diagnostics) {
  std::ostringstream text;
  text.precision(6);
  const auto add = [&](const std::string& what, const auto& before, const auto& after) {
    const double size = std::max(1e-300, after.cwiseAbs().maxCoeff());
    if ((after - before).cwiseAbs().maxCoeff() <= 1e-9 * std::max(1.0, size)) return;
    text << (text.tellp() > 0 ? "; " : "") << what << " from";
    for (const double x : before) text << ' ' << x;
    text << " to";
    for (const double x : after) text << ' ' << x;
  };
  for (const TreeBody& tb : tree.bodies) {
    const int nq = tb.num_hinge_q(), nu = tb.num_hinge_u(), n = tb.num_modes();
    if (nq > 0) {
      VectorXd before(nq), after(nq);
      tb.hinge->get_for_file(q0.data() + tb.q_offset, before.data());
      tb.hinge->get_for_file(q.data() + tb.q_offset, after.data());
      add("hinge " + quote(tb.hinge_name), before, after);
      add("the rate of hinge " + quote(tb.hinge_name), VectorXd(u0.segment(tb.u_offset, nu)),
          VectorXd(u.segment(tb.u_offset, nu)));
    }
    if (n == 0) continue;
    add("the modes of body " + quote(tb.name), VectorXd(q0.segment(tb.eta_offset(), n)),
        VectorXd(q.segment(tb.eta_offset(), n)));
    add("the modal rates of body " + quote(tb.name), VectorXd(u0.segment(tb.eta_dot_offset(), n)),
        VectorXd(u.segment(tb.eta_dot_offset(), n)));
  }
  if (text.tellp() > 0)
    diagnostics.note("system.assembled", at, "to close the loops the start was moved: " + text.str(),
                     "coordinates with a 'position' or 'rate' of their own move last, unless guess = true");
}

/// Rates that were zero and became round-off of the largest are zero: an equilibrium distinguishes rest from a spin.
void clear_rounding(const VectorXd& before, VectorXd& u) {
  const double rounding = 1e-14 * u.lpNorm<Eigen::Infinity>();
  for (Eigen::Index i = 0; i < u.size(); ++i)
    if (before[i] == 0 && std::abs(u[i]) <= rounding) u[i] = 0;
}

// The hinges that a loop runs through: 'b' (locked), 'c'.
std::string describe_hinges(const Constraint& c, const Tree& tree, const std::vector<AssemblyPriority>& grips) {
  const auto climb = [&](int marker) {
    std::vector<int> bodies;
    for (int b = tree.markers[static_cast<size_t>(marker)].body; b >= 0; b = tree[b].parent) bodies.push_back(b);
    return bodies;
  };
  std::vector<int> bodies;
  if (c.closure) {
    std::vector<int> up = climb(c.parent_marker), down = climb(c.child_marker);
    for (; !up.empty() && !down.empty() && up.back() == down.back(); up.pop_back()) down.pop_back();
    bodies = up;
    bodies.insert(bodies.end(), down.rbegin(), down.rend());
  } else {
    for (const int b : c.path) {
      const auto is_own = [&](const CouplerTerm& term) {
        return term.u_row >= tree[b].u_offset && term.u_row < tree[b].u_offset + tree[b].num_hinge_u();
      };
      if (std::any_of(c.terms.begin(), c.terms.end(), is_own)) bodies.push_back(b);
    }
  }
  constexpr size_t kMaxListed = 8;
  std::string list;
  for (size_t k = 0; k < bodies.size(); ++k) {
    if (k == kMaxListed) return list + " and " + std::to_string(bodies.size() - kMaxListed) + " more";
    const TreeBody& tb = tree[bodies[k]];
    list += (list.empty() ? "" : ", ") + quote(tb.hinge_name);
    const AssemblyPriority* grip = grips.data() + tb.u_offset;
    const auto held = std::count(grip, grip + tb.num_hinge_u(), AssemblyPriority::Fixed);
    if (tb.num_hinge_u() > 0 && held > 0)
      list += held == tb.num_hinge_u() ? " (locked or prescribed)" : " (locked or prescribed in part)";
  }
  return list;
}

void report_open(const Assembly& assembly, const Loops& loops, const Tree& tree,
                 const std::vector<AssemblyPriority>& grips, const char* of, Diagnostics& diagnostics) {
  const Constraint& c = loops[std::max(0, assembly.worst)];
  std::ostringstream what;
  what << "the loops cannot be closed: " << of << " of constraint " << quote(c.name) << " stay off by " << assembly.gap;
  const std::string hinges = describe_hinges(c, tree, grips);
  if (!hinges.empty()) what << "; its loop runs through hinge " << hinges;
  diagnostics.error("system.cannot-assemble", c.at, what.str(),
                    "check its nodes and frames, and what is locked or prescribed; a 'position' nearer to a closed "
                    "loop helps where there is one");
}

}  // namespace

void assemble(const records::SystemSpec& spec, const TreeOrder& order, System& system, Diagnostics& diagnostics) {
  const Tree& tree = system.tree;
  VectorXd q(tree.num_q), u(tree.num_u);
  system.calc_initial_state(q, u);
  const VectorXd q0 = q, u0 = u;
  TreeData data = make_tree_data(tree);
  LoopData loop_data = make_loop_data(system.loops, tree);
  if (loop_data.blocks.empty()) return;
  std::vector<AssemblyPriority> positions, rates;
  collect_grips(spec, order, tree, positions, rates);
  const Assembly closed = assemble_positions(system.loops, tree, system.start, positions, q, data, loop_data);
  if (!closed.is_closed) return report_open(closed, system.loops, tree, positions, "the positions", diagnostics);
  const Assembly moving = assemble_rates(system.loops, tree, rates, u, data, loop_data);
  if (!moving.is_closed) return report_open(moving, system.loops, tree, rates, "the rates", diagnostics);
  clear_rounding(u0, u);
  note_redundancies(spec, find_redundancies(system.loops, tree, positions, data, loop_data), system.loops, diagnostics);
  note_moved(tree, q0, u0, q, u, system.loops[loop_data.blocks[0].constraints[0]].at, diagnostics);
  system.initial_q = q;
  system.initial_u = u;
  system.initial_constraints = get_constraint_states(loop_data);
}

}  // namespace bough::solver
