#pragma once
/// \file Gauss-Legendre points on [0, 1].
#include <span>

namespace bough::fe {

struct GaussPoint {
  double x, weight;
};

/// n points (1..8) on [0, 1], weights sum to 1; exact for polynomials of degree 2n-1.
std::span<const GaussPoint> get_gauss_points(int n);

}  // namespace bough::fe
