#pragma once
/// \file Every array that the passes over a tree write, cut by stage, and the passes themselves.
///
///     position      calc_position(t, q)     markers, R_PB, r, X, H, Jc, M(η)
///     velocity      calc_velocity(u)        V, b, h; clears what is applied
///     forces        (solver/forces)         applied, hinge_force
///     factor        calc_factor             𝒫, D = LLᵀ, G: position only
///     acceleration  solve                   β, z, A', u̇, transmitted
/// A stage demands those it reads and undoes those that read it. No pass allocates.
#include "solver/state/law_tangents.hpp"
#include "solver/state/motion.hpp"
#include "solver/tree/tree.hpp"

namespace bough::solver {

enum class Stage : unsigned { Position = 1, Velocity = 2, Forces = 4, Factor = 8, Acceleration = 16 };

/// Data of one body; nh = its free hinge coordinates, n = modes, m = modes of the parent.
struct BodyData {
  // Free hinge columns
  int num_free = 0;
  int free[6] = {0, 1, 2, 3, 4, 5};
  // Position
  HingeMotion hinge;
  Matrix3d R_PB = Matrix3d::Identity();
  Vector3d r_PoBo = Vector3d::Zero();  ///< in P
  Matrix6d H = Matrix6d::Zero();       ///< free columns; at Bo, in B
  Matrix6Xd X;                         ///< 6 x (6+m); only where the parent's end deforms
  Matrix6Xd Jc;                        ///< 6 x n; only where the child's end deforms
  BodyInertia inertia;                 ///< of a rigid body: mass, S and M6
  BodyState state;                     ///< its parts by stage
  // Factor
  Matrix6d P6 = Matrix6d::Zero();  ///< articulated inertia 𝒫, its 6 x 6
  Matrix6d G6 = Matrix6d::Zero();  ///< rigid: D⁻¹ Wᵀ, nh x 6
  Matrix6d D6 = Matrix6d::Zero();  ///< rigid: 1/D (nh = 1) or its factor L
  Matrix6Xd P_top;                 ///< 6 x n: if children are attached to modes, the rest of 𝒫 (else in BodyInertia)
  MatrixXd P_modal;                ///< n x n: its lower triangle
  MatrixXd D;    ///< flexible: L of ℋᵀ𝒫ℋ (its lower triangle), Gᵀ = (L⁻¹W_topᵀ)ᵀ below it, padding
  Matrix6Xd PX;  ///< 6 x (6+m), scratch
  // Bounds of the terms of a pivot
  double mass_carried = 0;   ///< of the body and its descendants
  double second_moment = 0;  ///< bound of ∫ρ|p|² of them about Bo
  VectorXd modal_size;       ///< n: of the modal rows
};

/// One use of the factored tree: loads in, accelerations (or jumps of the velocity) out.
struct Sweep {
  VectorXd beta;   ///< num_v: h - applied, tip to base; then β + 𝒫b
  Matrix6Xd b;     ///< 6 x bodies
  VectorXd tau;    ///< num_u: hinge rows
  VectorXd z;      ///< num_u: free hinge rows first, then modal rows, per body
  Matrix6Xd A;     ///< 6 x bodies
  VectorXd u_dot;  ///< num_u: given where not free
  Vector6d ground = Vector6d::Zero();
};

/// Propellant of one tank at one time.
struct TankData {
  double mass = 0;      ///< set before calc_position
  TankContent content;  ///< position
  double flow = 0;      ///< M/T, forces: mass that leaves it
};

struct TreeData {
  unsigned done = 0;  ///< Stage bits
  std::vector<HingeMode> mode;
  double t = 0;
  FunctionCopies functions;      ///< each function of time is evaluated by its copy here
  VectorXd q, u;                 ///< rows of prescribed coordinates hold their functions' values, of locked ones zero
  VectorXd given_u, given_udot;  ///< num_u: rates and accelerations of the prescribed ones
  std::vector<MarkerMotion> markers;
  std::vector<TankData> tanks;
  Vector6d momentum_out =
      Vector6d::Zero();  ///< rate of the momentum that leaves with propellant, about W's origin, in W
  VectorXd h, applied;   ///< num_v: [f; t about Bo; modal] per body, in B, gravity left out
  VectorXd slide;        ///< num_u: which way a coordinate with dry friction slides, 1 or -1; 0: it has none, or rests
  VectorXd hinge_force;  ///< num_u: load along the coordinate: springs, dampers, elements and actuators of the hinge
  VectorXd load_friction;   ///< num_u: part of hinge_force, friction by bearing load
  VectorXd friction_limit;  ///< num_u: static friction by bearing load, of the last accelerations
  VectorXd transmitted;  ///< num_u: after solve, where not free: hinge wrench along the coordinate, motor inertia added
  Vector3d gravity = Vector3d::Zero();  ///< set by add_forces
  VectorXd
      added;  ///< num_u: on the diagonal of ℋᵀ𝒫ℋ along hinge coordinates: inertia of motors, and of an implicit step
  double added_K = 0, added_D = 0;  ///< of an implicit step: M_ηη + added_D D + added_K K in ℋᵀ𝒫ℋ
  LawTangents* tangents = nullptr;  ///< while a linear model is made
  Sweep motion, response;
  BodyData ground;
  std::vector<BodyData> bodies;

