// Impulses: where rates that are given jump, those of free coordinates follow by M⁻¹ (solver/tree/response.cpp).
#include <sstream>

#include "solver/system/system.hpp"

namespace bough::solver {

namespace {

constexpr double kNoJump = 1e-12;  // of the rate

void describe(const Tree& tree, const TreeData& data, const VectorXd& given, const VectorXd& before,
              std::vector<std::string>& events) {
  for (int b = 0; b < tree.size(); ++b) {
    const TreeBody& tb = tree[b];
    for (int i = 0; i < tb.num_hinge_u(); ++i) {
      const int row = tb.u_offset + i;
      if (given[row] == 0) continue;
      std::ostringstream what;
      what << "the rate of coordinate " << i + 1 << " of hinge '" << tb.hinge_name << "' jumps from " << before[row]
           << " to " << before[row] + given[row] << " by an impulse of " << calc_jump_impulse(tree, data, b, i);
      events.push_back(what.str());
    }
  }
}

struct EquilibriumResidual {
  double kinetic = 0;
  Vector3d linear, angular;
};

EquilibriumResidual calc_balance(const System& system, const SystemData& data) {
  EquilibriumResidual b;
  b.kinetic = calc_energies(system, data).kinetic;
  calc_momentum(system, data, b.linear, b.angular);
  return b;
}

// Constraints that were open and are to be closed.
std::vector<int> find_caught(const LoopData& data, const DiscreteState& modes) {
  std::vector<int> caught;
  for (size_t i = 0; i < modes.constraints.size(); ++i) {
    if (modes.constraints[i].is_closed && !data.constraints[i].state.is_closed) caught.push_back(static_cast<int>(i));
  }
  return caught;
}

void add_free(const TreeData& data, const VectorXd& du, Eigen::Ref<VectorXd> u) {
  for (Eigen::Index row = 0; row < u.size(); ++row) {
    if (data.mode[static_cast<size_t>(row)] == HingeMode::Free) u[row] += du[row];
  }
}

void describe_capture(const System& system, const SystemData& data, int c, const EquilibriumResidual& old,
                      const EquilibriumResidual& now, std::vector<std::string>& events) {
  std::ostringstream what;
  what << "constraint '" << system.constraint_name(c) << "' closes ";
  const ConstraintReaction r = get_constraint_reaction(system, data, c);
  const auto list = [&](const Vector3d& v) { what << "(" << v.x() << ", " << v.y() << ", " << v.z() << ")"; };
  if (system.is_coupler(c)) {
    what << "by an impulse of " << r.multiplier;
  } else {
    what << "by an impulse of ";
    list(r.force);
    what << " and ";
    list(r.moment);
    what << " on the child at its frame, in the axes of the parent's";
  }
  what << "; the kinetic energy falls from " << old.kinetic << " to " << now.kinetic << ", the momenta change by ";
  list(now.linear - old.linear);
  what << " and ";
  list(now.angular - old.angular);
  events.push_back(what.str());
}

}  // namespace

bool cross_jump(const System& system, SystemData& system_data, double before, double t, const DiscreteState* modes,
                const Eigen::Ref<const VectorXd>& q, Eigen::Ref<VectorXd> u, double& work,
                std::vector<std::string>& events) {
  const Tree& tree = system.tree;
  TreeData& data = system_data.tree;
  calc_kinematics(tree, before, q, u, data);
  const VectorXd u_before = data.u;
  const EquilibriumResidual old = calc_balance(system, system_data);
  std::vector<int> caught;
  if (modes != nullptr) {
    caught = find_caught(system_data.loops, *modes);
    set_modes(system, system_data, *modes);
  }
  calc_kinematics(tree, t, q, u_before, data);
  VectorXd given = data.u - u_before;  // free rows: zero
  for (int row = 0; row < tree.num_u; ++row) {
    if (std::abs(given[row]) <= kNoJump * (std::abs(u_before[row]) + std::abs(data.u[row]))) given[row] = 0;
  }
  const VectorXd u_given = data.u;
  u = u_given;
  if (given.isZero(0) && caught.empty()) return false;
  VectorXd du(tree.num_u);
  calc_factor(tree, data);
  solve_jump(tree, data, given, du);
  add_free(data, du, u);
  if (!system_data.loops.blocks.empty()) {
    // The impulses that close the loops again act at the same instant.
    calc_velocity(tree, u, data);
    calc_closing_impulses(system.loops, tree, data, system_data.loops);
    Sweep& s = start_response(data);
    add_response_jump(tree, data, given, s);
    add_multipliers(system.loops, tree, data, system_data.loops, s);
    run_response(tree, data, s);
    u = u_given;
    add_free(data, s.u_dot, u);
  }
  describe(tree, data, given, u_before, events);
  calc_velocity(tree, u, data);
  const EquilibriumResidual now = calc_balance(system, system_data);
  for (const int c : caught) describe_capture(system, system_data, c, old, now, events);
  work += now.kinetic - old.kinetic;
  return true;
}

}  // namespace bough::solver
