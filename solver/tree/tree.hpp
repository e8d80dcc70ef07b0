#pragma once
/// \file The tree as the passes see it: const topology (Tree) and every array they write (TreeData).
///
/// Body c hangs on its parent P by one hinge between frames Hp (on a node of P) and Hc (on a node of c). With V = [v;
/// ω] of Bo in B, A' = [a - g; α] (inertial acceleration less gravity), and everything of c in c's basis,
///     V_c = X [V_P; η̇_P] + H u_h - Jc η̇_c
///     A'_c = X [A'_P; η̈_P] + H u̇_h - Jc η̈_c + b
/// X = R_PBᵀ [S(r), J_P], S(r) = [1 -r̃; 0 1], r = p_PoBo in P. Modal coordinates are extra mobilizer coordinates: Jain
/// & Rodriguez, "Recursive flexible multibody system dynamics using spatial operators", JGCD 15(6) 1992.
#include <memory>
#include <string>
#include <vector>

#include "solver/bodies/body.hpp"
#include "solver/forces/function.hpp"
#include "solver/hinges/hinge.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {

/// Where a hinge frame H is fixed: a node K of a body, and X_KH.
struct Attachment {
  int node = 0;  ///< index into Body::nodes()
  Vector3d p_KH = Vector3d::Zero();
  Matrix3d R_KH = Matrix3d::Identity();
  bool moves = false;  ///< the node deforms
};

struct TreeBody {
  std::string name, hinge_name;
  int parent = -1;  ///< -1: ground
  Body body;
  std::unique_ptr<const Hinge> hinge;
  Attachment on_parent, on_child;
  int q_offset = 0, u_offset = 0;
  int num_hinge_u = 0;                         ///< 0 when prescribed
  std::vector<const TimeFunction*> motion;     ///< one per coordinate when prescribed, else empty
  VectorXd stiffness, damping, null_position;  ///< empty: none
  VectorXd initial_q, initial_u, initial_eta, initial_eta_dot;

  bool is_prescribed() const { return !motion.empty(); }
  int num_hinge_q() const { return hinge->num_q(); }
  int eta_offset() const { return q_offset + hinge->num_q(); }
  int eta_dot_offset() const { return u_offset + num_hinge_u; }
};

struct Tree {
  std::vector<TreeBody> bodies;  ///< parents before children
  int num_q = 0, num_u = 0;
};

/// Everything computed for one body; nh = num_hinge_u, n = num_modes, m = modes of the parent.
struct BodyData {
  BodyState state;
  Vector3d a_less_g = Vector3d::Zero();  ///< linear part of A'
  // Kinematics
  HingeMotion hinge;
  Vector6d hinge_rate = Vector6d::Zero();          ///< u_h or the prescribed rates
  Vector6d hinge_acceleration = Vector6d::Zero();  ///< prescribed ones only
  Matrix3d R_PB = Matrix3d::Identity();
  Vector3d r_PoBo = Vector3d::Zero();  ///< in P
  Matrix6d H = Matrix6d::Zero();       ///< all the hinge's columns, prescribed or not; at Bo, in B
  Vector6d b = Vector6d::Zero();
  Matrix6Xd X;   ///< 6 x (6+m); only when the parent's attachment moves
  Matrix6Xd Jc;  ///< 6 x n; only when the child's attachment moves
  BodyInertia inertia;
  // Forces
  VectorXd applied;                         ///< 6+n: [f; t about Bo; modal], in B, without gravity
  Vector6d hinge_force = Vector6d::Zero();  ///< generalized: springs and dampers, or what enforces the motion
  double spring_energy = 0;
  // Articulated-body recursion
  Matrix6d P6;        ///< rigid: articulated inertia
  MatrixXd P;         ///< flexible: (6+n)²
  VectorXd beta;      ///< 6+n
  Matrix6d G6;        ///< rigid: D⁻¹ Uᵀ, nh x 6
  VectorXd z;         ///< rigid: nh
  MatrixXd W, D;      ///< flexible: P ℋ (6+n)x(nh+n), ℋᵀPℋ (then its factor L)
  MatrixXd Gz;        ///< flexible: L⁻¹ [W_topᵀ, τ - ℋᵀ(β + Pb)], (nh+n) x 7
  VectorXd eta_ddot;  ///< n, after calc_tree_accelerations
  Matrix6Xd PX;       ///< 6 x (6+m)
};

struct TreeData {
  VectorXd q, u;  ///< as of calc_kinematics; prescribed rows hold their functions' values
  double t = 0;
  Vector3d gravity = Vector3d::Zero();  ///< set by add_forces
  BodyData ground;
  std::vector<BodyData> bodies;

  const BodyData& parent_of(const TreeBody& body) const {
    return body.parent < 0 ? ground : bodies[static_cast<size_t>(body.parent)];
  }
};

TreeData make_tree_data(const Tree& tree);

/// Positions, velocities, X, H, Jc, b, M(η), h of every body, base to tip; clears forces. No allocation.
void calc_tree_kinematics(const Tree& tree, double t, const ConstVectorRef& q, const ConstVectorRef& u, TreeData& data);
/// Order-n: tip to base (articulated inertia), base to tip (accelerations). u_dot: num_u. No allocation.
/// Throws ComputationError "solver.indefinite-mass" naming the body.
void calc_tree_accelerations(const Tree& tree, TreeData& data, Eigen::Ref<VectorXd> u_dot);
/// The same u̇ through the dense mass matrix Σ Jᵀ M(η) J of all bodies.
void calc_dense_accelerations(const Tree& tree, const TreeData& data, Eigen::Ref<VectorXd> u_dot);
/// The dense mass matrix (num_u²) and the right-hand side it meets.
void calc_dense_equations(const Tree& tree, const TreeData& data, MatrixXd& mass, VectorXd& force);

}  // namespace bough::solver
