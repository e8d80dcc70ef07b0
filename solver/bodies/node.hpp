#pragma once
/// \file A material node of a body and its motion within the body frame B, foreshortening included
/// (docs/theory/multibody.md).
///
///     r = p + φη + ½[ηᵀ g_a η]_a      g_a = -K_G2(node, a), zero without locators
///     R_BK = exp(θ̃), θ = ψη           angular velocity in B: T(θ) ψ η̇
/// All components are in B; n = number of modes (0 for a rigid body).
#include "bough/solver/bodies/spatial.hpp"

namespace bough::solver {

struct Node {
  int id = 0;                     ///< 0: the body origin Bo
  Vector3d p = Vector3d::Zero();  ///< undeformed place
  Matrix3Xd phi, psi;             ///< 3 x n; translations and rotations
  RowMatrixXd K2;                 ///< 3n x n, row a + 3j: row j of K_G2(node, a); empty without second-order term
  bool moves = false;             ///< φ or ψ is not zero
  bool has_locators = false;      ///< the body file holds all three translational locators of this node
};

/// Where a node is in B and how it moves there when the body's frame is held still.
struct NodeInBody {
  Vector3d r = Vector3d::Zero();
  Matrix3d R_BK = Matrix3d::Identity();
  Matrix3d T = Matrix3d::Identity();  ///< left tangent of R_BK
  Vector3d theta = Vector3d::Zero();
  Vector3d v = Vector3d::Zero();        ///< Jt η̇
  Vector3d w = Vector3d::Zero();        ///< T ψ η̇
  Vector3d gamma_t = Vector3d::Zero();  ///< r̈ at η̈ = 0
  Vector3d gamma_r = Vector3d::Zero();  ///< ẇ at η̈ = 0
};

/// Position and velocity-level terms. eta, eta_dot: n. Cost 6n² with locators. No allocation.
void calc_node_in_body(const Node& node, const ConstVectorRef& eta, const ConstVectorRef& eta_dot, NodeInBody& out);

/// J = [Jt; Tψ] (6 x n) with Jt row a = φ_a - (K_G2(a) η)ᵀ. No allocation.
void calc_node_jacobian(const Node& node, const ConstVectorRef& eta, const Matrix3d& T, Eigen::Ref<Matrix6Xd> J);

/// generalized += Jtᵀ f + (Tψ)ᵀ t for a force f and moment t in B at the node. No allocation.
void add_node_generalized_force(const Node& node, const ConstVectorRef& eta, const Matrix3d& T, const Vector3d& f,
                                const Vector3d& t, Eigen::Ref<VectorXd> generalized);

}  // namespace bough::solver
