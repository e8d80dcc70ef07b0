#pragma once
/// \file Loads of the propellant that flows through a rigid body from a tank to a nozzle (docs/theory/forces.md).
///
/// Quasi-steady flow ṁ from the place r of a tank (mean S' of its content's derivative) to the exit r_e, without whirl:
///     force     -2 ω × ṁ (r_e - S')
///     moment    -ṁ (E - J') ω - ω × h about Bo,   E = r_e·r_e 1 - r_e r_eᵀ + ¼ R² (1 + e eᵀ)
/// with J' the derivative of the content's inertia, R the radius of the nozzle, normal to e, and h = S' × ṁ (r_e - S')
/// the angular momentum about Bo of the flow in straight lines. The moment is jet damping. Sources: Thomson,
/// Introduction to Space Dynamics (1961) 8.5; Meirovitch, Methods of Analytical Dynamics (1970) 12; Eke, JGCD 21
/// (1998) 2.
#include "solver/tree/data.hpp"

namespace bough::solver {

/// Place and velocity of an outflow.
struct Outflow {
  double flow = 0;                     ///< M/T
  Vector3d exit = Vector3d::Zero();    ///< from Bo, in B
  double radius = 0;                   ///< of the nozzle
  Vector3d axis = Vector3d::UnitX();   ///< unit normal of its exit, in B
  Vector3d thrust = Vector3d::Zero();  ///< force of the jet on the body at the exit, in B; zero if none is known
};

/// Adds the loads of the flow, without the thrust, to the body of the tank, and books the momentum that leaves: that of
/// the mass at its exit, minus the impulse of the thrust, and the change of the flow's momentum as the body turns.
/// After calc_velocity. No allocation.
void add_outflow(const Tree& tree, int tank, const Outflow& out, TreeData& data);
/// Adds the outflow of a tank whose mass is a function of time; does nothing for other tanks.
void add_prescribed_flow(const Tree& tree, int tank, TreeData& data);

}  // namespace bough::solver
