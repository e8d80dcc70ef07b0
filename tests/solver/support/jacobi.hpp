#pragma once
/// \file Jacobi's elliptic functions, for closed forms.
#include <cmath>

namespace bough::solver::testing {

struct Jacobi {
  double sn = 0, cn = 1, dn = 1;
};

/// Elliptic functions of u at modulus k (m = k²), by descending Landen transformations (Abramowitz & Stegun 16.4).
inline Jacobi calc_jacobi(double u, double k) {
  double a[16] = {1}, c[16] = {k}, b = std::sqrt(1 - k * k);
  int n = 0;
  for (; n < 14 && std::abs(c[n]) > 1e-17; ++n) {
    a[n + 1] = 0.5 * (a[n] + b);
    c[n + 1] = 0.5 * (a[n] - b);
    b = std::sqrt(a[n] * b);
  }
  double phi = std::ldexp(a[n] * u, n);
  for (; n > 0; --n) phi = 0.5 * (phi + std::asin(c[n] / a[n] * std::sin(phi)));
  const double sn = std::sin(phi);
  return {sn, std::cos(phi), std::sqrt(1 - k * k * sn * sn)};
}

}  // namespace bough::solver::testing
