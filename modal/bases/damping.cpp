#include "modal/bases/damping.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "modal/bases/ritz.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::bases {

namespace {

/// To the digits of mode shapes from a file.
bool is_diagonal(const MatrixXd& A) {
  for (Eigen::Index j = 0; j < A.cols(); ++j)
    for (Eigen::Index i = 0; i < j; ++i)
      if (std::abs(A(i, j)) > detail::kShapeDigits * std::sqrt(std::abs(A(i, i) * A(j, j)))) return false;
  return true;
}

}  // namespace

bool DampingSpec::is_zero() const {
  return ratio == 0 && ratios.empty() && table.empty() && alpha == 0 && beta == 0 && structural == 0 &&
         residual_ratio.value_or(0) == 0;
}

double calc_table_ratio(const DampingSpec& spec, double hz) {
  const auto& t = spec.table;
  double value = t.front().second;
  if (t.size() > 1) {
    std::size_t i = 1;
    while (i + 1 < t.size() && hz > t[i].first) ++i;
    const double share = (hz - t[i - 1].first) / (t[i].first - t[i - 1].first);
    value = t[i - 1].second + share * (t[i].second - t[i - 1].second);
  }
  if (spec.table_kind == DampingTable::Structural) return 0.5 * value;
  if (spec.table_kind == DampingTable::Quality) return 0.5 / value;
  return value;
}

MatrixXd calc_damping(const MatrixXd& M, const MatrixXd& K, const DampingSpec& spec, const MatrixXd& K_g,
                      const std::vector<bool>& is_residual) {
  if (M.rows() == 0) return M;
  const VectorXd mass = M.diagonal();
  const bool is_modal = mass.minCoeff() > 0 && is_diagonal(M) && is_diagonal(K);
  VectorXd lambda = K.diagonal().cwiseQuotient(mass);
  MatrixXd N = mass.cwiseMax(detail::kTiny).cwiseSqrt().cwiseInverse().asDiagonal();
  if (!is_modal) {
    const auto pairs = calc_ritz_pairs(M, K);
    lambda = pairs.lambda;
    N = pairs.N;
  }
  const VectorXd omega = lambda.cwiseMax(0).cwiseSqrt();
  VectorXd C(omega.size());
  for (Eigen::Index j = 0; j < omega.size(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    double zeta = spec.ratio;
    if (i < spec.ratios.size()) zeta = spec.ratios[i];
    if (!spec.table.empty()) zeta = calc_table_ratio(spec, omega(j) / (2 * std::numbers::pi));
    if (is_modal && spec.residual_ratio && i < is_residual.size() && is_residual[i]) zeta = *spec.residual_ratio;
    C(j) = (2 * zeta + spec.structural) * omega(j);
    if (K_g.size() > 0 && omega(j) > 0) C(j) += N.col(j).dot(K_g * N.col(j)) / omega(j);
  }
  if (is_modal) return MatrixXd((C.cwiseProduct(mass)).asDiagonal()) + spec.alpha * M + spec.beta * K;
  const MatrixXd MN = M * N;
  return MN * C.asDiagonal() * MN.transpose() + spec.alpha * M + spec.beta * K;
}

}  // namespace bough::modal::bases
