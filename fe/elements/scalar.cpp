#include "bough/fe/elements/scalar.hpp"

namespace bough::fe {

void ScalarSpring::add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const {
  K.noalias() += scale * k_ * b_ * b_.transpose();
}

void ScalarDamper::add_damping(double scale, Eigen::Ref<MatrixXd> B) const {
  B.noalias() += scale * coefficient_ * b_ * b_.transpose();
}

void ScalarMass::add_mass(MassKind, double scale, Eigen::Ref<MatrixXd> M) const {
  M.noalias() += scale * m_ * b_ * b_.transpose();
}

}  // namespace bough::fe
