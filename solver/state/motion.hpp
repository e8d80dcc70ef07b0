#pragma once
/// \file Motions of bodies and nodes, as results.
#include "base/rotation.hpp"

namespace bough::solver {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct BodyState {  ///< of one body, after the stages position, velocity, acceleration
  Vector3d p_WBo = Vector3d::Zero();
  Matrix3d R_WB = Matrix3d::Identity();
  Vector3d v_B = Vector3d::Zero();      ///< velocity of Bo, in B
  Vector3d w_B = Vector3d::Zero();      ///< angular velocity of B, in B
  Vector3d a_B = Vector3d::Zero();      ///< inertial acceleration of Bo, in B
  Vector3d alpha_B = Vector3d::Zero();  ///< angular acceleration of B, in B
};

struct NodeMotion {  ///< of a material node K, in the inertial frame
  Vector3d p_WK = Vector3d::Zero();
  Matrix3d R_WK = Matrix3d::Identity();
  Vector3d v_WK = Vector3d::Zero(), w_WK = Vector3d::Zero();
  Vector3d a_WK = Vector3d::Zero(), alpha_WK = Vector3d::Zero();
};

struct HingeReaction {  ///< what the parent puts on the child across a hinge, at Hc's origin, components in Hp
  Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
};

struct ConstraintReaction {  ///< likewise of a constraint, at the child's frame, components in the parent's
  Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
  double multiplier = 0;  ///< of a coupler: generalized force per unit of ratio
};

struct Energies {
  double kinetic = 0, strain = 0, potential = 0;  ///< strain: modal ½ηᵀKη plus hinge springs; potential: gravity
};

struct SystemMass {
  double mass = 0;
  Vector3d cg_W = Vector3d::Zero();
  Matrix3d inertia_W = Matrix3d::Zero();  ///< about cg
};

}  // namespace bough::solver
