#pragma once
/// \file Inertia of one body, rigid (n = 0) or flexible with energy-consistent stiffening (docs/theory/multibody.md).
///
/// In B about Bo, in the order [v; ω; η̇], T = ½ [v;ω;η̇]ᵀ M(η) [v;ω;η̇] with
///
///            | m1       -S̃       ∂S/∂η |     S, J: first and second moment of r = Σ_b A_b f_b + φη (AffineField)
///     M(η) = | S̃         J       C     |     C_j = ∫ρ r×∂r/∂η_j
///            | (∂S/∂η)ᵀ  Cᵀ      M_ηη  |     M_ηη = ∫ρ ∂r/∂ηᵀ ∂r/∂η
///
/// where r holds the second-order displacement, an affine field, so that T is a sum of squares; it is left out when
/// stiffening is off. Products of two φ are Γ2, Γ4 and M. d'Alembert with a the inertial acceleration of Bo (in B),
///
///     M(η) [a; α; η̈] + h(η, η̇, ω) = applied
#include <string>
#include <vector>

#include "formats/records/system_spec.hpp"
#include "solver/bodies/affine_field.hpp"
#include "solver/bodies/node.hpp"

namespace bough::solver {

/// M(η), h and scratch for one body; every array is sized once.
struct BodyInertia {
  MatrixXd M;                           ///< (6+n)², flexible bodies only (a rigid one has Body::M6)
  VectorXd h;                           ///< 6+n
  Vector3d S = Vector3d::Zero();        ///< first moment of mass about Bo
  VectorXd by_eta, A2, pairs, by_pair;  ///< (9+r)n, 3n, n(n+1)/2, 3+r; r = rank of the affine field
  AffineField::Columns V;               ///< 12 x n: ∫ρ ∂r/∂η_j fᵀ
  AffineField::Amplitudes a = AffineField::Amplitudes::Zero(), A = a, P = a;  ///< of the field; P = ∫ρ r fᵀ
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
  Vector3d first_moment() const { return S0_; }  ///< of the undeformed body about Bo
  bool stiffened() const { return stiffened_; }
  const Matrix6d& M6() const { return M6_; }  ///< the mass matrix of the undeformed body
  const MatrixXd& K() const { return K_; }
  const MatrixXd& D() const { return D_; }
  const AffineField& field() const { return field_; }

  const std::vector<Node>& nodes() const { return nodes_; }  ///< [0] is Bo
  int find_node(int id) const;                               ///< index into nodes(), -1 when absent
  void add_rigid_node(int id, const Vector3d& p);

  BodyInertia make_inertia() const;
  /// M(η) and S; eta: n. O(n²), no allocation.
  void calc_mass(const ConstVectorRef& eta, BodyInertia& inertia) const;
  /// h(η, η̇, ω), after calc_mass. O(n²), no allocation.
  void calc_bias(const Vector3d& w_B, const ConstVectorRef& eta, const ConstVectorRef& eta_dot,
                 BodyInertia& inertia) const;
  /// h (6) of a rigid body.
  void calc_rigid_bias(const Vector3d& w_B, double* h) const;
  void calc_inertia(const Vector3d& w_B, const ConstVectorRef& eta, const ConstVectorRef& eta_dot,
                    BodyInertia& inertia) const {
    calc_mass(eta, inertia);
    calc_bias(w_B, eta, eta_dot, inertia);
  }

 private:
  void add_second_order(const records::FlexBody& flex);
  template <int R>
  void calc_flexible_mass(const ConstVectorRef& eta, BodyInertia& inertia) const;
  template <int R>
  void calc_flexible_bias(const Vector3d& w_B, const ConstVectorRef& eta, const ConstVectorRef& eta_dot,
                          BodyInertia& inertia) const;
  void add_flexible_nodes(const records::FlexBody& flex);

  int n_ = 0;
  bool stiffened_ = false;
  double mass_ = 0;
  Vector3d S0_ = Vector3d::Zero();
  Vector6d J0_ = Vector6d::Zero();  ///< xx yy zz xy xz yz (tensor components) about Bo
  Matrix6d M6_ = Matrix6d::Zero();
  AffineField field_;
  MatrixXd M_rest_;   ///< n x n: M - LᵀL
  MatrixXd by_eta_;   ///< (9+r)n x n: per mode j, column k: Γ4 as components of J, Γ2_kj, (c_q)_jk
  MatrixXd A2_;       ///< 3n x n: per mode j, column k: Γ2_kj - Γ2_jk
  MatrixXd by_pair_;  ///< (3+r) x n(n+1)/2: Ċη̇ of Γ2, η̇ᵀc_qη̇ per product η̇_j η̇_k, k ≤ j
  // What the affine functions do not hold of Γ1, J0 and J's linear part: functions without mass, rounding.
  Matrix3Xd gamma1_rest_;
  Vector6d J0_rest_ = Vector6d::Zero();
  Matrix6Xd J1_rest_;
  MatrixXd M_, K_, D_;
  bool K_is_diagonal_ = false, D_is_diagonal_ = false;
  std::vector<Node> nodes_;
};

}  // namespace bough::solver
