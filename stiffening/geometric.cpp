#include "bough/fe/elements/geometric_projection.hpp"
#include "bough/stiffening/reduce.hpp"

namespace bough::stiffening {

std::vector<MatrixXd> calc_generalized_geometric_stiffness(const fe::Model& model, const MatrixXd& U,
                                                           const MatrixXd& Phi) {
  BOUGH_DEMAND(U.rows() == model.num_gdofs() && Phi.rows() == model.num_gdofs());
  fe::GeometricProjection sums(Phi.cols(), U.cols());
  MatrixXd U_e, Phi_e;
  const auto [first, last] = fe::calc_element_range(model);
  for (int e = first; e < last && U.cols() > 0; ++e) {
    const auto& element = *model.elements()[e];
    if (element.num_internal_forces() == 0) continue;
    U_e = U(element.gdofs(), Eigen::all);
    Phi_e = Phi(element.gdofs(), Eigen::all);
    element.add_projected_geometric_stiffness(U_e, Phi_e, sums);
  }
  auto result = sums.finish();
  for (auto& K_G : result) fe::sum_over_ranks(K_G);
  return result;
}

}  // namespace bough::stiffening
