#pragma once
/// \file Truncated power series in one variable ε, and rotations along them (docs/theory/third-order.md).
///
/// A series is an array of its coefficients, orders 0 to 5, exact to the last order kept. Rotation vectors begin at
/// order 1: they are those of a motion away from the undeformed state.
#include <array>

#include <Eigen/Dense>

namespace bough::fe {

constexpr int kSeriesTop = 5;  ///< highest order kept

template <typename T>
using Series = std::array<T, kSeriesTop + 1>;

/// Σ_i a_i b_(k-i).
template <typename R, typename A, typename B>
Series<R> multiply(const Series<A>& a, const Series<B>& b) {
  Series<R> product;
  for (int k = 0; k <= kSeriesTop; ++k) {
    R sum = a[0] * b[static_cast<std::size_t>(k)];
    for (int i = 1; i <= k; ++i) sum += a[static_cast<std::size_t>(i)] * b[static_cast<std::size_t>(k - i)];
    product[static_cast<std::size_t>(k)] = sum;
  }
  return product;
}

using SeriesVector = Series<Eigen::Vector3d>;
using SeriesMatrix = Series<Eigen::Matrix3d>;

/// The series with six coefficients 0.
SeriesVector make_zero_vector();
/// The series with six coefficients 0.
SeriesMatrix make_zero_matrix();
/// Aᵀ, coefficient by coefficient.
SeriesMatrix transpose(const SeriesMatrix& A);
/// A b, truncated after order 5.
SeriesVector multiply(const SeriesMatrix& A, const SeriesVector& b);
/// A B, truncated after order 5.
SeriesMatrix multiply(const SeriesMatrix& A, const SeriesMatrix& B);
/// a × b, truncated after order 5.
SeriesVector cross(const SeriesVector& a, const SeriesVector& b);
/// Orders 1 to 5 at rows [row, row + 3) of a curve of N dofs, N x 5, and back.
SeriesVector get_vector(const Eigen::Ref<const Eigen::MatrixXd>& u, Eigen::Index row);
void put_vector(const SeriesVector& v, Eigen::Index row, Eigen::Ref<Eigen::MatrixXd> u);
/// x of A x = b, given A_0⁻¹.
SeriesVector solve(const SeriesMatrix& A, const Eigen::Matrix3d& inverse_0, const SeriesVector& b);
/// ax(A - Aᵀ): the vector of A_32 - A_23 and so on.
SeriesVector calc_skew_axis(const SeriesMatrix& A);
/// tr(A) 1 - A.
SeriesMatrix subtract_from_trace(const SeriesMatrix& A);

/// R = exp(θ̃). θ_0 = 0, here and below.
SeriesMatrix calc_exponential(const SeriesVector& theta);
/// θ of R = exp(θ̃), R_0 = 1.
SeriesVector calc_logarithm(const SeriesMatrix& R);
/// T(θ) of the spin δφ = T δθ of R = exp(θ̃), in fixed axes (base/rotation.hpp), and its inverse.
SeriesMatrix calc_tangent(const SeriesVector& theta);
SeriesMatrix calc_inverse_tangent(const SeriesVector& theta);

/// (R - 1) arm: what the end of an arm moves more than its foot, which turns by R = exp(θ̃).
SeriesVector calc_arm_motion(const SeriesVector& theta, const Eigen::Vector3d& arm);
/// Moment at the foot, conjugate to θ, of a force on the end of the arm: Tᵀ(R arm × force).
SeriesVector calc_arm_moment(const SeriesVector& theta, const Eigen::Vector3d& arm, const SeriesVector& force);

}  // namespace bough::fe
