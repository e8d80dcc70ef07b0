#pragma once
/// \file [[force]] of a system file at run time: a force or moment at a node, or a load pattern of a flexible body.
#include "solver/tree/data.hpp"

namespace bough::solver {

struct AppliedForce {
  std::string name;
  records::ForceKind kind = records::ForceKind::Force;
  records::VectorFrame frame = records::VectorFrame::Body;
  int body = 0, node = 0;
  int marker = 0;  ///< at the node, in Tree::markers; not of a pattern
  Vector3d direction = Vector3d::Zero();
  const TimeFunction* function = nullptr;  ///< nullptr: constant 1
  VectorXd pattern;                        ///< n, ΦᵀF_ext; empty: a node force
  MatrixXd pattern_K2;                     ///< n x n, K_G2 of the pattern (zero without stiffening)
  Potential pattern_higher;  ///< third order: work beyond that of `pattern`, in place of K_G2; empty: second order
  Vector6d pattern_resultant = Vector6d::Zero();  ///< force and moment about Bo on the undeformed body
  MatrixXd pattern_moment;                        ///< 3 x n, what η adds to the moment
};

/// Adds the wrench [f; r×f + t; Jᵀ[f; t]] of a force and moment (components in B) at a marker. No allocation.
void add_marker_wrench(const Tree& tree, int marker, const Vector3d& f_B, const Vector3d& t_B, TreeData& data);
/// Adds a wrench at a node that has no marker.
void add_wrench_in_body(const TreeBody& body, int node, const Vector3d& f_B, const Vector3d& t_B, TreeData& data);
/// Adds a force at time t: body-fixed, inertial, or turning with its node. A pattern keeps its direction in B and puts
/// [Σf; Σ p×f + t + (Σ φ×f) η; ΦᵀF - K_G2 η] times the function on the body: all to first order in η. No allocation.
void add_applied_force(const AppliedForce& force, const Tree& tree, double t, TreeData& data);
/// Adds a force with `value` in place of that of its function.
void add_applied_load(const AppliedForce& force, const Tree& tree, double value, TreeData& data);
/// Springs and dampers of every free hinge: hinge_force. No allocation.
void add_hinge_forces(const Tree& tree, TreeData& data);

}  // namespace bough::solver
