#pragma once
/// \file Phase of complex results.
#include <cmath>
#include <complex>
#include <numbers>

namespace bough {

/// Phase of a complex number in degrees, 0 to below 360. \param resolution  [degrees] phases that are nearer to 360 are
/// 0: half a digit of a list.
inline double calc_phase_degrees(std::complex<double> z, double resolution = 0) {
  double degrees = std::arg(z) * 180 / std::numbers::pi;
  if (degrees < 0) degrees += 360;
  return degrees >= 360 - resolution ? 0 : degrees + 0.0;
}

/// Half a digit of phases in a listing, which have seven.
inline constexpr double kListedPhase = 5e-5;

}  // namespace bough
