#include "bough/stiffening/reduce.hpp"

namespace bough::stiffening {

std::vector<MatrixXd> calc_generalized_geometric_stiffness(const fe::Model& model, const MatrixXd& U,
                                                           const MatrixXd& Phi) {
  BOUGH_DEMAND(U.rows() == model.num_gdofs() && Phi.rows() == model.num_gdofs());
  const Eigen::Index n = Phi.cols(), m = U.cols();
  MatrixXd sum = MatrixXd::Zero(n * n, m);
  const auto [first, last] = fe::calc_element_range(model);
  for (int e = first; e < last; ++e) {
    const auto& element = *model.elements()[e];
    const int s = element.num_internal_forces(), N = element.num_dofs();
    if (s == 0) continue;
    const MatrixXd U_e = U(element.gdofs(), Eigen::all), Phi_e = Phi(element.gdofs(), Eigen::all);
    MatrixXd force(s, m);
    for (Eigen::Index c = 0; c < m; ++c) element.calc_internal_forces(U_e.col(c), force.col(c));

    // K_G is linear in the internal forces: project the s unit ones when they are fewer than the loads.
    const bool by_unit_force = s < m;
    const Eigen::Index num_terms = by_unit_force ? s : m;
    MatrixXd projected(n * n, num_terms), K_G(N, N);
    for (Eigen::Index i = 0; i < num_terms; ++i) {
      K_G.setZero();
      element.add_geometric_stiffness(by_unit_force ? VectorXd::Unit(s, i) : VectorXd(force.col(i)), 1, K_G);
      const MatrixXd block = Phi_e.transpose() * K_G * Phi_e;
      projected.col(i) = block.reshaped();
    }
    if (by_unit_force)
      sum.noalias() += projected * force;
    else
      sum += projected;
  }
  fe::sum_over_ranks(sum);

  std::vector<MatrixXd> result;
  for (Eigen::Index c = 0; c < m; ++c) {
    const MatrixXd K_G = sum.col(c).reshaped(n, n);
    result.push_back(0.5 * (K_G + K_G.transpose()));
  }
  return result;
}

}  // namespace bough::stiffening
