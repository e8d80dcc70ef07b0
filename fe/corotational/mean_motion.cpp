#include "fe/corotational/mean_motion.hpp"

#include "base/rotation.hpp"

namespace bough::fe {
namespace {

using Eigen::Index;

std::vector<FitGrid> list_fit_grids(const WeightedMean& mean) {
  std::vector<FitGrid> grids;
  for (const MeanMember& member : mean.members) {
    const int first = 6 * static_cast<int>(grids.size());
    grids.push_back(
        {member.arm, member.weight, 0.5 * member.turn_weight, first, member.turn_weight == 0 ? -1 : first + 3});
  }
  return grids;
}

Matrix3Xd calc_places(const WeightedMean& mean, const Matrix3Xd& u) {
  Matrix3Xd x = u;
  for (std::size_t k = 0; k < mean.members.size(); ++k) x.col(static_cast<Index>(k)) += mean.members[k].arm;
  return x;
}

}  // namespace

MeanMotion::MeanMotion(const WeightedMean& mean, const Matrix3Xd& u, const std::vector<Matrix3d>& rotations)
    : grids_(list_fit_grids(mean)), fit_(grids_, calc_places(mean, u), rotations, 6 * static_cast<int>(grids_.size())) {
  for (const MeanMember& member : mean.members) total_ += member.weight;
  for (std::size_t k = 0; k < grids_.size(); ++k) centre_ += grids_[k].weight / total_ * u.col(static_cast<Index>(k));
}

MatrixXd MeanMotion::calc_tangent(const Vector3d& arm) const {
  const Matrix3d& R = fit_.R();
  MatrixXd A(6, fit_.G().cols());
  A.bottomRows<3>() = R * fit_.G();
  A.topRows<3>() = -skew(R * arm) * A.bottomRows<3>();
  for (const FitGrid& grid : grids_) A.block<3, 3>(0, grid.translations) += grid.weight / total_ * Matrix3d::Identity();
  return A;
}

MatrixXd MeanMotion::calc_slope(const Vector3d& arm, const Vector3d& force, const Vector3d& moment) const {
  const Matrix3d &R = fit_.R(), Rt = R.transpose();
  const Matrix3N& G = fit_.G();
  // The moment on the spin of R, seen from it: τ = Rᵀm + s × Rᵀf; δ(Rᵀv) = Rᵀv × G.
  const Vector3d tau = Rt * moment + arm.cross(Rt * force);
  const Matrix3N d_tau = (skew(Rt * moment) + skew(arm) * skew(Rt * force)) * G;
  const Vector3d mu = fit_.calc_mu(tau);
  const Matrix3N d_mu = fit_.calc_mu_slope(mu, d_tau);
  MatrixXd slope = MatrixXd::Zero(G.cols(), G.cols());
  for (std::size_t k = 0; k < grids_.size(); ++k) {
    const FitGrid& grid = grids_[k];
    slope.middleRows<3>(grid.translations) = -grid.weight * R * (skew(mu.cross(grid.arm)) * G + skew(grid.arm) * d_mu);
    if (grid.rotations < 0) continue;
    slope.middleRows<3>(grid.rotations) =
        grid.turn_weight * R * (fit_.calc_back_slope(k, mu, d_mu) - skew(fit_.back(k) * mu) * G);
  }
  return slope;
}

}  // namespace bough::fe
