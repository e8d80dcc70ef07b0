#include "fe/elements/curved_shell_operators.hpp"

namespace bough::fe {

ThermalState CurvedShell::calc_thermal(const ElementTemperature& given) const {
  const int n = num_full(), m = num_bubbles();
  const ElementTemperature T = given.calc_change(calc_section(0).expansion->tref);
  const VectorXd nodal = calc_nodal_temperatures(T);
  const Operators o = calc_operators(false);
  VectorXd full = VectorXd::Zero(6 * n + m);
  std::vector<Vector3d> N, M;
  ThermalState state(num_dofs(), num_internal_forces());
  for (std::size_t q = 0; q < o.points.size(); ++q) {
    const auto& p = o.points[q];
    const ShellSection section = calc_section(static_cast<int>(q));
    const ShellExpansion& e = *section.expansion;
    const double t = calc_temperature(nodal, static_cast<int>(q));
    N.push_back(e.calc_N(t, T.gradient_z));
    M.push_back(e.calc_M(t, T.gradient_z));
    full += p.area * (p.membrane.transpose() * N.back() + p.bending.transpose() * M.back());
    state.energy += p.area * e.calc_energy(t, T.gradient_z);
  }
  // The bubbles are condensed; the rest loads the nodes.
  const MatrixXd K = calc_full_stiffness(o), bubble_map = calc_bubble_map(K);
  state.load += calc_map().transpose() * (full.head(6 * n) + bubble_map.transpose() * full.tail(m));
  VectorXd u = VectorXd::Zero(6 * n + m);
  u.tail(m) = K.bottomRightCorner(m, m).completeOrthogonalDecomposition().solve(full.tail(m));
  state.energy -= 0.5 * u.tail(m).dot(full.tail(m));
  const double area = calc_area();
  for (std::size_t q = 0; q < o.points.size(); ++q) {
    const auto& p = o.points[q];
    const ShellSection c = calc_section(static_cast<int>(q));
    const Vector3d e = p.membrane * u, k = p.bending * u;
    auto at = state.force.segment<kNumForces>(kNumForces * static_cast<int>(q));
    at.head<3>() += c.A * e + c.B * k - N[q];
    at.segment<3>(3) += c.B.transpose() * e + c.D * k - M[q];
    at.tail<2>() += calc_shear_stiffness(c, area) * (p.shear * u);
  }
  set_thermal_strains(nodal, T.gradient_z, state);
  return state;
}

}  // namespace bough::fe
