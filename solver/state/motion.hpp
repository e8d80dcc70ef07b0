#pragma once
/// \file Motions of bodies and nodes, as results.
#include "base/rotation.hpp"

namespace bough::solver {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A place in W, and from the origin of its root: the body on ground that carries it. Far from the origin of W, as in
/// orbit, p_W has lost digits that the difference of two places of one root keeps.
struct Place {
  Vector3d p_W = Vector3d::Zero();
  Vector3d p_R = Vector3d::Zero();  ///< from the origin of the root, in the axes of W; of ground: p_W
  int root = -1;                    ///< tree index; -1: ground
};
/// Vector from b to a, in W.
inline Vector3d operator-(const Place& a, const Place& b) { return a.root == b.root ? a.p_R - b.p_R : a.p_W - b.p_W; }

/// Largest number in a - b, by which its round-off is judged.
inline double calc_reach(const Place& a, const Place& b) {
  return a.root == b.root ? a.p_R.norm() + b.p_R.norm() : a.p_W.norm() + b.p_W.norm();
}

struct BodyState {  ///< of one body, after the stages position, velocity, acceleration
  Vector3d p_WBo = Vector3d::Zero();
  Vector3d p_RBo = Vector3d::Zero();  ///< from the origin of the root (Place), in W
  int root = -1;
  Matrix3d R_WB = Matrix3d::Identity();
  Vector3d v_B = Vector3d::Zero();      ///< velocity of Bo, in B
  Vector3d w_B = Vector3d::Zero();      ///< angular velocity of B, in B
  Vector3d a_B = Vector3d::Zero();      ///< inertial acceleration of Bo, in B
  Vector3d alpha_B = Vector3d::Zero();  ///< angular acceleration of B, in B

  /// Place of a point of the body, r from Bo in B.
  Place calc_place(const Vector3d& r_B) const {
    const Vector3d r_W = R_WB * r_B;
    return {p_WBo + r_W, p_RBo + r_W, root};
  }
};

struct NodeMotion {  ///< of a material node K, in the inertial frame
  Vector3d p_WK = Vector3d::Zero();
  Matrix3d R_WK = Matrix3d::Identity();
  Vector3d v_WK = Vector3d::Zero(), w_WK = Vector3d::Zero();
  Vector3d a_WK = Vector3d::Zero(), alpha_WK = Vector3d::Zero();
  Vector3d p_RK = Vector3d::Zero();  ///< from the origin of its root (Place), in W
  int root = -1;

  /// Place of K.
  Place place() const { return {p_WK, p_RK, root}; }
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
