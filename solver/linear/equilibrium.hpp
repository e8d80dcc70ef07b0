#pragma once
/// \file A state of rest, or of steady spin, of a System (docs/theory/linear.md).
#include "base/diagnostic.hpp"
#include "solver/linear/plant.hpp"

namespace bough::solver {

struct Equilibrium {
  OperatingPoint point;
  double residual = 0;  ///< |[u̇; ż]|
  int num_iterations = 0;
  std::vector<std::string> neutral;   ///< DOFs without effect on the equilibrium: they keep their values
  std::vector<std::string> kept;      ///< states that nothing restores: they are what they start from
  std::vector<std::string> spinning;  ///< dofs with a given rate
  struct Growth {
    std::string mode;  ///< the coordinate that takes part most
    double rate = 0;   ///< of its growth, 1/T
  };
  std::vector<Growth> unstable;  ///< poles that grow; empty: the state is stable, as far as first order tells
};

/// u̇(t, q, u, z) = 0 (of bodies that float and spin: in axes that turn with them about their centre of mass, see
/// Plant::calc_unsteadiness) and ż = 0 for q and the states z of controllers and actuators, from `start`: hinge rates
/// stay as they are there (zero: rest), modal rates become zero. Of sampled blocks too: their samples repeat
/// themselves, what is delayed has arrived. What no displacement restores (b with b · ∂ż/∂(q, z) = 0) is what every
/// motion from the start leaves it: b · (z - z₀) = (b · ∂ż/∂u) (q - q₀). Newton's method with least-norm steps, damped
/// by the natural monotonicity test (Deuflhard, Newton Methods for Nonlinear Problems, 2004, 3.3); where that ends far
/// away in an unstable state, or nowhere, downhill first (descent). Throws ComputationError "equilibrium.not-converged"
/// with the residual and where it is largest.
Equilibrium find_equilibrium(Plant& plant, const OperatingPoint& start, const SourceLocation& at);

}  // namespace bough::solver
