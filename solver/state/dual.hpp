#pragma once
/// \file Dual numbers: a value and its derivative along one direction (forward automatic differentiation).
///
/// Equal values compare by their derivatives: a piecewise smooth function, written with comparisons, yields its
/// one-sided directional derivative at a kink. Source: Griewank & Walther, Evaluating Derivatives, 2nd ed. 2008, ch. 3
/// and 14.
#include <algorithm>
#include <cmath>

namespace bough::solver {

struct Dual {
  double x = 0, dx = 0;
  Dual() = default;
  /// A constant has the derivative 0.
  Dual(double value, double derivative = 0) : x(value), dx(derivative) {}  // NOLINT: constants mix with duals
};

/// Sum rule.
inline Dual operator+(Dual a, Dual b) { return {a.x + b.x, a.dx + b.dx}; }
/// Difference rule.
inline Dual operator-(Dual a, Dual b) { return {a.x - b.x, a.dx - b.dx}; }
/// Negates value and derivative.
inline Dual operator-(Dual a) { return {-a.x, -a.dx}; }
/// Product rule.
inline Dual operator*(Dual a, Dual b) { return {a.x * b.x, a.dx * b.x + a.x * b.dx}; }
/// Quotient rule; not finite for b.x = 0.
inline Dual operator/(Dual a, Dual b) { return {a.x / b.x, (a.dx - a.x / b.x * b.dx) / b.x}; }
/// Adds b to a.
inline Dual& operator+=(Dual& a, Dual b) { return a = a + b; }
/// Subtracts b from a.
inline Dual& operator-=(Dual& a, Dual b) { return a = a - b; }
/// Compares values, equal values by derivatives.
inline bool operator<(Dual a, Dual b) { return a.x < b.x || (a.x == b.x && a.dx < b.dx); }
/// Compares values, equal values by derivatives.
inline bool operator>(Dual a, Dual b) { return b < a; }
/// Returns true if values and derivatives are equal.
inline bool operator==(Dual a, Dual b) { return a.x == b.x && a.dx == b.dx; }
/// Returns true if a value or a derivative differs.
inline bool operator!=(Dual a, Dual b) { return !(a == b); }

/// One-sided at 0: the derivative is |dx|.
inline Dual abs(Dual a) { return a < Dual(0) ? -a : a; }
/// exp(x), derivative exp(x) dx.
inline Dual exp(Dual a) { return {std::exp(a.x), std::exp(a.x) * a.dx}; }
/// tanh(x); derivative 0 once cosh(x) overflows.
inline Dual tanh(Dual a) {
  const double y = std::tanh(a.x), c = std::cosh(a.x);
  return {y, std::isfinite(c) ? a.dx / (c * c) : 0};
}
/// At 0 of a sum of squares the derivative is that of the norm, abs(dx) at most: callers keep the argument positive.
inline Dual sqrt(Dual a) { return {std::sqrt(a.x), a.dx == 0 ? 0 : a.dx / (2 * std::sqrt(a.x))}; }
/// a^e with a constant exponent; for a.x = 0 the derivative is that of the power rule.
inline Dual pow(Dual a, double e) { return {std::pow(a.x, e), a.dx == 0 ? 0 : e * std::pow(a.x, e - 1) * a.dx}; }

}  // namespace bough::solver
