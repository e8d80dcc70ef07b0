#pragma once
/// \file The tree as the passes see it: what never changes in a run.
///
/// Body c is attached to its parent P by one hinge between frames Hp (a marker of P) and Hc (a marker of c).
/// With V = [v; ω] of Bo in B, A' = [a - g; α] (inertial acceleration minus gravity), and everything of c in c's basis,
///     V_c = X [V_P; η̇_P] + H u_h - Jc η̇_c
///     A'_c = X [A'_P; η̈_P] + H u̇_h - Jc η̈_c + b
/// X = R_PBᵀ [S(r), J_P], S(r) = [1 -r̃; 0 1], r = p_PoBo in P. Modal coordinates are extra mobilizer coordinates: Jain
/// & Rodriguez, "Recursive flexible multibody system dynamics using spatial operators", JGCD 15(6) 1992.
#include <memory>
#include <string>
#include <vector>

#include "solver/bodies/marker.hpp"
#include "solver/bodies/tank.hpp"
#include "solver/functions/function.hpp"
#include "solver/hinges/hinge.hpp"
#include "solver/state/state.hpp"

namespace bough::solver {

/// Propellant of a rigid body: its mass is what it was at the start, minus what actuators have used (rows of the states
/// of signals), or a function of time.
struct Tank {
  std::string name;
  SourceLocation at;
  int body = 0;
  std::shared_ptr<const TankShape> shape;
  double initial = 0;                      ///< mass at the start
  double reserve = 0;                      ///< mass that cannot leave: of a slosh pendulum
  std::vector<int> used_rows;              ///< states of signals whose sum is the mass used
  const TimeFunction* function = nullptr;  ///< or: its mass
  Vector3d exit = Vector3d::Zero();        ///< function: where the mass leaves, from Bo, in B
  double exit_radius = 0;                  ///< likewise: of the nozzle, a disc normal to its direction
  Vector3d exit_axis = Vector3d::UnitX();  ///< likewise: normal of the disc, in B
};

struct TreeBody {
  std::string name, hinge_name;
  SourceLocation hinge_at;
  int parent = -1;  ///< -1: ground
  Body body;
  std::unique_ptr<const Hinge> hinge;
  Marker on_parent, on_child;                  ///< Hp, Hc
  int parent_marker = 0, child_marker = 0;     ///< the same in Tree::markers
  int q_offset = 0, u_offset = 0;              ///< hinge rows, then modal rows
  int v_offset = 0;                            ///< rows of [v; ω; η̇] among those of all bodies
  bool carries_on_modes = false;               ///< a child hangs where it deforms
  std::vector<int> tanks;                      ///< in Tree::tanks
  std::vector<HingeMode> mode;                 ///< at the start, one per hinge coordinate
  std::vector<const TimeFunction*> motion;     ///< one per coordinate, nullptr: none; empty: none at all
  VectorXd stiffness, damping, null_position;  ///< empty: none
  VectorXd rotor;  ///< inertia of motors as their coordinate feels it, J n², per hinge coordinate; empty: none
  VectorXd initial_q, initial_u, initial_eta, initial_eta_dot;
  /// Hinge columns at Bo, in B, where they are constant: neither end deforms and the hinge says so. Else empty.
  Matrix6Xd constant_H;

  /// Rows of q of the inboard hinge.
  int num_hinge_q() const { return hinge->num_q(); }
  /// Rows of u of the inboard hinge.
  int num_hinge_u() const { return hinge->num_u(); }
  /// Number of modes; 0 for a rigid body.
  int num_modes() const { return body.num_modes(); }
  /// First row of η in q.
  int eta_offset() const { return q_offset + hinge->num_q(); }
  /// First row of η̇ in u.
  int eta_dot_offset() const { return u_offset + hinge->num_u(); }
  /// Returns true if the body has modes.
  bool is_flexible() const { return body.num_modes() > 0; }
  /// Hinge coordinates in this mode at the start.
  int count(HingeMode m) const {
    int n = 0;
    for (const HingeMode own : mode) n += own == m ? 1 : 0;
    return n;
  }
};

struct Tree {
  std::vector<TreeBody> bodies;  ///< parents before children
  std::vector<Tank> tanks;
  std::vector<Marker> markers;                 ///< each once; [0] is ground's origin
  std::vector<int> moving;                     ///< those that deform
  std::vector<const TimeFunction*> functions;  ///< that motions, forces and signals name
  int num_q = 0, num_u = 0, num_v = 0;

  /// Body by tree index, parents first.
  const TreeBody& operator[](int b) const { return bodies[static_cast<size_t>(b)]; }
  /// Number of bodies, without ground.
  int size() const { return static_cast<int>(bodies.size()); }
  /// Its index; a marker that is there already is taken. The marker's body is in the tree.
  int add_marker(const Marker& marker);
  /// Markers of the hinges, rows and constants, once every body is in.
  void finish();
};

}  // namespace bough::solver
