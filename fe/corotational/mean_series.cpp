#include "fe/corotational/mean_series.hpp"

#include "fe/corotational/best_fit.hpp"

namespace bough::fe {

MeanSeries::MeanSeries(const WeightedMean& mean, const std::vector<MatrixXd>& u) : mean_(mean) {
  centre_ = make_zero_vector();
  SeriesMatrix B = make_zero_matrix();
  rotation_.assign(mean.members.size(), make_zero_vector());
  turned_.resize(mean.members.size());
  for (const MeanMember& member : mean.members) total_ += member.weight;
  for (std::size_t i = 0; i < mean.members.size(); ++i) {
    const MeanMember& member = mean.members[i];
    const SeriesVector moved = get_vector(u[i], 0);  // Σ w X = 0: B needs no mean of it
    B[0] += member.weight * member.arm * member.arm.transpose();
    for (std::size_t k = 0; k < B.size(); ++k) {
      centre_[k] += member.weight / total_ * moved[k];
      B[k] += member.weight * moved[k] * member.arm.transpose();
    }
    if (member.turn_weight == 0) continue;
    rotation_[i] = get_vector(u[i], 3);
    turned_[i] = calc_exponential(rotation_[i]);
    for (std::size_t k = 0; k < B.size(); ++k) B[k] += 0.5 * member.turn_weight * turned_[i][k];
  }
  inverse_ = invert_symmetric(B[0].trace() * Matrix3d::Identity() - B[0]);
  find_nearest_rotation(B, inverse_, R_, H_);
  theta_ = calc_logarithm(R_);
  for (std::size_t i = 0; i < mean.members.size(); ++i)
    if (mean.members[i].turn_weight != 0) turned_[i] = rotate_back(R_, turned_[i]);
}

MatrixXd MeanSeries::calc_motion(const Vector3d& arm) const {
  SeriesVector moved = centre_;
  for (std::size_t k = 1; k < moved.size(); ++k) moved[k] += R_[k] * arm;
  MatrixXd u(6, kSeriesTop);
  put_vector(moved, 0, u);
  put_vector(theta_, 3, u);
  return u;
}

std::vector<MatrixXd> MeanSeries::calc_forces(const Vector3d& arm, const Eigen::Ref<const MatrixXd>& forces) const {
  const SeriesVector force = get_vector(forces, 0);
  // The moment on the spin of R, seen from it.
  SeriesVector tau = rotate_back(R_, apply_inverse_tangent_transpose(theta_, get_vector(forces, 3)));
  const SeriesVector seen = rotate_back(R_, force);
  for (std::size_t k = 0; k < tau.size(); ++k) tau[k] += arm.cross(seen[k]);
  // R turns by (tr H 1 - H)⁻¹ (Σ w X × Rᵀδx + ½ Σ w_r (tr Q 1 - Q) Rᵀδφ), Q = RᵀR_k.
  const SeriesVector mu = solve(subtract_from_trace(H_), inverse_, tau);
  std::vector<MatrixXd> on_members;
  for (std::size_t i = 0; i < mean_.members.size(); ++i) {
    const MeanMember& member = mean_.members[i];
    SeriesVector f;
    for (std::size_t k = 0; k < f.size(); ++k) f[k] = member.weight * mu[k].cross(member.arm);
    f = rotate(R_, f);
    for (std::size_t k = 0; k < f.size(); ++k) f[k] += member.weight / total_ * force[k];
    MatrixXd& of_member = on_members.emplace_back(MatrixXd::Zero(6, kSeriesTop));
    put_vector(f, 0, of_member);
    if (member.turn_weight == 0) continue;
    SeriesVector m = multiply(transpose(subtract_from_trace(turned_[i])), mu);
    for (auto& order : m) order *= 0.5 * member.turn_weight;
    put_vector(apply_tangent_transpose(rotation_[i], rotate(R_, m)), 3, of_member);
  }
  return on_members;
}

}  // namespace bough::fe
