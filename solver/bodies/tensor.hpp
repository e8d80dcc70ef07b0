#pragma once
/// \file Symmetric tensors as six components xx yy zz xy xz yz, the order of A_I(6..11).
#include "solver/bodies/spatial.hpp"

namespace bough::solver {

/// The symmetric part of J.
inline Vector6d pack_tensor(const Matrix3d& J) {
  Vector6d c;
  c << J(0, 0), J(1, 1), J(2, 2), 0.5 * (J(0, 1) + J(1, 0)), 0.5 * (J(0, 2) + J(2, 0)), 0.5 * (J(1, 2) + J(2, 1));
  return c;
}
/// The full symmetric tensor of the components xx yy zz xy xz yz.
inline Matrix3d unpack_tensor(const Vector6d& c) {
  Matrix3d J;
  J << c[0], c[3], c[4], c[3], c[1], c[5], c[4], c[5], c[2];
  return J;
}
/// Inertia of the second moment E = ∫ρ r rᵀ: tr(E) 1 - E.
inline Vector6d pack_inertia(const Matrix3d& E) {
  Vector6d c = -pack_tensor(E);
  c.head<3>().array() += E.trace();
  return c;
}

}  // namespace bough::solver
