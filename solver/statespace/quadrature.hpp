#pragma once
/// \file Gauss' rule over frequency on intervals that the poles of a linear model choose.
#include <vector>

#include <Eigen/Dense>

namespace bough::statespace {

/// Points of each interval, one after the other.
inline constexpr Eigen::Index kQuadraturePoints = 8;

/// ∫ g df = Σ weight_k g(frequency_k).
struct Quadrature {
  Eigen::VectorXd frequency_hz, weight;
};

/// Gauss' rule of eight points (Abramowitz & Stegun, table 25.4) on intervals between the corners, halved until each is
/// at most as long as its distance in the complex plane from every pole λ/(2πi) of the integrand.
///
/// The relative error is 1e-10 where the integrand is |G|² times a polynomial between the corners: the nearest pole is
/// outside of the ellipse of Bernstein with ρ = 4.2.
/// \param poles     [rad/T] of the transfer matrix, complex conjugates included.
/// \param corners   [1/T] ascending, with both ends of the range; at least two.
/// \param has_powers the integrand has powers of f: no interval is longer than its distance from 0.
Quadrature make_quadrature(const Eigen::VectorXcd& poles, const std::vector<double>& corners, bool has_powers = false);

}  // namespace bough::statespace
