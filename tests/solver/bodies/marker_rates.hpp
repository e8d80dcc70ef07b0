#pragma once
/// \file Rates of a marker against differences of its motion.
#include <gtest/gtest.h>

#include "solver/bodies/marker.hpp"
#include "tests/solver/support/models.hpp"

namespace bough::solver::testing {

/// Compares the velocities and accelerations of a marker, for η(t) = η + η̇ t + η̈ t²/2 at t = 0, with central
/// differences over 2e-4, and returns its motion.
inline MarkerMotion expect_marker_rates(const Body& body, const Marker& marker, const VectorXd& eta,
                                        const VectorXd& eta_dot, const VectorXd& eta_ddot, double tolerance) {
  const auto at = [&](double t) {
    MarkerMotion m = make_marker_motion(body, marker);
    const VectorXd eta_t = eta + t * eta_dot + 0.5 * t * t * eta_ddot;
    calc_marker_position(body, marker, eta_t, m);
    calc_marker_velocity(body, marker, eta_t, eta_dot + t * eta_ddot, m);
    return m;
  };
  const double h = 1e-4;
  const MarkerMotion m = at(0), plus = at(h), minus = at(-h);
  EXPECT_LT((m.v - (plus.r - minus.r) / (2 * h)).norm(), tolerance);
  EXPECT_LT((skew(m.w) - (plus.R - minus.R) / (2 * h) * m.R.transpose()).norm(), tolerance);
  EXPECT_LT((m.J.topRows<3>() * eta_ddot + m.gamma_v - (plus.v - minus.v) / (2 * h)).norm(), tolerance);
  EXPECT_LT((m.J.bottomRows<3>() * eta_ddot + m.gamma_w - (plus.w - minus.w) / (2 * h)).norm(), tolerance);
  return m;
}

}  // namespace bough::solver::testing
