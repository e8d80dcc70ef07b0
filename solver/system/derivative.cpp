#include "solver/system/derivative.hpp"

namespace bough::solver {

void calc_derivative(const System& system, SystemData& data, double t, const Eigen::Ref<const VectorXd>& x,
                     Eigen::Ref<VectorXd> x_dot) {
  const StateLayout layout = system.layout();
  BOUGH_DEMAND(x.size() == layout.size() && x_dot.size() == layout.size());
  calc_motion(system, data, t, get_q(layout, x), get_u(layout, x), get_z(layout, x), get_u(layout, x_dot), [] {});
  get_q_dot(system, data, get_q(layout, x_dot));  // q̇ = N(q) u
  calc_z_dot(system, data, get_z(layout, x_dot));
  const Power power = calc_powers(system, data);
  x_dot[layout.work()] = power.total;
  x_dot[layout.dissipated()] = power.dissipated;
}

}  // namespace bough::solver
