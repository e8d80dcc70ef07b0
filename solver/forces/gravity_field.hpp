#pragma once
/// \file The gravity of a system, uniform and central together: one field for loads, accelerometers, element recovery
/// and lagged stiffening.
#include "solver/forces/central_gravity.hpp"

namespace bough::solver {

struct GravityField {
  Vector3d uniform = Vector3d::Zero();         ///< in W; L/T²
  std::vector<const CentralGravity*> central;  ///< elements of the system

  /// Acceleration of a free particle at p that is attracted as this body is; in W.
  Vector3d calc_acceleration(int body, const Vector3d& p_W) const;
  /// Magnetic field of all dipoles at p; in W.
  Vector3d calc_magnetic_field(const Vector3d& p_W) const;
  /// The affine field whose loads act on a body. After calc_position.
  BodyGravity calc_on_body(const TreeData& data, int body) const;
  /// A_I = [a, α, ωx² ωy² ωz² ωxωy ωxωz ωyωz] of the motion of a body's origin minus gravity, in B. The gradient is
  /// symmetric, and the last six span every symmetric matrix: ω̃ω̃ - gradient = Ω - tr Ω 1, Ω in place of ωωᵀ.
  Eigen::Matrix<double, 12, 1> calc_inertial_acceleration(const TreeData& data, int body) const;
};

}  // namespace bough::solver
