#pragma once
/// \file Dual numbers: a value and its derivative along one direction (forward automatic differentiation).
///
/// Equal values compare by their derivatives: a piecewise smooth law, written with comparisons, yields its one-sided
/// directional derivative at a kink. Source: Griewank & Walther, Evaluating Derivatives, 2nd ed. 2008, ch. 3 and 14.
#include <algorithm>
#include <cmath>

namespace bough::solver {

struct Dual {
  double x = 0, dx = 0;
  Dual() = default;
  Dual(double value, double derivative = 0) : x(value), dx(derivative) {}  // NOLINT: constants mix with duals
};

inline Dual operator+(Dual a, Dual b) { return {a.x + b.x, a.dx + b.dx}; }
inline Dual operator-(Dual a, Dual b) { return {a.x - b.x, a.dx - b.dx}; }
inline Dual operator-(Dual a) { return {-a.x, -a.dx}; }
inline Dual operator*(Dual a, Dual b) { return {a.x * b.x, a.dx * b.x + a.x * b.dx}; }
inline Dual operator/(Dual a, Dual b) { return {a.x / b.x, (a.dx - a.x / b.x * b.dx) / b.x}; }
inline Dual& operator+=(Dual& a, Dual b) { return a = a + b; }
inline Dual& operator-=(Dual& a, Dual b) { return a = a - b; }
inline bool operator<(Dual a, Dual b) { return a.x < b.x || (a.x == b.x && a.dx < b.dx); }
inline bool operator>(Dual a, Dual b) { return b < a; }
inline bool operator==(Dual a, Dual b) { return a.x == b.x && a.dx == b.dx; }
inline bool operator!=(Dual a, Dual b) { return !(a == b); }

inline Dual abs(Dual a) { return a < Dual(0) ? -a : a; }
inline Dual exp(Dual a) { return {std::exp(a.x), std::exp(a.x) * a.dx}; }
inline Dual tanh(Dual a) {
  const double y = std::tanh(a.x), c = std::cosh(a.x);
  return {y, std::isfinite(c) ? a.dx / (c * c) : 0};
}
/// At 0 of a sum of squares the derivative is that of the norm, abs(dx) at most: callers keep the argument positive.
inline Dual sqrt(Dual a) { return {std::sqrt(a.x), a.dx == 0 ? 0 : a.dx / (2 * std::sqrt(a.x))}; }
inline Dual pow(Dual a, double e) { return {std::pow(a.x, e), a.dx == 0 ? 0 : e * std::pow(a.x, e - 1) * a.dx}; }

}  // namespace bough::solver
