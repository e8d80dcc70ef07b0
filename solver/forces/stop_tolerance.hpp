#pragma once
/// \file How far beyond a rigid stop is still at it.
#include <cmath>

namespace bough::solver {

/// What files round, and assembled loops and located impacts leave.
inline double calc_slack(double stop) { return 1e-9 + 1e-6 * std::abs(stop); }

}  // namespace bough::solver
