#pragma once
/// \file Rotation of best fit of grids at a finite motion, and its first and second derivatives: the frame of an
/// element, the rotation of an RBE3 (docs/theory/third-order.md (1), docs/theory/nonlinear-statics.md).
#include <vector>

#include "fe/elements/element.hpp"

namespace bough::fe {

using Matrix3N = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// Inverse of a symmetric matrix without directions whose eigenvalue is 1e-12 of the largest (rods: no twist).
Matrix3d invert_symmetric(const Matrix3d& A);
/// Vector of A - Aᵀ: A_32 - A_23 and so on.
Vector3d calc_axis(const Matrix3d& A);
/// tr(A) 1 - A.
Matrix3d subtract_from_trace(const Matrix3d& A);

/// A grid of a fit.
struct FitGrid {
  Vector3d arm = Vector3d::Zero();       ///< X: from the weighted centre, Σ w X = 0
  double weight = 1;                     ///< w: of its place
  double turn_weight = 0;                ///< c: of its rotation
  int translations = 0, rotations = -1;  ///< first rows of its displacements and spins in a variation; -1: none
};

/// The rotation R nearest to grids: RᵀB symmetric, B = Σ (w x Xᵀ + c R_k). A variation is a vector of N displacements
/// and spins, in basic.
class BestFit {
 public:
  /// x: places, from any point; R: rotations; both per grid. N: size of a variation. `grids` outlives this.
  BestFit(const std::vector<FitGrid>& grids, const Matrix3Xd& x, const std::vector<Matrix3d>& rotations, int N);

  /// The rotation of best fit.
  const Matrix3d& R() const { return R_; }
  /// RᵀR_k.
  const Matrix3d& Q(std::size_t k) const { return Q_[k]; }
  /// 3 x N: spin of R, seen from it.
  const Matrix3N& G() const { return G_; }
  /// 3 x N: spin of grid k against R, seen from R.
  Matrix3N calc_relative_spin(std::size_t k) const;

  /// μ = S⁻¹ τ, S = tr(H) 1 - H, H = RᵀB: a moment τ on R, seen from it, is forces w μ × X and moments c back(k) μ on
  /// the grids, seen from R.
  Vector3d calc_mu(const Vector3d& tau) const { return S_inverse_ * tau; }
  /// 3 x N: δμ, given δτ.
  Matrix3N calc_mu_slope(const Vector3d& mu, const Matrix3N& d_tau) const;
  /// tr(Q) 1 - Qᵀ of grid k.
  Matrix3d back(std::size_t k) const { return subtract_from_trace(Q_[k]).transpose(); }
  /// 3 x N: δ(back(k) μ), given δμ.
  Matrix3N calc_back_slope(std::size_t k, const Vector3d& mu, const Matrix3N& d_mu) const;

 private:
  const std::vector<FitGrid>& grids_;
  Matrix3d R_, H_, S_inverse_;
  std::vector<Matrix3d> Q_;
  Matrix3N G_;
};

}  // namespace bough::fe
