#include "formats/records/random_response.hpp"

#include <cmath>

namespace bough::records {

double integrate_density(double a, double b, double S_a, double S_b, int r, bool is_loglog) {
  if (is_loglog && a > 0 && S_a > 0 && S_b > 0) {
    // S = S_a (f/a)^m.
    const double ratio = std::log(b / a), power = std::log(S_b / S_a) + (r + 1) * ratio;
    return S_a * std::pow(a, r + 1) * ratio * (std::abs(power) < 1e-8 ? 1 : std::expm1(power) / power);
  }
  if (r == 0) return (b - a) / 2 * (S_a + S_b);
  return (b - a) / 12 * (S_a * (3 * a * a + 2 * a * b + b * b) + S_b * (a * a + 2 * a * b + 3 * b * b));
}

Eigen::MatrixXd calc_cumulative_rms(const RandomResponse& response, const RandomCurves& curves) {
  const auto& hz = response.hz;
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(curves.psd.rows(), curves.psd.cols());
  for (Eigen::Index i = 1; i < hz.size(); ++i)
    for (Eigen::Index c = 0; c < sums.cols(); ++c)
      sums(i, c) = sums(i - 1, c) +
                   integrate_density(hz(i - 1), hz(i), curves.psd(i - 1, c), curves.psd(i, c), 0, response.is_loglog);
  return sums.cwiseSqrt();
}

}  // namespace bough::records
