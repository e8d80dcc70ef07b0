#include "fe/elements/element.hpp"

#include <algorithm>

#include "fe/elements/geometric_projection.hpp"
#include "fe/sections/stress.hpp"

namespace bough::fe {

void Element::add_stiffness(double, Eigen::Ref<MatrixXd>) const {}
void Element::add_mass(MassKind, double, Eigen::Ref<MatrixXd>) const {}
bool Element::add_carried(MassKind, const Eigen::Ref<const Matrix3Xd>&, CarriedMass&) const { return false; }
void Element::add_damping(double, Eigen::Ref<MatrixXd>) const {}

void Element::add_structural_damping(double g, Eigen::Ref<MatrixXd> K) const {
  if (g + structural_damping_ != 0) add_stiffness(g + structural_damping_, K);
}
void Element::calc_internal_forces(const Eigen::Ref<const VectorXd>&, Eigen::Ref<VectorXd>) const {}
void Element::calc_internal_forces_of(const Eigen::Ref<const MatrixXd>& U, Eigen::Ref<MatrixXd> forces) const {
  for (Eigen::Index c = 0; c < U.cols(); ++c) calc_internal_forces(U.col(c), forces.col(c));
}
VectorXd Element::calc_printed_forces(const Eigen::Ref<const VectorXd>& u) const {
  VectorXd force = VectorXd::Zero(num_internal_forces());
  calc_internal_forces(u, force);
  return force;
}
std::vector<StressPoint> Element::stress_points() const { return {}; }
MatrixXd Element::calc_stresses(const Eigen::Ref<const MatrixXd>& forces) const { return MatrixXd(0, forces.cols()); }
VectorXd Element::calc_initial_stresses(const ElementTemperature&) const { return {}; }
std::vector<StressPoint> Element::strain_points() const { return stress_points(); }
MatrixXd Element::calc_strains(const Eigen::Ref<const MatrixXd>& forces) const {
  BOUGH_DEMAND(strain_points().empty());  // who has points says what they strain
  return MatrixXd(0, forces.cols());
}
VectorXd Element::calc_thermal_strains(const ElementTemperature&) const { return {}; }
MatrixXd Element::calc_corner_strains(const Eigen::Ref<const MatrixXd>& forces) const {
  return MatrixXd(0, forces.cols());
}
VectorXd Element::calc_corner_thermal_strains(const ElementTemperature&) const { return {}; }
double Element::add_thermal(const ElementTemperature&, Eigen::Ref<VectorXd>, Eigen::Ref<VectorXd>) const { return 0; }
void Element::add_geometric_stiffness(const Eigen::Ref<const VectorXd>&, double, Eigen::Ref<MatrixXd>) const {}

void Element::add_projected_geometric_stiffness(const Eigen::Ref<const MatrixXd>& U,
                                                const Eigen::Ref<const MatrixXd>& Phi,
                                                GeometricProjection& sums) const {
  const Eigen::Index s = num_internal_forces(), m = U.cols();
  MatrixXd force(s, m), K_G(num_dofs(), num_dofs());
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

void ElementList::add(std::unique_ptr<const Element> element) {
  cards.insert(element->card());
  has_damping = has_damping || element->has_damping();
  elements.push_back(std::move(element));
}

}  // namespace bough::fe
