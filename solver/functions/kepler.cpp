#include "solver/functions/kepler.hpp"

#include <cmath>
#include <numbers>

namespace bough::solver {
namespace {

/// E - e sin E = M by Newton's method from E = M + e sin M, within |M| <= π; safe by bisection.
double solve_kepler(double M, double e) {
  double low = M - e, high = M + e, E = M + e * std::sin(M);
  constexpr int kMaxIterations = 60;
  for (int i = 0; i < kMaxIterations; ++i) {
    const double residual = E - e * std::sin(E) - M;
    (residual > 0 ? high : low) = E;
    const double step = residual / (1 - e * std::cos(E));
    const double next = E - step;
    if (std::abs(step) <= 4e-16 * (1 + std::abs(E))) return next;
    E = next > low && next < high ? next : 0.5 * (low + high);
  }
  return E;
}

class KeplerFunction final : public TimeFunction {
 public:
  KeplerFunction(double mu, double a, double e, double M0, double t0, int component)
      : mu_(mu), a_(a), e_(e), M0_(M0), t0_(t0), n_(std::sqrt(mu / (a * a * a))), component_(component) {}

  Value calc(double t) const override {
    const double M = M0_ + n_ * (t - t0_), turns = std::round(M / (2 * std::numbers::pi));
    const double E = solve_kepler(M - 2 * std::numbers::pi * turns, e_);
    const double c = std::cos(E), s = std::sin(E), root = std::sqrt(1 - e_ * e_);
    const double r = a_ * (1 - e_ * c), E_dot = n_ * a_ / r;
    if (component_ == 2) {
      // ν = E + 2 atan(β sin E/(1 - β cos E)) has no branch; ν̇ = h/r², ν̈ = -2 ν̇ ṙ/r.
      const double beta = e_ / (1 + root), rate = n_ * a_ * a_ * root / (r * r);
      const double anomaly = E + 2 * std::atan2(beta * s, 1 - beta * c) + 2 * std::numbers::pi * turns;
      return {anomaly, rate, -2 * rate * a_ * e_ * s * E_dot / r};
    }
    const double x = component_ == 0 ? a_ * (c - e_) : a_ * root * s;
    const double x_dot = component_ == 0 ? -a_ * s * E_dot : a_ * root * c * E_dot;
    return {x, x_dot, -mu_ * x / (r * r * r)};
  }

 private:
  double mu_, a_, e_, M0_, t0_, n_;
  int component_;
};

}  // namespace

std::unique_ptr<const TimeFunction> make_kepler(FunctionParameters& p) {
  const double mu = p.get("mu"), a = p.get("semi_major_axis"), e = p.get("eccentricity");
  const double M0 = p.get("mean_anomaly"), t0 = p.get("at"), component = p.get("component");
  p.demand(mu > 0 && a > 0 && e >= 0 && e < 1, "is no ellipse",
           "give mu and semi_major_axis > 0, 0 <= eccentricity < 1");
  return std::make_unique<KeplerFunction>(mu, a, e, M0, t0, static_cast<int>(component));
}

}  // namespace bough::solver
