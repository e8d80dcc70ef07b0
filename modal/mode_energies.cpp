#include "modal/mode_energies.hpp"

#include "fe/cards/element_properties.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/model/element_loop.hpp"

namespace bough::modal {

using Eigen::MatrixXd;

records::ModeEnergies calc_mode_energies(const fe::Model& model, const records::Deck& deck,
                                         const Eigen::Ref<const MatrixXd>& Phi) {
  const auto& elements = model.elements();
  const auto count = static_cast<Eigen::Index>(elements.size());
  MatrixXd strain = MatrixXd::Zero(count, Phi.cols()), kinetic = strain, has = MatrixXd::Zero(count, 1);
  MatrixXd K, M, u;
  fe::visit_elements(model, fe::get_own_elements(model), [&](int e, const fe::Element& element) {
    const int n = element.num_dofs();
    K.setZero(n, n);
    M.setZero(n, n);
    model.add_stiffness(element, K);
    element.add_mass(model.mass_kind(), model.wtmass(), M);
    if (K.isZero(0) && M.isZero(0)) return;
    has(e, 0) = 1;
    u = Phi(element.gdofs(), Eigen::all);
    strain.row(e) = 0.5 * u.cwiseProduct(K * u).colwise().sum();
    kinetic.row(e) = 0.5 * u.cwiseProduct(M * u).colwise().sum();
  });
  linear::sum_over_ranks(strain);
  linear::sum_over_ranks(kinetic);
  linear::sum_over_ranks(has);
  records::ModeEnergies result;
  const auto properties = fe::list_element_properties(deck);
  std::vector<Eigen::Index> rows;
  for (Eigen::Index e = 0; e < count; ++e) {
    if (has(e, 0) == 0) continue;
    const fe::Element& element = *elements[static_cast<std::size_t>(e)];
    rows.push_back(e);
    result.id.push_back(element.id());
    result.card.push_back(element.card());
    const auto property = properties.find(element.id());
    result.property.push_back(property == properties.end() ? 0 : property->second);
  }
  result.strain = strain(rows, Eigen::all);
  result.kinetic = kinetic(rows, Eigen::all);
  result.total_strain = 0.5 * Phi.cwiseProduct(fe::calc_stiffness_times(model, Phi)).colwise().sum();
  result.total_kinetic = 0.5 * Phi.cwiseProduct(fe::calc_mass_times(model, model.mass_kind(), Phi)).colwise().sum();
  return result;
}

}  // namespace bough::modal
