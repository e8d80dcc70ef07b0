#include "report/shock_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <unsupported/Eigen/MatrixFunctions>

#include "base/diagnostic.hpp"

namespace bough::report {

namespace {

using Eigen::Matrix2d;
using Eigen::RowVector2d;
using Eigen::Vector2d;
using Eigen::VectorXd;

struct Extremes {
  double high = 0, low = 0;
  void add(double value) {
    high = std::max(high, value);
    low = std::min(low, value);
  }
  double size() const { return std::max(high, -low); }
};

/// The response as C [z; ż].
RowVector2d choose_output(ShockKind kind, double omega, double zeta) {
  switch (kind) {
    case ShockKind::AbsoluteAcceleration:
      return {-omega * omega, -2 * zeta * omega};
    case ShockKind::StaticAcceleration:
      return {-omega * omega, 0};
    case ShockKind::PseudoVelocity:
      return {omega, 0};
    case ShockKind::RelativeVelocity:
      return {0, 1};
    default:
      return {1, 0};
  }
}

/// Extremes of y = e^(-σt) (A cos ω_d t + B sin ω_d t), t >= 0: the values at 0 and at the first two stationary points.
void add_free(double A, double B, double sigma, double omega_d, Extremes& extremes) {
  extremes.add(A);
  double angle = std::atan2(omega_d * B - sigma * A, omega_d * A + sigma * B);
  if (angle <= 0) angle += std::numbers::pi;
  for (const double at : {angle, angle + std::numbers::pi})
    extremes.add(std::exp(-sigma * at / omega_d) * (A * std::cos(at) + B * std::sin(at)));
}

double calc_value(const VectorXd& a, double step, double hz, double quality, ShockKind kind, ShockPart part) {
  const double omega = 2 * std::numbers::pi * hz, zeta = 0.5 / quality;
  // In the time ωt: z'' + 2ζ z' + z = -a/ω², with states ω² z, ω ż; the inputs are a and its change over a step.
  const double h = omega * step;
  Eigen::Matrix4d generator = Eigen::Matrix4d::Zero();
  generator.row(0) << 0, h, 0, 0;
  generator.row(1) << -h, -2 * zeta * h, -h, 0;
  generator(2, 3) = 1;
  const Eigen::Matrix4d step_matrix = generator.exp();
  const Matrix2d E = step_matrix.topLeftCorner<2, 2>();
  const Matrix2d F = step_matrix.topRightCorner<2, 2>();
  const RowVector2d plain = choose_output(kind, omega, zeta);
  const RowVector2d C(plain(0) / (omega * omega), plain(1) / omega);
  Extremes primary, residual;
  Vector2d x = Vector2d::Zero();
  for (Eigen::Index k = 1; k < a.size(); ++k) {
    x = (E * x + F * Vector2d(a[k - 1], a[k] - a[k - 1])).eval();
    primary.add(C * x);
  }
  // C x(t) from x0: C e^(At) x0, its rate at 0 is C A x0 (in the time ωt).
  Matrix2d A;
  A << 0, 1, -1, -2 * zeta;
  const double omega_d = std::sqrt(1 - zeta * zeta);
  const double y = C * x, rate = C * A * x;
  add_free(y, (rate + zeta * y) / omega_d, zeta, omega_d, residual);
  switch (part) {
    case ShockPart::Positive:
      return std::max(primary.high, residual.high);
    case ShockPart::Negative:
      return std::max(-primary.low, -residual.low);
    case ShockPart::Primary:
      return primary.size();
    case ShockPart::Residual:
      return residual.size();
    default:
      return std::max(primary.size(), residual.size());
  }
}

}  // namespace

const std::vector<std::string>& list_shock_kinds() {
  static const std::vector<std::string> names{"absolute-acceleration", "static-acceleration", "pseudo-velocity",
                                              "relative-velocity", "relative-displacement"};
  return names;
}

const std::vector<std::string>& list_shock_parts() {
  static const std::vector<std::string> names{"maximax", "positive", "negative", "primary", "residual"};
  return names;
}

ShockKind find_shock_kind(const std::string& name) {
  const auto& all = list_shock_kinds();
  const auto found = std::find(all.begin(), all.end(), name);
  BOUGH_DEMAND(found != all.end());
  return static_cast<ShockKind>(found - all.begin());
}

ShockPart find_shock_part(const std::string& name) {
  const auto& all = list_shock_parts();
  const auto found = std::find(all.begin(), all.end(), name);
  BOUGH_DEMAND(found != all.end());
  return static_cast<ShockPart>(found - all.begin());
}

VectorXd calc_shock_spectrum(const VectorXd& acceleration, double step, const VectorXd& hz, double quality,
                             ShockKind kind, ShockPart part) {
  BOUGH_DEMAND(step > 0 && quality > 0.5);
  VectorXd values(hz.size());
  for (Eigen::Index i = 0; i < hz.size(); ++i) values[i] = calc_value(acceleration, step, hz[i], quality, kind, part);
  return values;
}

}  // namespace bough::report
