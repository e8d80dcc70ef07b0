#include "modal/eigen.hpp"

namespace bough::modal {

MatrixXd calc_effective_mass(const fe::Model& model, const MatrixXd& Phi) {
  return calc_effective_mass(model, Phi, fe::calc_mass_times(model, model.mass_kind(), Phi));
}

MatrixXd calc_effective_mass(const fe::Model& model, const MatrixXd& Phi, const MatrixXd& M_Phi) {
  const MatrixXd L = M_Phi.transpose() * model.calc_rigid_modes();
  const VectorXd modal_mass = Phi.cwiseProduct(M_Phi).colwise().sum();
  return modal_mass.cwiseInverse().asDiagonal() * L.cwiseAbs2();
}

}  // namespace bough::modal
