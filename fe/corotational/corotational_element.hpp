#pragma once
/// \file Strain energy of one element under finite displacements and rotations, as a power series along a curve.
///
/// Element-independent: the linear K_e in a frame that follows the nodes, and the second-order strains inside the
/// element from its K_G. Theory: docs/theory/third-order.md (1) to (3).
#include <memory>
#include <vector>

#include "fe/corotational/best_fit.hpp"
#include "fe/corotational/series.hpp"
#include "fe/elements/element.hpp"
#include "fe/elements/thermal_loads.hpp"

namespace bough::fe {

/// An element under finite motion. Dofs as of the element; rotations of the forces are spins in basic.
struct FiniteForces {
  VectorXd d;           ///< N: deformations seen from the frame
  VectorXd f;           ///< N: forces, moments
  MatrixXd K;           ///< N x N: ∂f by displacements and spins; symmetric where the moments are zero
  double energy = 0;    ///< V
  double max_turn = 0;  ///< largest angle between a node and the frame, rad
  VectorXd internal;    ///< s: internal forces of the stress state, with those of second-order strains
  VectorXd g;           ///< N: ∂V/∂d
  MatrixXd H;           ///< N x N: ∂g/∂d
};

/// T⁻¹(θ) of calc_rotation_tangent.
Matrix3d calc_inverse_rotation_tangent(const Vector3d& theta);
/// θ of exp(θ̃) = R, |θ| ≤ π.
Vector3d calc_rotation_log(const Matrix3d& R);
/// ∂(T⁻ᵀ(θ) g)/∂θ with g fixed.
Matrix3d calc_inverse_tangent_slope(const Vector3d& theta, const Vector3d& g);

/// Returns true if the stiffness of the element turns with its grids (CorotationalElement::follows_nodes); O(N²).
bool follows_nodes(const Element& element, const std::vector<Node>& nodes);

/// An element along curves, coefficients 1 to 5 of each side by side, as CorotationalElement::calc_forces has them.
struct LocalSeries {
  MatrixXd d;         ///< N x 5 m: deformations seen from the frame
  MatrixXd internal;  ///< s x 5 m: internal forces of the stress state, second-order strains included
};

class FittedCore;

class CorotationalElement {
 public:
  /// `nodes`: those that element.nodes() and gdofs() index. Both are read here only. Computes K⁺ and K_G of every unit
  /// internal force: O(N³ + s N²).
  CorotationalElement(const Element& element, const std::vector<Node>& nodes);

  /// False: V = ½ uᵀKu. Scalar springs, grounded elements, matrices without grids.
  bool follows_nodes() const { return follows_nodes_; }
  /// Number N of dofs.
  int num_dofs() const { return static_cast<int>(K_.rows()); }

  /// Coefficients 1 to `top` (2 to 5) of ∂V/∂u along u(ε) = Σ ε^k u_k: conjugate to translations and rotation vectors
  /// in basic. u, result: N x top m for m curves, the orders of each side by side.
  MatrixXd calc_forces(const Eigen::Ref<const MatrixXd>& u, int top = kSeriesTop) const;
  /// Deformations and internal forces along the curves u (N x 5 m); d = u and no internal forces if it does not follow
  /// nodes.
  LocalSeries calc_local(const Eigen::Ref<const MatrixXd>& u) const;

  /// Forces and stiffness of a finite motion. u: N, displacements in basic, rows of rotations unread; `rotations`: of
  /// grids(), identity where it has none; `heat`: the loads of temperatures turn with the frame, their internal forces
  /// act on the second-order strains: V - load·d + ½ force·w. `energy` is without -load·d, `internal` without
  /// `heat->force`. Needs follows_nodes().
  FiniteForces calc_finite(const Eigen::Ref<const VectorXd>& u, const std::vector<Matrix3d>& rotations,
                           const ThermalState* heat = nullptr) const;

  /// Parts of V, for tests (K alone of connectors on shells): V = ½ dᵀKd + ½ Σ (F d)_m w_m + ⅛ wᵀEw, w_m = dᵀP_m d.
  const MatrixXd& K() const { return K_; }
  const MatrixXd& F() const { return F_; }
  const MatrixXd& E() const { return E_; }
  const std::vector<MatrixXd>& P() const { return P_; }
  /// Places of the nodes from their centre (3 x nodes), first row of each node's translations and of its rotations (-1:
  /// none), and the weight of rotations in the frame.
  const Matrix3Xd& arms() const { return arms_; }
  const std::vector<int>& translations() const { return translations_; }
  const std::vector<int>& rotations() const { return rotations_; }
  double rotation_weight() const { return rotation_weight_; }
  const std::vector<int>& grids() const { return grids_; }  ///< indices of the nodes, each once

 private:
  friend bool follows_nodes(const Element& element, const std::vector<Node>& nodes);
  CorotationalElement() = default;
  bool find_stiffness(const Element& element, const std::vector<Node>& nodes);
  bool find_nodes(const Element& element, const std::vector<Node>& nodes);
  bool is_free_of_rigid_motion() const;
  void set_frame();
  void set_local_strains(const Element& element);
  template <int Top>
  struct Motion;
  /// Frames and nodes along the curves, N x Top m, and d as LocalSeries has it.
  template <int Top>
  void calc_motions(const Eigen::Ref<const MatrixXd>& u, std::vector<Motion<Top>>& motions, MatrixXd& d) const;
  /// Internal forces that are independent, and what goes with them: F has as many rows as the element has strains, at
  /// most N - 6 (CQUAD4: 18 of 36).
  struct SecondStrains {
    MatrixXd F, E;  ///< r x N, r x r
    MatrixXd P;     ///< N x N r: side by side
  };
  SecondStrains reduce_second_strains() const;
  template <int Top>
  void calc_local_gradient(const SecondStrains& second, const MatrixXd& d, MatrixXd& g) const;
  template <int Top>
  void calc_series(const SecondStrains& second, const Eigen::Ref<const MatrixXd>& u, Eigen::Ref<MatrixXd> f) const;
  void calc_local_forces(const ThermalState* heat, FiniteForces& result) const;

  bool follows_nodes_ = false;
  MatrixXd K_, F_, E_;
  std::vector<MatrixXd> P_;
  Matrix3Xd arms_;
  std::vector<int> grids_, translations_, rotations_;
  double rotation_weight_ = 0;
  Matrix3d frame_inverse_ = Matrix3d::Zero();
  std::shared_ptr<const FittedCore> fitted_;  ///< of connectors on shells, in place of F_, P_ and E_
};

}  // namespace bough::fe