  /// Generalized hinge force as reported: the load of a free coordinate, else the transmitted force.
  double get_hinge_force(int row) const {
    return mode[static_cast<size_t>(row)] == HingeMode::Free ? hinge_force[row] : transmitted[row];
  }
  /// Force that keeps a locked or prescribed coordinate to its motion, in addition to its load. After solve, and after
  /// close_loops where constraints are closed.
  double calc_constraint_force(int row) const { return transmitted[row] - hinge_force[row]; }

  /// Returns true if the arrays of a stage are valid.
  bool has(Stage s) const { return (done & static_cast<unsigned>(s)) != 0; }
  /// Assertion that the arrays of a stage are valid.
  void demand(Stage s) const { BOUGH_DEMAND(has(s)); }
  /// Data of a body; -1: of the ground.
  const BodyData& operator[](int b) const { return b < 0 ? ground : bodies[static_cast<size_t>(b)]; }
  BodyData& operator[](int b) { return b < 0 ? ground : bodies[static_cast<size_t>(b)]; }
};

/// 6 x n of 𝒫 of a flexible body.
inline const Matrix6Xd& get_P_top(const TreeBody& tb, const BodyData& d) {
  return tb.carries_on_modes ? d.P_top : d.inertia.M_top;
}

/// Arrays for all passes over the tree. Allocates.
TreeData make_tree_data(const Tree& tree);
/// Sets the mode of each coordinate; mode: num_u. Resizes the arrays of flexible bodies: allocates.
void set_modes(const Tree& tree, const std::vector<HingeMode>& mode, TreeData& data);
/// Leaves in TreeData::added the inertia of motors alone, and no K and D.
void clear_added(const Tree& tree, TreeData& data);

/// Position stage at the state q (num_q) and the time t of prescribed motions.
void calc_position(const Tree& tree, double t, const ConstVectorRef& q, TreeData& data);
/// Velocity stage at the rates u (num_u); rows of coordinates that are not free are overwritten by the given rates.
/// After calc_position.
void calc_velocity(const Tree& tree, const ConstVectorRef& u, TreeData& data);
/// Both in one walk over the bodies.
void calc_kinematics(const Tree& tree, double t, const ConstVectorRef& q, const ConstVectorRef& u, TreeData& data);

/// Throws ComputationError "solver.indefinite-mass" naming time, body and coordinate where a pivot of D is less than
/// kMinPivotShare times the bound of its terms.
void calc_factor(const Tree& tree, TreeData& data);
inline constexpr double kMinPivotShare = 1e-12;

/// u̇ (num_u) of what is applied.
void solve(const Tree& tree, TreeData& data, Eigen::Ref<VectorXd> u_dot);
/// calc_factor and solve in one walk over the bodies.
void factor_and_solve(const Tree& tree, TreeData& data, Eigen::Ref<VectorXd> u_dot);

/// M⁻¹ Jᵀ [f; t] of a wrench at a marker, in the basis of its body: what it adds to u̇, or, as an impulse, to u. After
/// calc_factor. `bodies` (ascending, closed towards the base) are those whose rows are wanted; empty: all. Base to tip
/// it visits them only, tip to base the marker's body and its ancestors.
void solve_response(const Tree& tree, TreeData& data, int marker, const Vector6d& wrench,
                    const std::vector<int>& bodies, Eigen::Ref<VectorXd> du);
/// The jump of u (num_u) where the rates of coordinates that are not free jump by `given` (num_u; free and modal rows
/// are not read) and nothing else acts: momenta along free coordinates hold. After calc_factor.
void solve_jump(const Tree& tree, TreeData& data, const ConstVectorRef& given, Eigen::Ref<VectorXd> du);

// Response to several loads that act together: start, add the loads, run; the result is in the sweep (u_dot, A).
/// Starts a response of all bodies, zero. After calc_factor.
Sweep& start_response(TreeData& data);
/// Starts a response of these bodies only; the rows of other bodies must not be read.
Sweep& start_response(const Tree& tree, TreeData& data, const std::vector<int>& bodies);
/// wrench: at the marker, in the basis of its body.
void add_response_wrench(const Tree& tree, const TreeData& data, int marker, const Vector6d& wrench, Sweep& s);
/// given: as solve_jump.
void add_response_jump(const Tree& tree, const TreeData& data, const ConstVectorRef& given, Sweep& s);
/// Solves tip to base, then base to tip, all bodies.
void run_response(const Tree& tree, const TreeData& data, Sweep& s);
/// Base to tip: the velocities (A) of all bodies at rates u (num_u), without those of prescribed rates; or small
/// rotations and displacements. No load, no mass. After Stage::Position.
void run_rates(const Tree& tree, const TreeData& data, const ConstVectorRef& u, Sweep& s);

/// Forces minus inertia along the free rows of u, zero in the others.
struct Imbalance {
  VectorXd force;  ///< num_u: f - h - M u̇
  VectorXd terms;  ///< num_u: sum of the absolute values of its terms, whose roundoff is that of `force`
};
/// Imbalance at accelerations u̇ (num_u; rows that are not free have the given ones), without loads of closed loops and
/// without a factorization. O(bodies n²). After forces were added. Allocates.
Imbalance calc_imbalance(const Tree& tree, const TreeData& data, const ConstVectorRef& u_dot);

/// The impulse across the hinge of body b along its coordinate i, of the last solve_jump or run_response.
double calc_jump_impulse(const Tree& tree, const TreeData& data, int b, int i);

/// The wrench that the parent puts on body b across its hinge, about Bo, in B. After solve.
Vector6d calc_hinge_wrench(const Tree& tree, const TreeData& data, int b);
/// Hinge wrench at the origin of Hc, in the axes of Hp.
HingeReaction calc_hinge_reaction(const Tree& tree, const TreeData& data, int b);

/// The second route to u̇: Jacobians of every body, M = Σ Jᵀ M(η) J, no elimination.
void calc_dense_accelerations(const Tree& tree, const TreeData& data, Eigen::Ref<VectorXd> u_dot);
/// The dense mass matrix over all rows of u and the right-hand side it meets where all rows are free.
void calc_dense_equations(const Tree& tree, const TreeData& data, MatrixXd& mass, VectorXd& force);

// One body at a time, for the walks.
/// Pose, hinge columns and mass matrix of body b; after its parent.
void calc_body_position(const Tree& tree, int b, TreeData& data);
/// Velocity, bias and d'Alembert forces of body b; after its parent.
void calc_body_velocity(const Tree& tree, int b, TreeData& data);
/// Articulated inertia of body b, added to that of its parent; after its children.
void factor_body(const Tree& tree, int b, TreeData& data);
/// Articulated bias force of body b, passed on to its parent; after its children.
void solve_to_base(const Tree& tree, int b, const TreeData& data, Sweep& s);
/// Accelerations of body b and its rows of u̇; after its parent.
void solve_to_tip(const Tree& tree, int b, const TreeData& data, Sweep& s);

}  // namespace bough::solver
