#include <algorithm>
#include <utility>

#include "fe/elements/beam.hpp"

namespace bough::fe {

/// T is the change of temperature. A section strains freely by α (T + (y - n_y) dT/dy + (z - n_z) dT/dz): axially, and
/// with κz = -α dT/dy, κy = α dT/dz. Temperature and gradients are linear along the beam. δ is how end B then moves
/// from end A; the end forces are G (S u - δ).
ThermalState Beam::calc_thermal(const ElementTemperature& given) const {
  const BeamField& field = *field_;
  const double L = geometry_.length, alpha = property_->material.alpha;
  const ElementTemperature T = given.calc_change(property_->material.tref);
  // ∫ n · gradient dx / L: both are linear between stations, and Simpson's rule is exact.
  double at_axis = 0;
  const auto& stations = property_->stations;
  for (std::size_t k = 1; k < std::max<std::size_t>(stations.size(), 2); ++k) {
    const double from = property_->is_uniform() ? 0 : stations[k - 1].x_over_L,
                 to = property_->is_uniform() ? 1 : stations[k].x_over_L;
    for (const auto& [share, weight] : {std::pair(0.0, 1.0), std::pair(0.5, 4.0), std::pair(1.0, 1.0)}) {
      const double x = from + share * (to - from);
      at_axis += (to - from) * weight / 6 * property_->calc_section(x).n.dot((1 - x) * T.gradient_a + x * T.gradient_b);
    }
  }
  const Eigen::Vector2d turn = L / 2 * (T.gradient_a + T.gradient_b),  // ∫ gradient dx
      lift = L * L * (T.gradient_a / 3 + T.gradient_b / 6);            // ∫ gradient (L - x) dx
  Eigen::Matrix<double, 6, 1> delta;
  delta << L * (0.5 * (T.node[0] + T.node[1]) - at_axis), -lift[0], -lift[1], 0, turn[1], -turn[0];
  delta *= alpha;

  const Matrix6d G = field.calc_stiffness();
  const Matrix6x12d S = field.calc_relative();
  const Eigen::Matrix<double, 12, 1> end = S.transpose() * (G * delta);
  ThermalState state(num_dofs(), num_internal_forces());
  state.load += calc_grid_load(end);
  Eigen::Matrix<double, 6, 1> q = -G * delta;
  state.energy = 0.5 * delta.dot(G * delta);
  if (const unsigned pins = geometry_.pin_a | (geometry_.pin_b << 6)) {
    // Released dofs v: K_rr v = f_r.
    std::vector<int> released;
    for (int i = 0; i < 12; ++i)
      if (pins >> i & 1u) released.push_back(i);
    const MatrixXd S_r = S(Eigen::all, released);
    const VectorXd f_r = end(released);
    const VectorXd v = MatrixXd(S_r.transpose() * G * S_r).completeOrthogonalDecomposition().solve(f_r);
    q += G * (S_r * v);
    state.energy -= 0.5 * v.dot(f_r);
  }
  Eigen::Matrix<double, 8, 1> force;
  force << q[0], q[1], q[2], q[3], q[4] - q[2] * L, q[5] + q[1] * L, q[4], q[5];
  state.force += force;
  state.strain = calc_thermal_strains(T);
  return state;
}

}  // namespace bough::fe
