#include "bough/fe/elements/shell.hpp"
#include "bough/fe/elements/shell_dofs.hpp"
#include "bough/fe/elements/temperature.hpp"

namespace bough::fe {

using namespace shell;

/// ∫ Bᵀ (N, M). Inner modes of the membrane have no mean: they do not feel what is uniform.
template <int N>
void Shell::add_thermal_of(const Vector3d& normal_force, const Vector3d& moment, Eigen::Ref<VectorXd> load) const {
  const auto fields = calc_fields<N>();
  Eigen::Matrix<double, 6 * N, 1> local = Eigen::Matrix<double, 6 * N, 1>::Zero();
  for (int q = 0; q < N; ++q) {
    const double w = fields.points[q].weight;
    const Eigen::Matrix<double, 3 * N, 1> m = w * fields.membrane.strain[q].transpose() * normal_force;
    Eigen::Matrix<double, 3 * N, 1> p = w * fields.plate.bending[q].transpose() * moment;
    if (fields.membrane.coupled) p += w * fields.membrane.strain_of_plate[q].transpose() * normal_force;
    for (int i = 0; i < 3 * N; ++i) {
      local[kMembrane<N>[i]] += m[i];
      local[kPlate<N>[i]] += p[i];
    }
  }
  local = (calc_surface_map<N>().transpose() * local).eval();
  for (int i = 0; i < 2 * N; ++i) load.segment<3>(3 * i) += R_ * local.template segment<3>(3 * i);
}

double Shell::add_thermal(const ElementTemperature& T, Eigen::Ref<VectorXd> load, Eigen::Ref<VectorXd> initial) const {
  const ShellExpansion& e = *section_.expansion;
  const double t = T.node.mean() - e.tref;
  const Vector3d normal_force = e.calc_N(t, T.gradient_z), moment = e.calc_M(t, T.gradient_z);
  num_nodes_ == 4 ? add_thermal_of<4>(normal_force, moment, load) : add_thermal_of<3>(normal_force, moment, load);
  for (int q = 0; q < num_points(); ++q) {
    initial.segment<3>(kNumForces * q) -= normal_force;
    initial.segment<3>(kNumForces * q + 3) -= moment;
  }
  return area_ * e.calc_energy(t, T.gradient_z);
}

}  // namespace bough::fe
