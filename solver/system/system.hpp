#pragma once
/// \file A multibody tree ready for numerics: const System, separate SystemData (every result and scratch array).
///
/// Generalized positions q (num_q): per body in tree order, hinge coordinates (an orientation as quaternion x,y,z,w for
/// spherical and free) then η. Generalized speeds u (num_u): hinge rates (spherical, free: angular velocity of Hc in
/// Hp, components in Hc) then η̇. Locked and prescribed coordinates keep their rows (solver/state): what a caller puts
/// there is not read, u̇ and q̇ hold what is prescribed.
/// Frames: W inertial; B body, origin Bo; Hp, Hc hinge frames on parent and child. Linear before angular everywhere.
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "base/rotation.hpp"
#include "formats/records/system_spec.hpp"
#include "solver/forces/applied.hpp"
#include "solver/forces/element.hpp"
#include "solver/forces/gravity_field.hpp"
#include "solver/forces/joint_contact.hpp"
#include "solver/loops/loops.hpp"
#include "solver/motion/recovery.hpp"
#include "solver/signals/graph.hpp"
#include "solver/state/motion.hpp"
#include "solver/state/state.hpp"
#include "solver/system/load_friction.hpp"
#include "solver/tree/data.hpp"

namespace bough::solver {

using records::FlexBody;

struct SystemData;
class StiffeningTerms;

/// Everything that never changes in a run. Const after build_system and shared by threads; it may be moved while
/// nothing refers to it.
struct System {
  Tree tree;
  std::vector<std::unique_ptr<const TimeFunction>> functions;
  std::vector<AppliedForce> forces;
  std::vector<AppliedForce> driven;  ///< whose value is a signal: see signals
  Loops loops;
  VectorXd initial_q, initial_u;                     ///< with closed loops; empty: as the records say
  std::vector<ConstraintState> initial_constraints;  ///< likewise
  std::vector<std::unique_ptr<const ForceElement>> elements;
  std::vector<JointContact> joint_contacts;
  std::vector<LoadFriction> load_frictions;
  SignalGraph signals;
  bool signals_are_valid = true;  ///< sensors, controllers and actuators have no errors
  GravityField gravity;
  std::vector<double> jump_times;  ///< times at which a function that drives a hinge or a force jumps, ascending
  std::vector<double> mesh_times;  ///< times that no step may pass over, ascending (TimeFunction::mesh_times)
  double start = 0;
  bool is_lagged = false;                             ///< bodies are stiffened by blocks of signals, not by themselves
  std::vector<bool> body_is_valid;                    ///< by body: its record and its hinge have no errors
  std::vector<std::unique_ptr<Recovery>> recoveries;  ///< by body; nullptr: nothing is recovered of it
  /// Terms, by body, that would stiffen a body whose stiffening is off. nullptr: it is on, or the file has none.
  std::vector<std::shared_ptr<const StiffeningTerms>> left_out;

  /// Systems that differ from this one in the fill levels of flexible bodies alone: rows of states, signals and
  /// channels are equal. Empty: no body has levels. That of this system is null.
  std::vector<std::shared_ptr<const System>> variants;
  std::vector<int> num_levels;  ///< by body; 1: it has none. Empty: no body has levels; in variants too
  int variant = 0;              ///< own index among the variants

  /// Level of a body in a variant, from 0.
  int get_level(int variant, int body) const;
  /// Variant that differs from another one by the level of one body.
  int find_variant(int variant, int body, int level) const;
  /// A variant of the system of the start.
  const System& get_variant(int k) const { return k == variant ? *this : *variants[static_cast<size_t>(k)]; }

