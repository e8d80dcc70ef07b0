#include "fe/elements/direct.hpp"

#include "fe/elements/carried.hpp"

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

bool DirectElement::is_plain() const {
  if (block_.rows() == 1 || block_.cols() == 1) return true;  // scalar points do not turn
  MatrixXd rest = block_;
  rest.topLeftCorner<3, 3>() -= block_(0, 0) * Matrix3d::Identity();
  return rest.cwiseAbs().maxCoeff() <= 1e-12 * block_.cwiseAbs().maxCoeff();
}

bool DirectElement::add_carried(MassKind, const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const {
  MassMoments moments;
  if (num_dofs() != 6 || !find_moments(block_, moments)) return false;
  carried.add_grid_body(x.col(0), moments.m, moments.S, moments.E, 0);
  return true;
}

}  // namespace bough::fe
