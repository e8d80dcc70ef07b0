#pragma once
/// \file Truncated power series in one variable ε, and rotations along them (docs/theory/third-order.md).
///
/// A series is an array of its coefficients, orders 0 to 5 or fewer, exact to the last order kept. Rotation vectors
/// begin at order 1: they are those of a motion away from the undeformed state.
#include <array>

#include <Eigen/Dense>

namespace bough::fe {

constexpr int kSeriesTop = 5;  ///< highest order kept

/// M coefficients, of orders 0 to M - 1; series.cpp has M = 3 to 6.
template <std::size_t M>
using VectorSeries = std::array<Eigen::Vector3d, M>;
template <std::size_t M>
using MatrixSeries = std::array<Eigen::Matrix3d, M>;
/// Series to the highest order.
using SeriesVector = VectorSeries<kSeriesTop + 1>;
using SeriesMatrix = MatrixSeries<kSeriesTop + 1>;

/// Σ_i a_i b_(k-i).
template <typename R, typename A, typename B, std::size_t M>
std::array<R, M> multiply(const std::array<A, M>& a, const std::array<B, M>& b) {
  std::array<R, M> product;
  for (std::size_t k = 0; k < M; ++k) {
    R sum = a[0] * b[k];
    for (std::size_t i = 1; i <= k; ++i) sum += a[i] * b[k - i];
    product[k] = sum;
  }
  return product;
}

/// The vector series with all coefficients 0.
template <std::size_t M = kSeriesTop + 1>
VectorSeries<M> make_zero_vector() {
  VectorSeries<M> zero;
  zero.fill(Eigen::Vector3d::Zero());
  return zero;
}
/// The matrix series with all coefficients 0.
template <std::size_t M = kSeriesTop + 1>
MatrixSeries<M> make_zero_matrix() {
  MatrixSeries<M> zero;
  zero.fill(Eigen::Matrix3d::Zero());
  return zero;
}
/// Aᵀ, coefficient by coefficient.
template <std::size_t M>
MatrixSeries<M> transpose(const MatrixSeries<M>& A) {
  MatrixSeries<M> T;
  for (std::size_t k = 0; k < M; ++k) T[k] = A[k].transpose();
  return T;
}
/// A b, truncated after the last order.
template <std::size_t M>
VectorSeries<M> multiply(const MatrixSeries<M>& A, const VectorSeries<M>& b) {
  return multiply<Eigen::Vector3d>(A, b);
}
/// A B, truncated after the last order.
template <std::size_t M>
MatrixSeries<M> multiply(const MatrixSeries<M>& A, const MatrixSeries<M>& B) {
  return multiply<Eigen::Matrix3d>(A, B);
}
/// A b of A_0 = 1.
template <std::size_t M>
VectorSeries<M> rotate(const MatrixSeries<M>& A, const VectorSeries<M>& b);
/// Aᵀb of A_0 = 1.
template <std::size_t M>
VectorSeries<M> rotate_back(const MatrixSeries<M>& A, const VectorSeries<M>& b);
/// AᵀB of A_0 = B_0 = 1.
template <std::size_t M>
MatrixSeries<M> rotate_back(const MatrixSeries<M>& A, const MatrixSeries<M>& B);
/// a × b, truncated after the last order.
template <std::size_t M>
VectorSeries<M> cross(const VectorSeries<M>& a, const VectorSeries<M>& b);
/// Orders 1 to u.cols() at rows [row, row + 3) of a curve of N dofs, zero above.
template <std::size_t M = kSeriesTop + 1>
VectorSeries<M> get_vector(const Eigen::Ref<const Eigen::MatrixXd>& u, Eigen::Index row) {
  VectorSeries<M> v = make_zero_vector<M>();
  for (Eigen::Index k = 1; k <= u.cols(); ++k) v[static_cast<std::size_t>(k)] = u.block<3, 1>(row, k - 1);
  return v;
}
/// Writes orders 1 to u.cols() to rows [row, row + 3) of a curve.
template <std::size_t M>
void put_vector(const VectorSeries<M>& v, Eigen::Index row, Eigen::Ref<Eigen::MatrixXd> u) {
  for (Eigen::Index k = 1; k <= u.cols(); ++k) u.block<3, 1>(row, k - 1) = v[static_cast<std::size_t>(k)];
}
/// x of A x = b, given A_0⁻¹.
template <std::size_t M>
VectorSeries<M> solve(const MatrixSeries<M>& A, const Eigen::Matrix3d& inverse_0, const VectorSeries<M>& b);
/// tr(A) 1 - A.
template <std::size_t M>
MatrixSeries<M> subtract_from_trace(const MatrixSeries<M>& A);

/// R = exp(θ̃). θ_0 = 0, here and below.
template <std::size_t M>
MatrixSeries<M> calc_exponential(const VectorSeries<M>& theta);
/// θ of R = exp(θ̃), R_0 = 1.
template <std::size_t M>
VectorSeries<M> calc_logarithm(const MatrixSeries<M>& R);
/// Tᵀ(θ) v, T of the spin δφ = T δθ of R = exp(θ̃), in fixed axes (base/rotation.hpp).
template <std::size_t M>
VectorSeries<M> apply_tangent_transpose(const VectorSeries<M>& theta, const VectorSeries<M>& v);
/// T⁻ᵀ(θ) v of the same T.
template <std::size_t M>
VectorSeries<M> apply_inverse_tangent_transpose(const VectorSeries<M>& theta, const VectorSeries<M>& v);

/// Rotation R nearest to grids of B = Σ w x Xᵀ + .. and H = RᵀB, which is symmetric: B = R H and RᵀR = 1 order by
/// order, R_k the symmetric part that the orders below leave, and a skew one by the spin that makes H_k symmetric.
/// `inverse`: of tr(B_0) 1 - B_0.
template <std::size_t M>
void find_nearest_rotation(const MatrixSeries<M>& B, const Eigen::Matrix3d& inverse, MatrixSeries<M>& R,
                           MatrixSeries<M>& H);

/// (R - 1) arm: what the end of an arm moves more than its foot, which turns by R = exp(θ̃).
SeriesVector calc_arm_motion(const SeriesVector& theta, const Eigen::Vector3d& arm);
/// Moment at the foot, conjugate to θ, of a force on the end of the arm: Tᵀ(R arm × force).
SeriesVector calc_arm_moment(const SeriesVector& theta, const Eigen::Vector3d& arm, const SeriesVector& force);

}  // namespace bough::fe