  /// Number of bodies, ground not counted.
  int num_bodies() const;
  /// Number of coordinates: hinge coordinates with quaternions, then modal coordinates, body by body.
  int num_q() const;
  /// Number of rates: hinge rates, then modal rates, body by body; prescribed and locked rows included.
  int num_u() const;
  /// Continuous states of controllers, actuators and sensors, then num_momentum_out().
  int num_z() const;
  /// 6 with tanks or fill levels, else 0: momentum that has left with propellant (linear, then angular about the
  /// inertial origin, W).
  int num_momentum_out() const;
  int find_body(const std::string& name) const;   ///< -1 when absent
  int find_hinge(const std::string& name) const;  ///< hinge h is the inboard hinge of body h
  /// Name of a body as in the system file.
  const std::string& body_name(int body) const;
  /// Name of the inboard hinge of a body.
  const std::string& hinge_name(int body) const;
  bool is_valid(int body) const;  ///< false only after draft_system: neither its nodes nor its hinge are known
  /// Number of modes of a body; 0 if it is rigid.
  int num_modes(int body) const;
  int q_offset(int body) const;  ///< hinge coordinates start here; η follows
  /// Row of u at which the hinge rates of a body start.
  int u_offset(int body) const;
  /// Rows of the hinge in q, quaternions with four.
  int num_hinge_q(int body) const;
  int num_hinge_u(int body) const;      ///< hinge coordinates that are free at the start
  int num_hinge_rates(int body) const;  ///< rows of the hinge in u; rates and forces of get_hinge
  int num_dofs() const;                 ///< rows of u that are free at the start
  int eta_offset(int body) const;       ///< in q
  int eta_dot_offset(int body) const;   ///< in u
  /// Number of constraints that close loops, open ones too.
  int num_constraints() const;
  int find_constraint(const std::string& name) const;  ///< -1 when absent
  /// Name of a constraint as in the system file.
  const std::string& constraint_name(int constraint) const;
  /// Returns true for a constraint between hinge coordinates.
  bool is_coupler(int constraint) const;
  /// Index of node `id` for calc_node_motion (0: Bo), -1 when the body has none such.
  int find_node(int body, int id) const;
  /// Returns true if the node has the second-order (foreshortening) term.
  bool has_node_second_order(int body, int node_index) const;

