/// Products of tall matrices, at once, in slices and by two threads, against Eigen's.
#include "fe/linear/blas.hpp"

#include <gtest/gtest.h>

#include "tests/support/threads.hpp"

namespace bough::linear {
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
      // Narrow ones: four columns at a time of both and single ones.
      for (const Eigen::Index columns : {1, 3, 4, 7, 8, 9}) {
        const auto C_few = C(Eigen::seqN(1, 38), Eigen::all).leftCols(columns);
        MatrixXd narrow = B;
        multiply_dense(false, A.middleCols(1, 38), C_few, 1, narrow.leftCols(columns));
        EXPECT_LT((narrow.leftCols(columns) - B.leftCols(columns) - A.middleCols(1, 38) * C_few).cwiseAbs().maxCoeff(),
                  1e-13);
        EXPECT_EQ(narrow.rightCols(10 - columns), B.rightCols(10 - columns));
        multiply_dense(false, A.middleCols(1, 38), C_few, 0, narrow.leftCols(columns));
        EXPECT_LT((narrow.leftCols(columns) - A.middleCols(1, 38) * C_few).cwiseAbs().maxCoeff(), 1e-13);
      }
    }
  }
}

}  // namespace
}  // namespace bough::linear
