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
#include <memory>
#include <string>
#include <vector>

#include "formats/records/system_spec.hpp"
#include "solver/bodies/affine_field.hpp"
#include "solver/bodies/node.hpp"

namespace bough::solver {

struct ThirdOrderData;
class ThirdOrderBody;
class SoftEnergy;

/// M(η), h and scratch for one body; every array is sized once. But for M6, M_top and h rows are padded (kernels.hpp).
struct BodyInertia {
  double mass = 0;
  Matrix6d M6 = Matrix6d::Zero();  ///< M(η) in three parts; of a rigid body with tanks, with their content of now
  Matrix6Xd M_top;                 ///< 6 x n
  MatrixXd M_modal;                ///< lower triangle of M_ηη, and some of what is above
  VectorXd h;                      ///< 6+n
  Vector3d S = Vector3d::Zero();   ///< first moment of mass about Bo
  MatrixXd by_eta, A2;             ///< a column (n) per kind of product: of by_eta J's, then y's, then C's
  VectorXd pairs, by_pair;         ///< n(n+1)/2; one per kind of product
  MatrixXd V, C;                   ///< n x 12: ∫ρ ∂r/∂η_j fᵀ; n x 3: C_j
  VectorXd h_modal, eta;           ///< η, then η̇
  AffineField::Amplitudes a = AffineField::Amplitudes::Zero(), A = a, P = a;  ///< of the field; P = ∫ρ r fᵀ

  std::vector<ThirdOrderData> third;  ///< one for a body of third order

  MatrixXd make_M() const;  ///< (6+n)²
};

/// Scratch of ThirdOrderBody.
struct ThirdOrderData {
  BodyInertia linear;                    ///< of the n + m modes
  VectorXd xi, xi_dot, tensors;          ///< ξ = (η, p); scratch of the polynomials
  MatrixXd J, M_pp, U, product;          ///< J = ∂p/∂η; M_pp is halved
  VectorXd p_ddot, force;                ///< m, padded
  VectorXd gradient, J_small, on_small;  ///< of the strain energy
};

/// An acceleration T r of the points of a body, T symmetric, as factors of its mass integrals. In B.
struct LinearField {
  AffineField::Amplitudes V = AffineField::Amplitudes::Zero(), L = V;
  Vector6d J1 = Vector6d::Zero();
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1> J;
};

class Body {
 public:
  /// Makes a body without modes. \param mass  [M]. \param cg  centre of mass from Bo, in B. \param inertia_about_cg  [3
  /// x 3] in B.
  static Body make_rigid(double mass, const Vector3d& cg, const Matrix3d& inertia_about_cg);
  /// The first `num_modes` modes of `flex` (-1: all). The file's own damping unless `damping_ratios` is not empty (one
  /// = uniform): then D_jj = 2 ζ_j √(K_jj M_jj).
  static Body make_flexible(const records::FlexBody& flex, int num_modes, bool stiffening,
                            const std::vector<double>& damping_ratios);

  /// Number n of modes; 0 for a rigid body.
  int num_modes() const { return n_; }
  /// [M] mass.
  double mass() const { return mass_; }
  Vector3d first_moment() const { return S0_; }  ///< of the undeformed body about Bo
  /// Returns true if displacements of second order stiffen the body.
  bool stiffened() const { return stiffened_; }
  const Matrix6d& M6() const { return M6_; }  ///< the mass matrix of the undeformed body
  /// Modal stiffness [n x n].
  const MatrixXd& K() const { return K_; }
  /// Modal damping [n x n].
  const MatrixXd& D() const { return D_; }
  /// Affine field of the displacements of second order.
  const AffineField& field() const { return field_; }
  const ThirdOrderBody* third_order() const { return third_.get(); }    ///< nullptr: second order
  const SoftEnergy* soft_energy() const { return soft_energy_.get(); }  ///< nullptr: not in the body's file
  /// Strain energy [F L] of the amplitudes eta (n), of third order if the body has it.
  double calc_strain_energy(const ConstVectorRef& eta) const;