  /// Results and scratch for one thread, with the discrete state of the records. Allocates.
  std::unique_ptr<SystemData> make_data() const;
  /// Initial state as the records say; q (num_q), u (num_u).
  void calc_initial_state(Eigen::Ref<VectorXd> q, Eigen::Ref<VectorXd> u) const;
  /// The initial state as calc_initial_state() gives it, with the states z of the start.
  State make_initial_state() const;
  /// Numbers of rows of q, u and z.
  StateLayout layout() const { return {num_q(), num_u(), num_z()}; }
};

/// Results and scratch of one thread: of the last state that was evaluated.
struct SystemData {
  TreeData tree;
  LoopData loops;
  std::vector<ForceResult> elements;  ///< of add_forces; zero before it
  SignalData signals;
  LoadFrictionData friction;
  VectorXd tangent;                          ///< num_u, scratch
  Vector6d momentum_out = Vector6d::Zero();  ///< of the last set_z
};

/// The discrete state from now on (SystemData starts with that of the records): what get_discrete returns. Memory that
/// is left empty stays. Not within a step: allocates.
void set_modes(const System& system, SystemData& data, const DiscreteState& discrete);
/// Modes of hinges and constraints, and the memory of blocks.
DiscreteState get_discrete(const SystemData& data);
/// Returns true if coordinates and constraints have the modes of `discrete`. No allocation.
bool has_modes(const SystemData& data, const DiscreteState& discrete);

/// Applies a jump of prescribed rates at t: from the rates before (functions at `before`, the modes so far) to those
/// at t (under `modes`; unchanged modes for nullptr). Rates of free coordinates jump by the impulse; their
/// momenta are conserved. `work` grows by the work of the impulse. u: in and out. Describes each jump in `events`;
/// false when there is none. Positions do not jump. Allocates.
bool cross_jump(const System& system, SystemData& data, double before, double t, const DiscreteState* modes,
                const Eigen::Ref<const VectorXd>& q, Eigen::Ref<VectorXd> u, double& work,
                std::vector<std::string>& events);

/// q̇ = N(q) u (prescribed coordinates: their given rates). O(num_bodies).
void calc_q_dot(const System& system, SystemData& data, double t, const Eigen::Ref<const VectorXd>& q,
                const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> q_dot);
/// q̇ at the state of the last calc_kinematics.
void get_q_dot(const System& system, const SystemData& data, Eigen::Ref<VectorXd> q_dot);
/// Positions and velocities of every body; clears the applied forces. Must precede the calls below. O(num_bodies).
void calc_kinematics(const System& system, SystemData& data, double t, const Eigen::Ref<const VectorXd>& q,
                     const Eigen::Ref<const VectorXd>& u);
/// States of controllers, actuators and sensors from now on; those of the start in a new SystemData. Before
/// calc_kinematics if the system has tanks.
/// \param z  num_z, or without the last num_momentum_out.
void set_z(SystemData& data, const Eigen::Ref<const VectorXd>& z);
/// ż. After calc_accelerations.
void calc_z_dot(const System& system, SystemData& data, Eigen::Ref<VectorXd> z_dot);
/// Every signal, those that only the results want too. After calc_accelerations.
void calc_signals(const System& system, SystemData& data);

/// Computes the signals that the motion needs and adds what actuators do, every [[force]] of the spec at time t, what
/// acts along hinge coordinates, gravity. After calc_kinematics.
void add_forces(const System& system, SystemData& data, double t);
/// Adds a force and moment (components in W) at a node, through its Jacobian φ - K_G2 η. After calc_kinematics.
void add_node_wrench(const System& system, SystemData& data, int body, int node_index, const Vector3d& f_W,
                     const Vector3d& t_W);
/// q and u brought onto the closed constraints at t, in the metric of the mass matrix. No allocation.
void project(const System& system, SystemData& data, double t, Eigen::Ref<VectorXd> q, Eigen::Ref<VectorXd> u);
/// Projects small differences of q and u as project() does, to first order. After project. No allocation.
void remove_normal(const System& system, SystemData& data, Eigen::Ref<VectorXd> dq, Eigen::Ref<VectorXd> du);
/// u̇ by the order-n recursion with what was added, loops closed; body accelerations and hinge forces become available.
/// Order n. No allocation. Throws ComputationError when the articulated inertia of a body is not positive definite.
void calc_accelerations(const System& system, SystemData& data, double t, Eigen::Ref<VectorXd> u_dot);
/// Accelerations by assembling the dense M(q) and solving: the second route for tests. O(num_u³).
void calc_accelerations_dense(const System& system, SystemData& data, double t, Eigen::Ref<VectorXd> u_dot);

/// Motion as blocks and recoveries use it.
inline Motion get_motion(const System& system, const SystemData& data) {
  return {system.tree, data.tree, system.loops, data.loops, system.gravity};
}

/// Motion of a body at the last state that was evaluated.
const BodyState& get_body_state(const SystemData& data, int body);
/// Motion of a node of a body at the last state that was evaluated.
inline NodeMotion calc_node_motion(const System& system, const SystemData& data, int body, int node_index) {
  return calc_node_motion(get_motion(system, data), body, node_index);
}
inline ConstraintReaction get_constraint_reaction(const System& system, const SystemData& data, int constraint) {
  return get_constraint_reaction(get_motion(system, data), constraint);
}
/// The wrench across the inboard hinge of a body, of every type. After calc_accelerations.
HingeReaction get_hinge_reaction(const System& system, const SystemData& data, int body);

/// Kinetic, strain and potential energy, those of hinge springs, force elements, motors and rotors too. After
/// calc_velocity.
Energies calc_energies(const System& system, const SystemData& data);
/// Strain energy of the modes of one body.
double calc_strain_energy(const System& system, const SystemData& data, int body);
struct Power {
  double total = 0;       ///< of applied forces, dampers and prescribed motions: d/dt(kinetic + strain + potential)
  double dissipated = 0;  ///< what dampers take, counted in total with its minus
};
/// After calc_accelerations.
Power calc_powers(const System& system, const SystemData& data);
/// Total power of calc_powers().
inline double calc_power(const System& system, const SystemData& data) { return calc_powers(system, data).total; }
/// Linear momentum and angular momentum about the inertial origin, in W.
void calc_momentum(const System& system, const SystemData& data, Vector3d& linear, Vector3d& angular);
/// Momentum of one body.
void calc_body_momentum(const System& system, const SystemData& data, int body, Vector3d& linear, Vector3d& angular);
/// Mass, centre of mass and inertia of the deformed bodies. After calc_kinematics.
SystemMass calc_system_mass(const System& system, const SystemData& data);

}  // namespace bough::solver
