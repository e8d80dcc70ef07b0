#pragma once
/// \file Rates of a body's momenta by differences, for Hamel's equations.
#include "tests/solver/support/models.hpp"

namespace bough::solver::testing {

/// Rates of the momenta that belong to the velocities V = [v; ω; η̇] in the body's frame, which turns with ω.
/// \param at  momenta along the motion, as a function of time about 0
/// \param h   step of the differences, of order 4
template <class Momenta>
VectorXd calc_hamel_rates(const VectorXd& V, const Momenta& at, double h) {
  VectorXd rates = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
  const VectorXd p = at(0);
  const Vector3d v = V.head<3>(), w = V.segment<3>(3);
  rates.head<3>() += w.cross(Vector3d(p.head<3>()));
  rates.segment<3>(3) += w.cross(Vector3d(p.segment<3>(3))) + v.cross(Vector3d(p.head<3>()));
  return rates;
}

}  // namespace bough::solver::testing
