#include "base/rotation.hpp"
#include "stiffening/reduce.hpp"

namespace bough::stiffening {

using records::InertialLoad;

MatrixXd calc_inertial_loads(const modal::NodalDofs& dofs, const MatrixXd& P) {
  BOUGH_DEMAND(P.rows() == dofs.num_dofs && P.cols() == 6);
  MatrixXd F_I = MatrixXd::Zero(P.rows(), records::kNumInertialLoads);
  F_I.leftCols(6) = -P;
  const auto column = [](InertialLoad load) { return static_cast<int>(load); };
  for (int node = 0; node < dofs.num_nodes(); ++node) {
    const MatrixXd momentum = dofs.gather(P, node);
    MatrixXd f_I = dofs.gather(F_I, node);
    // S_s: e_s × (every nodal 3-vector of the column), translations and rotations alike.
    for (int row = 0; row < 6; row += 3) {
      const auto calc_S_times = [&](int s, int r) -> Eigen::Vector3d {
        return Eigen::Vector3d::Unit(s).cross(momentum.block<3, 1>(row, 3 + r).eval());
      };
      const auto set = [&](InertialLoad load, const Eigen::Vector3d& f) { f_I.block<3, 1>(row, column(load)) = f; };
      set(InertialLoad::wx2, -calc_S_times(0, 0));
      set(InertialLoad::wy2, -calc_S_times(1, 1));
      set(InertialLoad::wz2, -calc_S_times(2, 2));
      set(InertialLoad::wxwy, -(calc_S_times(0, 1) + calc_S_times(1, 0)));
      set(InertialLoad::wxwz, -(calc_S_times(0, 2) + calc_S_times(2, 0)));
      set(InertialLoad::wywz, -(calc_S_times(1, 2) + calc_S_times(2, 1)));
    }
    dofs.scatter(f_I, node, F_I);
  }
  return F_I;
}

}  // namespace bough::stiffening
