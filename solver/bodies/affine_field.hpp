#pragma once
/// \file The second-order displacement of a body as the affine field that its K_G1 fix (docs/theory/flexible-body.md
/// §5).
///
/// A material point p moves as r = Σ_b A_b f_b(p) + φη, b = 0..3, with functions orthonormal under the mass,
/// f_0 = 1/√m and f_b = a_b·(p - c)/√e_b (c centre of mass, e_b and a_b principal second moments about it), and
///     A(η) = A0 + x,   x = a - Q a aᵀ W,   a = Σ_q B_q ½ηᵀc_qη      (3 x 4 each; all in B)
/// A0 gives p itself; the B_q span the fields of the K_G1. Q, W remove a aᵀ from the second moment A Aᵀ, so that the
/// inertia of the body is that of second order up to η⁵. A function without mass (a line of masses across itself) is
/// left out: its column of A is zero.
#include <vector>

#include "formats/records/flex_body.hpp"
#include "solver/bodies/spatial.hpp"

namespace bough::solver {

struct AffineField {
  using Amplitudes = Eigen::Matrix<double, 3, 4>;
  using Columns = Eigen::Matrix<double, 12, Eigen::Dynamic>;  ///< a 3 x 4, column by column, per mode

  Amplitudes A0 = Amplitudes::Zero();
  Columns L;                ///< 12 x n: ∫ρ φ_j fᵀ; its first column is Γ0_j/√m
  Columns B;                ///< 12 x r; orthonormal; r = 0 without K_G1
  std::vector<MatrixXd> c;  ///< [q] n x n, symmetric
  Matrix3d Q = Matrix3d::Zero();
  Amplitudes W = Amplitudes::Zero();  ///< its first column is zero
  double lost = 0;  ///< largest part of a K_G1, relative to the largest, that no affine field of this mass has

  /// Q (a bᵀ + b aᵀ) W: the part of x that is bilinear in a, twice.
  Amplitudes calc_correction(const Amplitudes& a, const Amplitudes& b) const {
    const Matrix3d ab = a * b.transpose(), both = (ab + ab.transpose()) * W.rightCols<3>();
    Amplitudes x;
    x.col(0).setZero();
    x.rightCols<3>().noalias() = Q * both;
    return x;
  }
  /// Number r of columns of B; 0 without K_G1.
  int rank() const { return static_cast<int>(c.size()); }
  /// From mass, inertia, Γ0, Γ1, Γ3 and those of the twelve K_G1 that were computed. The first n modes.
  static AffineField fit(const records::FlexBody& flex, int n, bool stiffening);
};

}  // namespace bough::solver
