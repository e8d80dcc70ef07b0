/// Products of tall matrices, at once, in slices and by two threads, against Eigen's.
#include "fe/linear/blas.hpp"

#include <gtest/gtest.h>

#include "tests/support/threads.hpp"

namespace bough::fe {
namespace {

using Eigen::MatrixXd;

/// Rows: few; slices of 1500 rows with a rest, and one too few; halves of two threads, each in slices.
TEST(MultiplyDense, IsTheProductHoweverTall) {
  for (const Eigen::Index rows : {1, 100, 1500, 1501, 7001, 100003}) {
    const MatrixXd A = MatrixXd::Random(rows, 40), B = MatrixXd::Random(rows, 10), C = MatrixXd::Random(40, 10);
    const MatrixXd product = A.transpose() * B, sum = B + A * C;
    for (const int threads : {1, 2}) {
      const bough::test::Threads number(threads);
      for (const double beta : {0.0, 1.0}) {
        MatrixXd result = C;
        multiply_dense(true, A, B, beta, result);
        EXPECT_LT((result - product - beta * C).cwiseAbs().maxCoeff(), 1e-11) << rows << " " << threads << " " << beta;
      }
      MatrixXd result = B;
      multiply_dense(false, A, C, 1, result);
      EXPECT_LT((result - sum).cwiseAbs().maxCoeff(), 1e-13) << rows << " " << threads;
    }
  }
}

}  // namespace
}  // namespace bough::fe
