#include "bough/fe/elements/direct.hpp"

namespace bough::fe {

void DirectElement::add_block(double scale, Eigen::Ref<MatrixXd> A) const {
  const auto rows = block_.rows(), columns = block_.cols();
  if (A.rows() == rows) {
    A += scale * block_;
    return;
  }
  A.topRightCorner(rows, columns) += scale * block_;
  A.bottomLeftCorner(columns, rows) += scale * block_.transpose();
}

void DirectElement::add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const {
  if (kind_ == DirectKind::Stiffness) add_block(scale, K);
}
void DirectElement::add_mass(MassKind, double scale, Eigen::Ref<MatrixXd> M) const {
  if (kind_ == DirectKind::Mass) add_block(scale, M);
}
void DirectElement::add_damping(double scale, Eigen::Ref<MatrixXd> B) const {
  if (kind_ == DirectKind::Damping) add_block(scale, B);
}

}  // namespace bough::fe
