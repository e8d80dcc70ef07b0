#include "fe/matrices/assembly.hpp"

#include "fe/model/element_loop.hpp"

#include <cmath>

namespace bough::fe {

records::MassProperties calc_mass_properties(const Model& model, MassKind kind, const Vector3d& reference) {
  const MatrixXd Phi_R = model.calc_rigid_modes(reference);
  records::MassProperties result;
  result.reference = reference;
  result.rigid_mass = Phi_R.transpose() * calc_mass_times(model, kind, Phi_R);
  result.rigid_mass = (0.5 * (result.rigid_mass + result.rigid_mass.transpose())).eval();
  result.mass = result.rigid_mass.topLeftCorner<3, 3>().trace() / 3;
  result.inertia = result.rigid_mass.bottomRightCorner<3, 3>();
  // The lower left block is m skew(c), c from the reference point.
  const Matrix3d S = result.rigid_mass.bottomLeftCorner<3, 3>();
  result.cg = reference;
  if (result.mass > 0)
    result.cg += Vector3d(S(2, 1) - S(1, 2), S(0, 2) - S(2, 0), S(1, 0) - S(0, 1)) / (2 * result.mass);
  return result;
}

Eigen::Matrix<double, 6, 1> calc_ground_check(const Model& model) {
  Vector3d centre = Vector3d::Zero();
  for (const Node& node : model.nodes()) centre += node.x / static_cast<double>(model.nodes().size());
  const MatrixXd Phi_R = model.calc_rigid_modes(centre);
  VectorXd diagonal = VectorXd::Zero(model.num_gdofs());
  MatrixXd K_e;
  visit_elements(model, get_own_elements(model), [&](int, const Element& element) {
    K_e.setZero(element.num_dofs(), element.num_dofs());
    element.add_stiffness(1, K_e);
    for (int i = 0; i < element.num_dofs(); ++i) diagonal[element.gdofs()[i]] += K_e(i, i);
  });
  linear::sum_over_ranks(diagonal);
  const MatrixXd K_Phi = calc_stiffness_times(model, Phi_R);
  Eigen::Matrix<double, 6, 1> result;
  for (int r = 0; r < 6; ++r) {
    const double allowed = diagonal.dot(Phi_R.col(r).cwiseAbs2());
    result[r] = allowed > 0 ? std::abs(Phi_R.col(r).dot(K_Phi.col(r))) / allowed : 0;
  }
  return result;
}

}  // namespace bough::fe
