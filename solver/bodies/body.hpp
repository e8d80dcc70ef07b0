#pragma once
/// \file Inertia of one body, rigid (n = 0) or flexible with energy-consistent stiffening (docs/theory/multibody.md).
///
/// In B about Bo, in the order [v; ω; η̇], T = ½ [v;ω;η̇]ᵀ M(η) [v;ω;η̇] with
///
///            | m1       -S̃       Γ0(η) |     S  = m c + Γ0 η + ½ [ηᵀ G_a η]_a
///     M(η) = | S̃         J(η)    C(η)  |     Γ0(η) = ∂S/∂η
///            | Γ0(η)ᵀ    C(η)ᵀ   M     |     C row a = Γ1 row a + Σ_j η_j Γ2_j row a + (G_{3+a} η)ᵀ
///
///     J = J0 + Σ η_j (Γ3_j + Γ3_jᵀ) + ΣΣ η_j η_k Γ4_jk + J_G,   ½ ωᵀ J_G ω = -½ Σ_{i=6..11} A_I(i) ηᵀ G_i η
///
/// G_i = K_G1(i), zero when stiffening is off. Hamel's equations with a the inertial acceleration of Bo (in B),
///
///     M(η) [a; α; η̈] + h(η, η̇, ω) = applied,
///     h_f = ω×(ω×S) + 2ω×Ṡ + [η̇ᵀ G_a η̇]_a
///     h_τ = J̇ω + Ċη̇ + ω×(Jω + Cη̇)
///     h_η = Σ_k η̇_k ω·(Γ2_kj - Γ2_jk) - ½ ωᵀ(∂J/∂η_j)ω + (Kη + Dη̇)_j
#include <string>
#include <vector>

#include "bough/formats/records/system_spec.hpp"
#include "bough/solver/bodies/node.hpp"

namespace bough::solver {

/// M(η), h and scratch for one body; every array is sized once.
struct BodyInertia {
  MatrixXd M;                           ///< (6+n)², flexible bodies only (a rigid one has Body::M6)
  VectorXd h;                           ///< 6+n
  Vector3d S = Vector3d::Zero();        ///< first moment of mass about Bo
  VectorXd GS, GS_dot, C2, C2_dot, A2;  ///< 3n
  VectorXd Q;                           ///< 6n
};

class Body {
 public:
  static Body make_rigid(double mass, const Vector3d& cg, const Matrix3d& inertia_about_cg);
  /// The first `num_modes` modes of `flex` (-1: all). The file's own damping unless `damping_ratios` is not empty (one
  /// = uniform): then D_jj = 2 ζ_j √(K_jj M_jj).
  static Body make_flexible(const records::FlexBody& flex, int num_modes, bool stiffening,
                            const std::vector<double>& damping_ratios);

  int num_modes() const { return n_; }
  double mass() const { return mass_; }
  bool stiffened() const { return stiffened_; }
  const Matrix6d& M6() const { return M6_; }  ///< the mass matrix of the undeformed body
  const MatrixXd& K() const { return K_; }
  const MatrixXd& D() const { return D_; }

  const std::vector<Node>& nodes() const { return nodes_; }  ///< [0] is Bo
  int find_node(int id) const;                               ///< index into nodes(), -1 when absent
  void add_rigid_node(int id, const Vector3d& p);

  BodyInertia make_inertia() const;
  /// M(η), S and h(η, η̇, ω). eta, eta_dot: n. O(n²), no allocation.
  void calc_inertia(const Vector3d& w_B, const ConstVectorRef& eta, const ConstVectorRef& eta_dot,
                    BodyInertia& inertia) const;

 private:
  void add_second_order(const records::FlexBody& flex);
  void add_flexible_nodes(const records::FlexBody& flex);

  int n_ = 0;
  bool stiffened_ = false;
  double mass_ = 0;
  Vector3d S0_ = Vector3d::Zero();
  Vector6d J0_ = Vector6d::Zero();  ///< xx yy zz xy xz yz (tensor components) about Bo
  Matrix6d M6_ = Matrix6d::Zero();
  Matrix3Xd gamma0_, gamma1_;  ///< 3 x n
  MatrixXd GS_;                ///< 3n x n, row a + 3j: row j of G_a
  MatrixXd C2_;                ///< 3n x n, row a + 3k, column j: ∂C(a,k)/∂η_j = Γ2_j(a,k) + G_{3+a}(k,j)
  MatrixXd A2_;                ///< 3n x n, row a + 3j, column k: Γ2_k(a,j) - Γ2_j(a,k)
  Matrix6Xd J1_;               ///< 6 x n: linear part of J
  MatrixXd Q_;                 ///< 6n x n, row c + 6j: row j of the quadratic form of J's component c
  MatrixXd M_, K_, D_;
  std::vector<Node> nodes_;
};

}  // namespace bough::solver
