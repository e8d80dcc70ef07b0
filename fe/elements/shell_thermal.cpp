#include <Eigen/Cholesky>

#include "fe/elements/shell.hpp"
#include "fe/elements/shell_dofs.hpp"
#include "fe/sections/shell_stress.hpp"

namespace bough::fe {

using namespace shell;

/// ∫ Bᵀ (N, M) with the inner modes of the membrane inside B; they move at once by what their own strains do, which is
/// nothing if the temperature is uniform, since they have no mean.
template <int N>
void Shell::add_thermal_of(const ElementTemperature& T, ThermalState& state) const {
  const ShellExpansion& e = *section_.expansion;
  VectorXd &load = state.load, &initial = state.force;
  double& energy = state.energy;
  const auto fields = calc_fields<N>();
  const auto& membrane = fields.membrane;
  const Eigen::Matrix<double, N, 1> corner = T.node.head<N>();
  Eigen::Matrix<double, 6 * N, 1> local = Eigen::Matrix<double, 6 * N, 1>::Zero();
  Eigen::Vector4d f_a = Eigen::Vector4d::Zero();
  for (int q = 0; q < N; ++q) {
    const double w = fields.points[q].weight, t = fields.points[q].shape.dot(corner);
    const Vector3d normal_force = e.calc_N(t, T.gradient_z), moment = e.calc_M(t, T.gradient_z);
    const Eigen::Matrix<double, 3 * N, 1> m = w * membrane.strain[q].transpose() * normal_force;
    Eigen::Matrix<double, 3 * N, 1> p = w * fields.plate.bending[q].transpose() * moment;
    if (membrane.coupled) p += w * membrane.strain_of_plate[q].transpose() * normal_force;
    for (int i = 0; i < 3 * N; ++i) {
      local[kMembrane<N>[i]] += m[i];
      local[kPlate<N>[i]] += p[i];
    }
    if (membrane.has_modes) f_a += w * membrane.mode[q].transpose() * normal_force;
    energy += w * e.calc_energy(t, T.gradient_z);
    initial.segment<3>(kNumForces * q) -= normal_force;
    initial.segment<3>(kNumForces * q + 3) -= moment;
  }
  for (int i = 0; i < N && membrane.has_rotations; ++i) initial[kNumForces * N + i] -= local[kMembrane<N>[3 * i + 2]];
  if (membrane.has_modes) {
    const Eigen::Vector4d a = membrane.mode_stiffness.ldlt().solve(f_a);
    energy -= 0.5 * a.dot(f_a);
    for (int q = 0; q < N; ++q) {
      const Vector3d strain = membrane.mode[q] * a;
      initial.segment<3>(kNumForces * q) += section_.A * strain;
      initial.segment<3>(kNumForces * q + 3) += section_.B.transpose() * strain;
    }
  }
  local = (calc_surface_map<N>().transpose() * local).eval();
  for (int i = 0; i < 2 * N; ++i) load.segment<3>(3 * i) += R_ * local.template segment<3>(3 * i);
}

ThermalState Shell::calc_thermal(const ElementTemperature& given) const {
  const ElementTemperature T = given.calc_change(section_.expansion->tref);
  ThermalState state(num_dofs(), num_internal_forces());
  num_nodes_ == 4 ? add_thermal_of<4>(T, state) : add_thermal_of<3>(T, state);
  state.stress = calc_ply_expansion(section_, calc_mean(T.node), T.gradient_z);
  state.strain = calc_section_expansion(section_, calc_mean(T.node), T.gradient_z);
  return state;
}

}  // namespace bough::fe