  const std::vector<Node>& nodes() const { return nodes_; }  ///< [0] is Bo
  int find_node(int id) const;                               ///< index into nodes(), -1 when absent
  /// Adds a node of a rigid body at p from Bo, in B. \pre The body has no modes, and the id is new.
  void add_rigid_node(int id, const Vector3d& p);

  /// Results and scratch arrays of this size, those that never change set. Allocates.
  BodyInertia make_inertia() const;
  /// M(η) and S; eta: n. O(n²), no allocation.
  void calc_mass(const ConstVectorRef& eta, BodyInertia& inertia) const;
  /// h(η, η̇, ω), after calc_mass. O(n²), no allocation.
  void calc_bias(const Vector3d& w_B, const ConstVectorRef& eta, const ConstVectorRef& eta_dot,
                 BodyInertia& inertia) const;
  /// After calc_mass. No allocation.
  LinearField make_linear_field(const Matrix3d& T, const BodyInertia& inertia) const;
  /// ∫ρ ∂r/∂η_j·(T r), the derivative of ½ ∫ρ r·(T r): what the acceleration T r of its points does on mode j.
  double calc_modal_force(const LinearField& field, const BodyInertia& inertia, int j) const;
  /// Computes M(η), S and h(η, η̇, ω). No allocation.
  void calc_inertia(const Vector3d& w_B, const ConstVectorRef& eta, const ConstVectorRef& eta_dot,
                    BodyInertia& inertia) const {
    calc_mass(eta, inertia);
    calc_bias(w_B, eta, eta_dot, inertia);
  }

 private:
  void add_second_order(const records::FlexBody& flex);
  void calc_flexible_mass(const ConstVectorRef& eta, BodyInertia& inertia) const;
  void calc_flexible_bias(const Vector3d& w_B, const ConstVectorRef& eta, const ConstVectorRef& eta_dot,
                          BodyInertia& inertia) const;
  void add_flexible_nodes(const records::FlexBody& flex);
  void calc_third_order_bias(const Vector3d& w_B, const ConstVectorRef& eta, const ConstVectorRef& eta_dot,
                             BodyInertia& inertia) const;

  int n_ = 0;
  bool stiffened_ = false;
  double mass_ = 0;
  Vector3d S0_ = Vector3d::Zero();
  Vector6d J0_ = Vector6d::Zero();  ///< xx yy zz xy xz yz (tensor components) about Bo
  Matrix6d M6_ = Matrix6d::Zero();
  AffineField field_;
  // Rows of all that follow are padded with zeros (kernels.hpp).
  MatrixXd M_rest_;  ///< n x n: M - LᵀL
  MatrixXd L_t_;     ///< n x 12
  // Integrals of products of two modes, one n x n table per kind, stacked; what tables are zero or follow from others
  // (RowBasis) is left to E: J = E_J_ᵀ(tables).
  MatrixXd by_eta_;  ///< of Γ4 as components of J; of y (c_q of the field); of Γ2 as C_jk = Γ2_kj
  MatrixXd A2_;      ///< Γ2_kj - Γ2_jk
  MatrixXd by_pair_;  ///< a column per kind, a row per product η̇_j η̇_k, k ≤ j: Ċη̇ of Γ2, then η̇ᵀc_qη̇
  MatrixXd E_J_, E_C_, E_A2_, E_pair_;           ///< columns: 6, 3, 3, 3
  Eigen::Matrix<double, 12, Eigen::Dynamic> B_;  ///< the field's B
  // Remainders of Γ1, J0 and of J's linear part after the affine functions: functions without mass, round-off.
  MatrixXd gamma1_rest_t_, J1_rest_t_;  ///< n x 3, n x 6 (or 0: rounding alone)
  Vector6d J0_rest_;
  MatrixXd M_, K_, D_;
  VectorXd K_diagonal_, D_diagonal_;  ///< empty where there is more than it
  std::vector<Node> nodes_;
  std::shared_ptr<const ThirdOrderBody> third_;
  std::shared_ptr<const SoftEnergy> soft_energy_;
};

/// h (6) of a rigid body: [ω×(ω×S); ω×Jω].
void calc_rigid_bias(const BodyInertia& inertia, const Vector3d& w_B, double* h);

}  // namespace bough::solver
