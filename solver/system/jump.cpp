// Impulses: where rates that are given jump, those of free coordinates follow by M⁻¹ (solver/tree/response.cpp).
#include <sstream>

#include "solver/system/impl.hpp"

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

}  // namespace

bool cross_jump(const System& system, SystemData& system_data, double before, double t, const Discrete* modes,
                const Eigen::Ref<const VectorXd>& q, Eigen::Ref<VectorXd> u, double& work,
                std::vector<std::string>& events) {
  const Tree& tree = system.impl().tree;
  TreeData& data = system_data.tree;
  calc_kinematics(tree, before, q, u, data);
  const VectorXd u_before = data.u;
  const double kinetic = calc_energies(system, system_data).kinetic;
  if (modes != nullptr) set_modes(tree, modes->mode, data);
  calc_kinematics(tree, t, q, u_before, data);
  VectorXd given = data.u - u_before;  // free rows: zero
  for (int row = 0; row < tree.num_u; ++row) {
    if (std::abs(given[row]) <= kNoJump * (std::abs(u_before[row]) + std::abs(data.u[row]))) given[row] = 0;
  }
  u = data.u;
  if (given.isZero(0)) return false;
  VectorXd du(tree.num_u);
  calc_factor(tree, data);
  solve_jump(tree, data, given, du);
  describe(tree, data, given, u_before, events);
  for (int row = 0; row < tree.num_u; ++row) {
    if (data.mode[static_cast<size_t>(row)] == HingeMode::Free) u[row] += du[row];
  }
  calc_velocity(tree, u, data);
  work += calc_energies(system, system_data).kinetic - kinetic;
  return true;
}

}  // namespace bough::solver
