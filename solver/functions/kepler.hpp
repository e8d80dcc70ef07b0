#pragma once
/// \file Place on a Kepler ellipse as functions of time, for the LVLH frame of a reference orbit.
#include "solver/functions/function_parameters.hpp"

namespace bough::solver {

/// kepler(mu, semi_major_axis, eccentricity, mean_anomaly, at, component): component 0 and 1 are the perifocal x and y,
/// 2 is the true anomaly, which grows without jumps. mean_anomaly holds at the time `at`.
std::unique_ptr<const TimeFunction> make_kepler(FunctionParameters& p);

}  // namespace bough::solver
