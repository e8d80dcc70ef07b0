// Modes of the body with the mass of other bodies at its nodes, which is removed again (docs/theory/bases.md).
#include "fe/elements/point_mass.hpp"
#include "fe/linear/products.hpp"
#include "fe/statics/build_model.hpp"
#include "stiffening/stages.hpp"

namespace bough::stiffening {

namespace {

/// Point masses after the elements of the deck: a prestress refers to these by their order.
fe::ElementFactory add_masses(const fe::ElementFactory& factory, const std::vector<records::AugmentSpec>& augments,
                              double wtmass) {
  return [=](const records::Deck& deck, const fe::NodeTable& nodes, Diagnostics& diagnostics) {
    auto list = factory(deck, nodes, diagnostics);
    for (const auto& augment : augments) {
      const int index = nodes.find_node(augment.node);
      BOUGH_DEMAND(index >= 0);
      std::vector<int> gdofs;
      for (int c = 0; c < 6; ++c) gdofs.push_back(nodes.node(index).first_gdof + c);
      // Assembly scales every mass by WTMASS.
      list.elements.push_back(std::make_unique<fe::PointMass>(
          0, "augment", std::vector{index}, gdofs,
          fe::calc_rigid_mass(augment.mass / wtmass, augment.cg, augment.inertia / wtmass)));
    }
    return list;
  };
}

}  // namespace

BodyModel augment(const BodyRequest& request, const BodyModel& plain) {
  BodyModel result;
  if (request.spec.augments.empty()) return result;
  Diagnostics repeated;  // those of the plain model
  result.options = plain.options;
  result.model = std::make_unique<const fe::Model>(
      fe::build_model(request.deck, plain.options,
                      add_masses(request.make_factory(), request.spec.augments, plain.model->wtmass()), repeated));
  result.system = std::make_unique<const fe::System>(*result.model);
  return result;
}

void remove_augmentation(const BodyRequest& request, const fe::Model& model, modal::bases::Basis& basis) {
  if (request.is_free() && !basis.is_raw) {
    const auto C = modal::bases::calc_reference_conditions(model, modal::bases::FrameSpec{});
    basis.Phi = modal::bases::shift_to_frame(model, C, basis.Phi);
  }
  const MatrixXd M = basis.Phi.transpose() * fe::calc_mass_times(model, model.mass_kind(), basis.Phi);
  basis.M = linear::symmetrize(M);
  if (basis.is_raw || !request.spec.orthogonalize) {
    basis.lambda = basis.K.diagonal().cwiseQuotient(basis.M.diagonal());
    return;
  }
  const auto pairs = modal::bases::calc_ritz_pairs(basis.M, basis.K);
  basis.Phi = basis.Phi * pairs.N;
  for (Eigen::Index j = 0; j < basis.Phi.cols(); ++j) {
    Eigen::Index largest = 0;
    basis.Phi.col(j).cwiseAbs().maxCoeff(&largest);
    if (basis.Phi(largest, j) < 0) basis.Phi.col(j) *= -1;
  }
  const auto n = basis.Phi.cols();
  basis.lambda = pairs.lambda;
  basis.M = MatrixXd::Identity(n, n);
  basis.K = pairs.lambda.asDiagonal();
  // Normal modes are the lowest ones still; dependent vectors were dropped at the end.
  basis.kind.resize(static_cast<std::size_t>(n), records::ModeKind::Normal);
}

}  // namespace bough::stiffening
