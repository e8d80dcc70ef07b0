#pragma once
/// \file Distance beyond a rigid stop that still counts as at the stop.
#include <cmath>

namespace bough::solver {

/// Margin for numbers rounded in files, and for errors of assembled loops and of located impacts.
inline double calc_slack(double stop) { return 1e-9 + 1e-6 * std::abs(stop); }

}  // namespace bough::solver
