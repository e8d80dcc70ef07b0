#include <cmath>

#include "base/rotation.hpp"
#include "fe/corotational/best_fit.hpp"
#include "fe/corotational/fitted_core.hpp"

namespace bough::fe {

namespace {

using Eigen::Index;

/// b of T⁻¹(θ) = 1 - ½ θ̃ + b θ̃² as a function of |θ|², and its derivative.
std::pair<double, double> calc_inverse_coefficient(double square) {
  if (square > 0.5) {
    const double half = 0.5 * std::sqrt(square), cotangent = 1 / std::tan(half), sine = std::sin(half);
    const double b = (1 - half * cotangent) / square;
    return {b, ((half / (sine * sine) - cotangent) / (8 * half) - b) / square};
  }
  constexpr double kTerms[] = {1.0 / 12,       1.0 / 720,          1.0 / 30240,  1.0 / 1209600,
                               1.0 / 47900160, 5.284190138687e-10, 1.3382536e-11};
  double b = 0, derivative = 0;
  for (int k = 6; k >= 0; --k) {
    derivative = derivative * square + b;
    b = b * square + kTerms[k];
  }
  return {b, derivative};
}

}  // namespace

Matrix3d calc_inverse_rotation_tangent(const Vector3d& theta) {
  const Matrix3d S = skew(theta);
  return Matrix3d::Identity() - 0.5 * S + calc_inverse_coefficient(theta.squaredNorm()).first * S * S;
}

/// With g fixed: T⁻ᵀ g = g + ½ θ × g + b θ × (θ × g).
Matrix3d calc_inverse_tangent_slope(const Vector3d& theta, const Vector3d& g) {
  const auto [b, derivative] = calc_inverse_coefficient(theta.squaredNorm());
  const Vector3d once = theta.cross(g), twice = theta.cross(once);
  return -0.5 * skew(g) - b * (skew(once) + skew(theta) * skew(g)) + 2 * derivative * twice * theta.transpose();
}

Vector3d calc_rotation_log(const Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

void CorotationalElement::calc_local_forces(const ThermalState* heat, FiniteForces& result) const {
  const VectorXd& d = result.d;
  const Index N = d.size(), s = static_cast<Index>(P_.size());
  result.g = K_ * d;
  result.H = K_;
  result.energy = 0.5 * d.dot(result.g);
  if (heat) result.g -= heat->load;
  if (s == 0) return;
  MatrixXd Pd(N, s);
  for (Index m = 0; m < s; ++m) Pd.col(m) = P_[static_cast<std::size_t>(m)] * d;
  const VectorXd w = Pd.transpose() * d, strain = F_ * d, E_w = E_ * w;
  VectorXd h = strain + 0.5 * E_w;
  result.internal = h;
  result.energy += 0.5 * strain.dot(w) + 0.125 * w.dot(E_w);
  if (heat) {
    h += heat->force;
    result.energy += 0.5 * heat->force.dot(w);
  }
  result.g += 0.5 * (F_.transpose() * w) + Pd * h;
  const MatrixXd Pd_F = Pd * F_;
  result.H += Pd_F + Pd_F.transpose() + Pd * E_ * Pd.transpose();
  for (Index m = 0; m < s; ++m) result.H += h[m] * P_[static_cast<std::size_t>(m)];
}

FiniteForces CorotationalElement::calc_finite(const Eigen::Ref<const VectorXd>& u,
                                              const std::vector<Matrix3d>& rotations, const ThermalState* heat) const {
  BOUGH_DEMAND(follows_nodes_ && u.size() == num_dofs() && rotations.size() == translations_.size());
  const Index N = num_dofs();
  const auto num_nodes = static_cast<Index>(translations_.size());
  const double c = rotation_weight_;
  const auto row_x = [&](Index k) { return translations_[static_cast<std::size_t>(k)]; };
  const auto row_t = [&](Index k) { return rotations_[static_cast<std::size_t>(k)]; };

  // The frame: R nearest to the nodes.
  Matrix3Xd x = arms_;
  std::vector<FitGrid> grids;
  for (Index k = 0; k < num_nodes; ++k) {
    x.col(k) += u.segment<3>(row_x(k));
    grids.push_back({arms_.col(k), 1, c, row_x(k), row_t(k)});
  }
  x.colwise() -= x.rowwise().mean().eval();
  const BestFit fit(grids, x, rotations, static_cast<int>(N));
  const Matrix3d &R = fit.R(), Rt = R.transpose();

  FiniteForces result;
  result.d = VectorXd::Zero(N);
  Matrix3Xd y(3, num_nodes), theta = Matrix3Xd::Zero(3, num_nodes);
  for (Index k = 0; k < num_nodes; ++k) {
    y.col(k) = Rt * x.col(k);
    result.d.segment<3>(row_x(k)) = y.col(k) - arms_.col(k);
    if (row_t(k) < 0) continue;
    theta.col(k) = calc_rotation_log(fit.Q(static_cast<std::size_t>(k)));
    result.d.segment<3>(row_t(k)) = theta.col(k);
    result.max_turn = std::max(result.max_turn, theta.col(k).norm());
  }
  calc_local_forces(heat, result);
  const VectorXd& g = result.g;

  // Derivatives by the displacements and spins of the nodes: G of the frame's spin in its own axes, D of d.
  const Matrix3N& G = fit.G();
  Matrix3N mean = Matrix3N::Zero(3, N);
  for (Index k = 0; k < num_nodes; ++k) mean.middleCols<3>(row_x(k)) += Rt / static_cast<double>(num_nodes);
  MatrixXd D = MatrixXd::Zero(N, N);
  for (Index k = 0; k < num_nodes; ++k) {
    auto rows = D.middleRows<3>(row_x(k));
    rows = skew(y.col(k)) * G - mean;
    rows.middleCols<3>(row_x(k)) += Rt;
    if (row_t(k) < 0) continue;
    D.middleRows<3>(row_t(k)) =
        calc_inverse_rotation_tangent(theta.col(k)) * fit.calc_relative_spin(static_cast<std::size_t>(k));
  }
  result.f = D.transpose() * g;

  // ∂f = Dᵀ H D + ∂(Dᵀ) g. With the forces p and moments m of g in the frame, mu = S⁻¹ Σ (y × p + m):
  // f_x = R (p - mean p - mu × a), f_φ = R (m - c (tr Q 1 - Qᵀ) mu).
  Vector3d tau = Vector3d::Zero(), p_mean = Vector3d::Zero();
  Matrix3N d_tau = Matrix3N::Zero(3, N);
  Matrix3Xd m = Matrix3Xd::Zero(3, num_nodes);
  std::vector<Matrix3N> d_m(static_cast<std::size_t>(num_nodes));
  for (Index k = 0; k < num_nodes; ++k) {
    const Vector3d p = g.segment<3>(row_x(k));
    p_mean += p / static_cast<double>(num_nodes);
    tau += y.col(k).cross(p);
    d_tau -= skew(p) * D.middleRows<3>(row_x(k));
    if (row_t(k) < 0) continue;
    const Vector3d g_theta = g.segment<3>(row_t(k));
    m.col(k) = calc_inverse_rotation_tangent(theta.col(k)).transpose() * g_theta;
    d_m[static_cast<std::size_t>(k)] = calc_inverse_tangent_slope(theta.col(k), g_theta) * D.middleRows<3>(row_t(k));
    tau += m.col(k);
    d_tau += d_m[static_cast<std::size_t>(k)];
  }
  const Vector3d mu = fit.calc_mu(tau);
  const Matrix3N d_mu = fit.calc_mu_slope(mu, d_tau);
  result.K = D.transpose() * result.H * D;
  for (Index k = 0; k < num_nodes; ++k) {
    const Vector3d arm = arms_.col(k), p = g.segment<3>(row_x(k));
    const Vector3d h = p - p_mean - mu.cross(arm);
    result.K.middleRows<3>(row_x(k)) += R * (skew(arm) * d_mu - skew(h) * G);
    if (row_t(k) < 0) continue;
    const auto at = static_cast<std::size_t>(k);
    const Vector3d n = m.col(k) - c * fit.back(at) * mu;
    result.K.middleRows<3>(row_t(k)) += R * (d_m[at] - c * fit.calc_back_slope(at, mu, d_mu) - skew(n) * G);
  }
  if (fitted_) fitted_->calc_finite(u, result);
  return result;
}

}  // namespace bough::fe
