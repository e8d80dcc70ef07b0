#pragma once
/// \file The motion of one marker as seen from another, and the wrenches that go with it.
#include "solver/tree/data.hpp"

namespace bough::solver {

/// Relative motion of Hc, fixed in the child's marker at [R, p] of a ConstraintState, in Hp, the parent's marker.
struct RelativeMotion {
  Matrix3d R = Matrix3d::Identity();  ///< R_HpHc
  Vector3d p = Vector3d::Zero();      ///< p_HpHc, in Hp
  Vector6d V = Vector6d::Zero();      ///< [v; w], in Hp
  Vector6d bias = Vector6d::Zero();   ///< [a; α] where all accelerations of bodies and modes are zero
  Matrix3d R_WHp = Matrix3d::Identity();
  Vector3d d_W = Vector3d::Zero();  ///< from Hp to Hc, in W
  Vector3d o_W = Vector3d::Zero();  ///< from the child's marker to Hc, in W
};

/// After Stage::Position.
void calc_relative_position(const Tree& tree, const TreeData& data, int parent_marker, int child_marker,
                            const ConstraintState& state, RelativeMotion& out);
/// After Stage::Velocity and calc_relative_position.
void calc_relative_velocity(const Tree& tree, const TreeData& data, int parent_marker, int child_marker,
                            RelativeMotion& out);
/// [a; α], in Hp, of the accelerations (or jumps) in a sweep, without the bias.
Vector6d calc_relative_response(const Tree& tree, const TreeData& data, int parent_marker, int child_marker,
                                const RelativeMotion& motion, const Sweep& sweep);

/// A wrench at Hc, components in Hp, on the child, and its reaction on the parent: each at its marker, in the basis of
/// its body.
struct MarkerWrenches {
  Vector6d on_parent, on_child;
};
/// Transfers a wrench from Hc to both markers; moments are about the marker's own origin.
MarkerWrenches calc_marker_wrenches(const Tree& tree, const TreeData& data, int parent_marker, int child_marker,
                                    const RelativeMotion& motion, const Vector6d& wrench);

}  // namespace bough::solver
