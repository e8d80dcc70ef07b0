#pragma once
/// \file A material node of a body and its motion within the body frame B, foreshortening included
/// (docs/theory/multibody.md).
///
///     r = p + φη + ½[ηᵀ g_a η]_a                    g_a = -K_G2(force a at the node), zero without locators
///     R_BK = exp(θ̃), θ = ψη + ½[ηᵀ gθ_a η]_a       gθ_a = -K_G2(moment a), likewise
///     velocity Jt η̇, angular velocity T(θ) Jθ η̇    Jt row a = φ_a + (g_a η)ᵀ, Jθ row a = ψ_a + (gθ_a η)ᵀ
/// A body of third order: r = p + φη and θ = ψη plus polynomials to degree 4 in their place.
/// All components are in B; n = number of modes (0 for a rigid body).
#include <memory>

#include "solver/bodies/polynomial.hpp"

namespace bough::solver {

struct Node {
  int id = 0;                     ///< 0: the body origin Bo
  Vector3d p = Vector3d::Zero();  ///< undeformed place
  Matrix3Xd phi, psi;             ///< 3 x n; translations and rotations
  RowMatrixXd K2;                 ///< 3n x n, row a + 3j: row j of K_G2(force a); empty without second-order term
  RowMatrixXd K2_theta;           ///< the same for unit moments
  Polynomials higher;             ///< third order: three translations, rotation vector; empty: K2 and K2_theta
  bool moves = false;             ///< φ or ψ is not zero
  bool is_material = true;        ///< false: the origin of a free frame, which is no point of the body
  bool has_locators = false;      ///< the body file holds all three translational locators of this node
  bool has_moments = false;       ///< and all three of moments

  /// Moves, but its file has no rotation of it: a grid of solids.
  bool has_no_rotation() const;
};

/// Where a node is in B and how it moves there when the body's frame is held still.
struct NodeInBody {
  Vector3d r = Vector3d::Zero();
  Matrix3d R_BK = Matrix3d::Identity();
  Matrix3d T = Matrix3d::Identity();  ///< left tangent of R_BK
  Vector3d theta = Vector3d::Zero();
  Vector3d v = Vector3d::Zero();        ///< Jt η̇
  Vector3d w = Vector3d::Zero();        ///< T Jθ η̇
  Vector3d gamma_t = Vector3d::Zero();  ///< r̈ at η̈ = 0
  Vector3d gamma_r = Vector3d::Zero();  ///< ẇ at η̈ = 0
};

/// Position and velocity-level terms. eta, eta_dot: n. Cost 6n² with locators of forces, 12n² with those of moments
/// too. No allocation.
void calc_node_in_body(const Node& node, const ConstVectorRef& eta, const ConstVectorRef& eta_dot, NodeInBody& out);

/// r, θ and J = [Jt; Jθ] (6 x n) of a node that moves. No allocation.
void calc_node_position(const Node& node, const ConstVectorRef& eta, Vector3d& r, Vector3d& theta,
                        Eigen::Ref<Matrix6Xd> J);

/// r̈ and θ̈ at η̈ = 0. No allocation.
void calc_node_bias(const Node& node, const ConstVectorRef& eta, const ConstVectorRef& eta_dot, Vector3d& r_ddot,
                    Vector3d& theta_ddot);

/// a += Jt η̈, alpha += T Jθ η̈. No allocation.
void add_node_acceleration(const Node& node, const ConstVectorRef& eta, const ConstVectorRef& eta_ddot,
                           const Matrix3d& T, Vector3d& a, Vector3d& alpha);

/// generalized += Jtᵀ f + (T Jθ)ᵀ t for a force f and moment t in B at the node. No allocation.
void add_node_generalized_force(const Node& node, const ConstVectorRef& eta, const Matrix3d& T, const Vector3d& f,
                                const Vector3d& t, Eigen::Ref<VectorXd> generalized);

}  // namespace bough::solver
