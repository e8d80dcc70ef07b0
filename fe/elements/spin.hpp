#pragma once
/// \file Mass of an element at points, with the motion of the points: for bodies that spin (docs/theory/rotors.md).
#include <vector>

#include <Eigen/Dense>

#include "fe/elements/element.hpp"

namespace bough::fe {

/// Axis of a rotor in basic; positive spin by the right-hand rule.
struct SpinAxis {
  Vector3d point = Vector3d::Zero();  ///< [L] a point of the axis
  Vector3d axis = Vector3d::UnitX();  ///< unit vector e
};

/// A mass of an element at one point, which moves by N u with the dofs u of the element, in basic.
struct MassSample {
  double mass = 0;                  ///< [M]
  Vector3d r = Vector3d::Zero();    ///< [L] position from the point of the axis
  Matrix3Xd N;                      ///< 3 x n
  Matrix3Xd DN;                     ///< 3 x n: derivative of N u in the direction e x r, per radian of spin
  Matrix3Xd Theta;                  ///< 3 x n: rotation of the point; empty for solids
  Vector3d arm = Vector3d::Zero();  ///< [L] part of r that turns with Theta
  Matrix3d J = Matrix3d::Zero();    ///< [M L²] inertia about the point
};
using MassSamples = std::vector<MassSample>;

}  // namespace bough::fe
