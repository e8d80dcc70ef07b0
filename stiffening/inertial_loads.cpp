#include "bough/base/rotation.hpp"
#include "bough/stiffening/reduce.hpp"

namespace bough::stiffening {

using records::InertialLoad;

MatrixXd calc_inertial_loads(const fe::Model& model, fe::MassKind kind) {
  const MatrixXd P = fe::calc_mass_times(model, kind, model.calc_rigid_modes());
  MatrixXd F_I = MatrixXd::Zero(P.rows(), records::kNumInertialLoads);
  F_I.leftCols(6) = -P;
  const auto column = [](InertialLoad load) { return static_cast<int>(load); };
  for (const auto& node : model.nodes()) {
    if (node.num_dofs != 6) continue;
    // S_s: e_s × (every nodal 3-vector of the column), translations and rotations alike.
    for (int row = node.first_gdof; row < node.first_gdof + 6; row += 3) {
      const auto calc_S_times = [&](int s, int r) -> Eigen::Vector3d {
        return Eigen::Vector3d::Unit(s).cross(P.block<3, 1>(row, 3 + r).eval());
      };
      const auto set = [&](InertialLoad load, const Eigen::Vector3d& f) { F_I.block<3, 1>(row, column(load)) = f; };
      set(InertialLoad::wx2, -calc_S_times(0, 0));
      set(InertialLoad::wy2, -calc_S_times(1, 1));
      set(InertialLoad::wz2, -calc_S_times(2, 2));
      set(InertialLoad::wxwy, -(calc_S_times(0, 1) + calc_S_times(1, 0)));
      set(InertialLoad::wxwz, -(calc_S_times(0, 2) + calc_S_times(2, 0)));
      set(InertialLoad::wywz, -(calc_S_times(1, 2) + calc_S_times(2, 1)));
    }
  }
  return F_I;
}

}  // namespace bough::stiffening
