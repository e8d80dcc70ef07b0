#pragma once
/// \file Where a function of time changes its sign within a step.
#include <functional>

namespace bough::solver {

/// A time in (a, b] at which g has the sign of gb, no more than `tolerance` (or a few roundings of b) after one at
/// which it has not. ga and gb, the values at the ends, have opposite signs; ga may be zero. Illinois' form of false
/// position (Dowell & Jarratt, BIT 11 (1971) 168), by halves where that shrinks the interval too slowly.
double locate_crossing(const std::function<double(double)>& g, double a, double ga, double b, double gb,
                       double tolerance);

}  // namespace bough::solver
