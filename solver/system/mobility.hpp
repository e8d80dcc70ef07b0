#pragma once
/// \file Mobility of a hinge coordinate: what an impulse along it does to its rate.
#include "solver/system/system.hpp"

namespace bough::solver {

/// Rate of a free coordinate by a unit impulse along it.
struct Mobility {
  double open = 0;    ///< [1/M or 1/(M L²)] with the loops open; positive
  double closed = 0;  ///< likewise with the loops closed; zero, to round-off, if the loops prescribe the rate
};

/// Mobility of the coordinate at `row` of u, at the kinematics of `data`.
/// \pre the coordinate is free. \note Factors the tree and the loops again. Allocates.
Mobility calc_mobility(const System& system, SystemData& data, int row);

}  // namespace bough::solver
