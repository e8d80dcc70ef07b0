#pragma once
/// \file Downhill to a state of rest.
#include "solver/linear/equilibrium_residual.hpp"

namespace bough::solver {

/// Where follow_gradient_flow() ends.
struct GradientFlow {
  EquilibriumResidual end;
  int diverged = -1;  ///< row of the modal coordinate that left its range; -1: none
};

/// Follows q̇ = u̇(q), which for conservative loads is the descent of the potential energy in the metric of M, by
/// implicit steps (σ - ∂u̇) Δ = u̇ (pseudo-transient continuation; Kelley & Keyes, SIAM J. Numer. Anal. 35 (1998) 508),
/// σ above the largest growth of ∂u̇ so that each step falls. Ends near a state that is stable, where it gets no
/// further, or where a modal coordinate leaves the range of its body: the energy of a body of third order has no bottom
/// there.
GradientFlow follow_gradient_flow(EquilibriumResidual from);

/// Returns true if no eigenvalue of ∂u̇ (m x m of the dofs that may be displaced) is positive: small displacements do
/// not grow. After linearize. Ignores gyroscopic forces and dampers.
bool is_stable_rest(const EquilibriumResidual& at);

}  // namespace bough::solver
