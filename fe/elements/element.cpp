#include "bough/fe/elements/element.hpp"

namespace bough::fe {

void Element::add_stiffness(double, Eigen::Ref<MatrixXd>) const {}
void Element::add_mass(MassKind, double, Eigen::Ref<MatrixXd>) const {}
void Element::add_damping(double, Eigen::Ref<MatrixXd>) const {}
void Element::calc_internal_forces(const Eigen::Ref<const VectorXd>&, Eigen::Ref<VectorXd>) const {}
double Element::add_thermal(const ElementTemperature&, Eigen::Ref<VectorXd>, Eigen::Ref<VectorXd>) const { return 0; }
void Element::add_geometric_stiffness(const Eigen::Ref<const VectorXd>&, double, Eigen::Ref<MatrixXd>) const {}

}  // namespace bough::fe
