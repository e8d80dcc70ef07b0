#include "fe/elements/stress_state.hpp"

#include <algorithm>

#include "fe/elements/geometric_projection.hpp"

namespace bough::fe {

void StressState::calc_internal_forces_of(const Eigen::Ref<const MatrixXd>& U, Eigen::Ref<MatrixXd> forces) const {
  for (Eigen::Index c = 0; c < U.cols(); ++c) calc_internal_forces(U.col(c), forces.col(c));
}

std::vector<std::string> StressState::printed_force_names() const {
  auto names = internal_force_names();
  names.resize(static_cast<std::size_t>(num_printed_forces()));
  return names;
}

VectorXd StressState::calc_printed_forces(const Eigen::Ref<const VectorXd>& u) const {
  VectorXd force = VectorXd::Zero(num_internal_forces());
  calc_internal_forces(u, force);
  return force.head(num_printed_forces());
}

void StressState::add_projected_geometric_stiffness(const Eigen::Ref<const MatrixXd>& U,
                                                    const Eigen::Ref<const MatrixXd>& Phi,
                                                    GeometricProjection& sums) const {
  const Eigen::Index s = num_internal_forces(), m = U.cols();
  MatrixXd force(s, m), K_G(Phi.rows(), Phi.rows());
  calc_internal_forces_of(U, force);
  const Eigen::Index num_terms = std::min(s, m);
  auto terms = sums.add_terms(num_terms);
  for (Eigen::Index k = 0; k < num_terms; ++k) {
    K_G.setZero();
    if (s <= m)
      add_geometric_stiffness(VectorXd::Unit(s, k), 1, K_G);
    else
      add_geometric_stiffness(force.col(k), 1, K_G);
    add_projection(K_G, Phi, terms.products.col(k));
  }
  if (s <= m)
    terms.weights = force;
  else
    terms.weights.setIdentity();
}

}  // namespace bough::fe
