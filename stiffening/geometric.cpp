#include "fe/elements/geometric_projection.hpp"
#include "stiffening/reduce.hpp"

namespace bough::stiffening {

namespace {

/// Of L Φ one product a pair of rows that a load weighs.
void add_form(const fe::QuadraticForm& form, const MatrixXd& Phi, fe::GeometricProjection& sums) {
  const MatrixXd X = (form.L * Phi(form.gdofs, Eigen::all)).transpose();
  const auto r = static_cast<int>(form.L.rows());
  std::vector<std::pair<int, int>> pairs;
  for (int j = 0; j < r; ++j)
    for (int i = j; i < r; ++i)
      if (!form.weights.row(fe::find_weight(r, i, j)).isZero(0)) pairs.emplace_back(i, j);
  auto terms = sums.add_terms(static_cast<Eigen::Index>(pairs.size()));
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [i, j] = pairs[k];
    const auto term = static_cast<Eigen::Index>(k);
    terms.weights.row(term) = form.weights.row(fe::find_weight(r, i, j));
    if (i == j)
      fe::add_square(X.col(i), 1, terms.products.col(term));
    else
      fe::add_cross(X.col(i), X.col(j), 1, terms.products.col(term));
  }
}

}  // namespace

std::vector<MatrixXd> calc_generalized_geometric_stiffness(const fe::Model& model, const fe::AppliedLoads& loads,
                                                           const MatrixXd& U, const MatrixXd& Phi) {
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
  // Forms have their own split over ranks.
  const auto forms = U.cols() > 0 ? fe::calc_second_order(model, loads, U) : std::vector<fe::QuadraticForm>{};
  const fe::MpiWorld world = fe::initialize_petsc();
  for (std::size_t i = static_cast<std::size_t>(world.rank); i < forms.size();
       i += static_cast<std::size_t>(world.size))
    add_form(forms[i], Phi, sums);
  auto result = sums.finish();
  for (auto& K_G : result) fe::sum_over_ranks(K_G);
  return result;
}

}  // namespace bough::stiffening
