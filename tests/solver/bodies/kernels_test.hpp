#pragma once
/// \file The dense loops next to Eigen, for one namespace of them.
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Dense>

namespace bough::solver::testing {

/// The kernels of a namespace as static members of a class.
#define BOUGH_KERNELS_OF(room, Name)                                             \
  struct Name {                                                                  \
    static constexpr auto multiply = room::multiply;                             \
    static constexpr auto multiply_transposed = room::multiply_transposed;       \
    static constexpr auto add_product = room::add_product;                       \
    static constexpr auto contract = room::contract;                             \
    static constexpr auto add_scaled = room::add_scaled;                         \
    static constexpr auto add_square = room::add_square;                         \
    static constexpr auto factor_trapezoid = room::factor_trapezoid;             \
    static constexpr auto solve_lower = room::solve_lower;                       \
    static constexpr auto solve_lower_transposed = room::solve_lower_transposed; \
  }

/// K: has the kernels as static members.
template <class K>
void compare_kernels_with_eigen() {
  using Eigen::MatrixXd, Eigen::VectorXd, Eigen::Lower, Eigen::Upper;
  const auto expect_near = [](const MatrixXd& a, const MatrixXd& b, int n) {
    EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-13 * (1 + b.cwiseAbs().maxCoeff())) << n;
  };
  const auto lower = [](const MatrixXd& A) { return MatrixXd(A.triangularView<Lower>()); };
  for (int n = 1; n < 43; ++n) {
    const Eigen::Index rows = (n + 3) / 4 * 4, tall = (n + 9) / 4 * 4;
    const MatrixXd A = MatrixXd::Random(rows, n), V = MatrixXd::Random(rows, 12), Q = MatrixXd::Random(rows, rows);
    const VectorXd x = VectorXd::Random(n), z = VectorXd::Random(rows), b = VectorXd::Random(n);
    VectorXd Ax(rows), Az(n), u = b, v = b;
    K::multiply(A.data(), rows, n, x.data(), Ax.data());
    expect_near(Ax, A * x, n);
    K::multiply_transposed(A.data(), rows, n, z.data(), Az.data());
    expect_near(Az, A.transpose() * z, n);
    for (const int m : {1, 2, 3, 4, 7, 12}) {
      const MatrixXd B = MatrixXd::Random(n, m), C = MatrixXd::Random(rows, m);
      MatrixXd sum = C;
      K::add_product(A.data(), rows, n, B.data(), m, sum.data());
      expect_near(sum, C + A * B, n);
    }
    const MatrixXd in = MatrixXd::Random(rows, 5);
    for (const int num_factors : {3, 6}) {
      std::vector<int> offsets;
      for (int i = 0; i < 2 * num_factors; ++i) offsets.push_back((7 * i + 4) % 5 * static_cast<int>(rows));
      const VectorXd weights = VectorXd::Random(num_factors);
      MatrixXd out(rows, 2), expected = MatrixXd::Zero(rows, 2);
      for (int i = 0; i < 2 * num_factors; ++i)
        expected.col(i / num_factors) += weights[i % num_factors] * in.col((7 * i + 4) % 5);
      K::contract(in.data(), rows, offsets.data(), 2, weights.data(), num_factors, out.data());
      expect_near(out, expected, n);
    }
    VectorXd scaled = in.col(0);
    K::add_scaled(0.3, in.col(1).data(), -2, in.col(2).data(), rows, scaled.data());
    expect_near(scaled, in.col(0) + 0.3 * in.col(1) - 2 * in.col(2), n);
    MatrixXd square(rows, rows);
    K::add_square(Q.data(), V.data(), rows, square.data());
    expect_near(lower(square), lower(Q + V * V.transpose()), n);

    const MatrixXd R = MatrixXd::Random(n, n), D = R * R.transpose() + n * MatrixXd::Identity(n, n),
                   W = MatrixXd::Random(n, 6), L = D.llt().matrixL();
    MatrixXd factor = MatrixXd::Constant(tall, n, 7);  // padding holds anything
    factor.topRows(n) = lower(D);
    factor.block(n, 0, 6, n) = W.transpose();
    K::factor_trapezoid(factor.data(), tall, n);
    expect_near(lower(factor.topRows(n)), L, n);
    expect_near(factor.block(n, 0, 6, n).transpose(), L.triangularView<Lower>().solve(W), n);
    K::solve_lower(factor.data(), tall, n, u.data());
    expect_near(u, L.triangularView<Lower>().solve(b), n);
    K::solve_lower_transposed(factor.data(), tall, n, v.data());
    expect_near(v, L.transpose().triangularView<Upper>().solve(b), n);

    factor.topRows(n) = lower(D);
    factor(n - 1, n - 1) = -1;
    K::factor_trapezoid(factor.data(), tall, n);
    EXPECT_FALSE(factor(n - 1, n - 1) > 0) << "a pivot that is not positive";
  }
}

}  // namespace bough::solver::testing
