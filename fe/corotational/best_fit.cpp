#include "fe/corotational/best_fit.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include "base/rotation.hpp"

namespace bough::fe {
namespace {

/// The rotation nearest to B.
Matrix3d find_nearest_rotation(const Matrix3d& B) {
  const Eigen::JacobiSVD<Matrix3d> svd(B, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector3d sign(1, 1, 1);
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign[2] = -1;
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

}  // namespace

Matrix3d invert_symmetric(const Matrix3d& A) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(A);
  Vector3d inverse = eigen.eigenvalues();
  for (double& value : inverse) value = value > 1e-12 * eigen.eigenvalues()[2] ? 1 / value : 0;
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

Vector3d calc_axis(const Matrix3d& A) { return {A(2, 1) - A(1, 2), A(0, 2) - A(2, 0), A(1, 0) - A(0, 1)}; }

Matrix3d subtract_from_trace(const Matrix3d& A) { return A.trace() * Matrix3d::Identity() - A; }

BestFit::BestFit(const std::vector<FitGrid>& grids, const Matrix3Xd& x, const std::vector<Matrix3d>& rotations, int N)
    : grids_(grids), Q_(grids.size(), Matrix3d::Identity()), G_(Matrix3N::Zero(3, N)) {
  Matrix3d B = Matrix3d::Zero();
  for (std::size_t k = 0; k < grids.size(); ++k) {
    B += grids[k].weight * x.col(static_cast<Eigen::Index>(k)) * grids[k].arm.transpose();
    if (grids[k].rotations >= 0) B += grids[k].turn_weight * rotations[k];
  }
  R_ = find_nearest_rotation(B);
  const Matrix3d Rt = R_.transpose();
  H_ = 0.5 * (Rt * B + (Rt * B).transpose());
  S_inverse_ = invert_symmetric(subtract_from_trace(H_));
  for (std::size_t k = 0; k < grids.size(); ++k) {
    const FitGrid& grid = grids[k];
    G_.middleCols<3>(grid.translations) += grid.weight * skew(grid.arm) * Rt;
    if (grid.rotations < 0) continue;
    Q_[k] = Rt * rotations[k];
    G_.middleCols<3>(grid.rotations) += grid.turn_weight * subtract_from_trace(Q_[k]) * Rt;
  }
  G_ = (S_inverse_ * G_).eval();
}

Matrix3N BestFit::calc_relative_spin(std::size_t k) const {
  Matrix3N spin = -G_;
  spin.middleCols<3>(grids_[k].rotations) += R_.transpose();
  return spin;
}

Matrix3N BestFit::calc_mu_slope(const Vector3d& mu, const Matrix3N& d_tau) const {
  const Matrix3d Rt = R_.transpose();
  Matrix3N d_H_mu = skew(H_ * mu) * G_;
  Eigen::RowVectorXd d_trace = Eigen::RowVectorXd::Zero(G_.cols());
  for (std::size_t k = 0; k < grids_.size(); ++k) {
    const FitGrid& grid = grids_[k];
    d_H_mu.middleCols<3>(grid.translations) += grid.weight * grid.arm.dot(mu) * Rt;
    d_trace.segment<3>(grid.translations) += grid.weight * grid.arm.transpose() * Rt;
    if (grid.rotations < 0) continue;
    d_H_mu.middleCols<3>(grid.rotations) -= grid.turn_weight * skew(Q_[k] * mu) * Rt;
    d_trace.segment<3>(grid.rotations) -= grid.turn_weight * calc_axis(Q_[k]).transpose() * Rt;
  }
  return S_inverse_ * (d_tau - mu * d_trace + d_H_mu);
}

Matrix3N BestFit::calc_back_slope(std::size_t k, const Vector3d& mu, const Matrix3N& d_mu) const {
  const Matrix3N spin = calc_relative_spin(k);
  return -mu * (calc_axis(Q_[k]).transpose() * spin) - Q_[k].transpose() * skew(mu) * spin + back(k) * d_mu;
}

}  // namespace bough::fe
