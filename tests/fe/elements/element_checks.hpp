#pragma once
/// \file What every element owes, whatever its kind: the checks that the batteries of several kinds share.
#include "small_model.hpp"

namespace bough::fe::test {

/// Normally distributed numbers from a fixed seed.
VectorXd make_random(unsigned seed, int n);

/// K is symmetric, gives the six rigid motions no force, and has `rank` eigenvalues above `cutoff` times its largest
/// entry and none below zero.
void expect_sound_stiffness(const SmallModel& m, int rank, double cutoff = 1e-12);

/// M is symmetric and has no eigenvalue below zero. Returns Φ_RᵀMΦ_R, 6 x 6 about the origin.
MatrixXd check_mass(const SmallModel& m, MassKind kind);

/// K_G(u) is symmetric, linear in u, and gives translations no force. Its largest entry may be zero.
void expect_sound_geometric(const SmallModel& m, const VectorXd& u);

/// What K_G gives a rigid rotation θ under nodal forces f (n, six a node): θ×f, and θ×m - ½ θ×m of moments, conjugate
/// to the rotation vector (semitangential).
VectorXd turn_forces(const Vector3d& theta, const VectorXd& f);

/// V‴(a, b, c) of each element (docs/theory/third-order.md) is the sum over a, b, c of K_G of the one on the other two:
/// to 1e-9 of its norm where a, b, c do not turn the frame, to `tolerance` otherwise (a K_G that turns the nodal forces
/// only in the mean). V‴(ω, b, c) of a rotation is that of forces that turn.
void expect_third_derivative_of_geometric(const SmallModel& m, double tolerance = 1e-9);

/// Stiffness and mass are added, times a factor, to what is there; internal forces have names.
void expect_scaled_additions(const SmallModel& m);

}  // namespace bough::fe::test
