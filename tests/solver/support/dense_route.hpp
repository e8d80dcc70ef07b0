#pragma once
/// \file Second route from a state to its derivative, without the recursion: for comparison with calc_derivative.
///
/// Positions of all bodies are products of matrices with first and second derivatives with respect to time (a truncated
/// Taylor series along the motion). They give, by unit speeds, the Jacobian J_b of each body, and, at u̇ = 0, the rest
/// of its acceleration. With p_b = M_b V_b, V_b = [v; ω; η̇] in B, and the equations of Kirchhoff and Lagrange
///
///     Σ_b J_bᵀ (d/dt p_b + [ω×p_v; v×p_v + ω×p_ω; -½ ∂/∂η (V_bᵀ M_b V_b)]) = Q + Gᵀλ,   d/dt (G u) = 0
///
/// Q: -∂/∂u of the potential (8th-order differences) and the virtual power of what has none. G: rows by type of
/// constraint on the Taylor series of the relative pose. One dense KKT system in long double.
///
/// From the solver, not independent: the layout of q and u, M_b(η) of bodies with stiffening (its derivatives, so h_b,
/// are taken here; its values are tested against sums over points in tests/solver/bodies), K, D, the frame in which a
/// constraint is caught (ConstraintState), and whether a coordinate is free, locked or prescribed.
/// Sampled controllers are evaluated at the states that the history gives for their samples, and reach the others a
/// delay later. Propellant: momentum and energy of a control volume, contents of tanks by sums over discs. Tables: by a
/// separate interpolation.
/// Not covered: load patterns, rigid stops, jets, noise.
#include <map>

#include "formats/records/system_spec.hpp"
#include "solver/system/system.hpp"

namespace bough::solver::testing {

/// States at the instants of samples.
using History = std::map<double, VectorXd>;

/// Derivative of the state, and the largest over the smallest eigenvalue of the closed constraints that are kept.
struct DenseDerivative {
  VectorXd x_dot;
  double condition = 1;
};

/// ẋ of x = [q; u; z; work; dissipated]. Closings and modes are those of `discrete`.
/// Dry friction slides the way of the rate.
/// \param flex  records of the flexible bodies, by file.
DenseDerivative calc_dense_derivative(const records::SystemSpec& spec,
                                      const std::map<std::string, records::FlexBody>& flex, const System& system,
                                      const DiscreteState& discrete, double t, const VectorXd& x,
                                      const History& history = {});

}  // namespace bough::solver::testing
