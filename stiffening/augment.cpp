// Modes of the body with the mass of what hangs on it, which goes out again (docs/theory/bases.md).
#include "stiffening/augment.hpp"

#include "fe/elements/point_mass.hpp"
#include "fe/statics/build_model.hpp"
#include "stiffening/reduction.hpp"

namespace bough::stiffening {

namespace {

/// Behind those of the deck: a prestress knows the elements by their order.
fe::ElementFactory add_masses(const fe::ElementFactory& factory, const std::vector<records::AugmentSpec>& augments,
                              double wtmass) {
  return [=](const records::Deck& deck, const fe::NodeTable& nodes, Diagnostics& diagnostics) {
    auto list = factory(deck, nodes, diagnostics);
    for (const auto& augment : augments) {
      const int index = nodes.find_node(augment.node);
      BOUGH_DEMAND(index >= 0);
      std::vector<int> gdofs;
      for (int c = 0; c < 6; ++c) gdofs.push_back(nodes.node(index).first_gdof + c);
      // Assembly scales every mass.
      list.elements.push_back(std::make_unique<fe::PointMass>(
          0, "augment", std::vector{index}, gdofs,
          fe::calc_rigid_mass(augment.mass / wtmass, augment.cg, augment.inertia / wtmass)));
    }
    return list;
  };
}

}  // namespace

std::unique_ptr<const Augmented> Reduction::augment(const fe::Model& model) const {
  if (spec_.augments.empty()) return nullptr;
  auto options = model_options_;
  const auto factory = options_.elements ? options_.elements : fe::make_elements;
  Diagnostics reported;  // the model without the masses has said it
  return std::make_unique<const Augmented>(
      fe::build_model(deck_, options, add_masses(factory, spec_.augments, model.wtmass()), reported));
}

void Reduction::take_off_augmentation(const fe::Model& model, modal::bases::Basis& basis) const {
  if (is_free() && !basis.is_raw) {
    const auto C = modal::bases::calc_reference_conditions(model, modal::bases::FrameSpec{});
    basis.Phi = modal::bases::shift_to_frame(model, C, basis.Phi);
  }
  const MatrixXd M = basis.Phi.transpose() * fe::calc_mass_times(model, model.mass_kind(), basis.Phi);
  basis.M = 0.5 * (M + M.transpose());
  if (basis.is_raw || !spec_.orthogonalize) {
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
  // Normal modes are the lowest, as before; what was dropped was dependent.
  basis.kind.resize(static_cast<std::size_t>(n), records::ModeKind::Normal);
}

}  // namespace bough::stiffening
