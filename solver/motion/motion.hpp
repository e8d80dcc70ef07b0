#pragma once
/// \file The motion of a system at one time, as sensors, actuators and recoveries see it.
#include "solver/forces/gravity_field.hpp"
#include "solver/loops/loops.hpp"
#include "solver/state/motion.hpp"
#include "solver/tree/data.hpp"

namespace bough::solver {

/// Results of the last evaluation: those of position and velocity after calc_kinematics, accelerations, reactions and
/// multipliers after calc_accelerations. The references hold for one call.
struct Motion {
  const Tree& tree;
  const TreeData& data;
  const Loops& loops;
  const LoopData& loop_data;
  const GravityField& gravity;

  /// Pose and velocity of a body by its tree index; -1: ground.
  const BodyState& get_state(int body) const { return data[body].state; }
};

/// Motion of a node; accelerations are valid after calc_accelerations. For a flexible body the second-order term of
/// position, velocity and acceleration is in where the node has its three locators and stiffening is on.
NodeMotion calc_node_motion(const Motion& motion, int body, int node_index);
/// Deflection φ_k η + ½ ηᵀ g_k η and rotation ψ_k η of a node from its undeformed place, in B.
void calc_node_deflection(const Motion& motion, int body, int node_index, Vector3d& deflection_B, Vector3d& rotation_B);
/// Hinge coordinates (num_hinge_q; a quaternion as w, x, y, z) and rates (num_hinge_rates) as the user knows them,
/// prescribed ones too, and the generalized hinge force (num_hinge_rates): spring + damper after add_forces; along
/// coordinates that are locked or prescribed all that crosses the hinge, after calc_accelerations.
void get_hinge(const Motion& motion, int body, Eigen::Ref<VectorXd> q, Eigen::Ref<VectorXd> q_dot,
               Eigen::Ref<VectorXd> force);
/// Force and moment of a constraint. After calc_accelerations.
ConstraintReaction get_constraint_reaction(const Motion& motion, int constraint);

}  // namespace bough::solver
