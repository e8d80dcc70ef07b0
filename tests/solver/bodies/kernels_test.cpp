#include "solver/bodies/kernels.hpp"

#include "solver/bodies/row_basis.hpp"
#include "tests/solver/bodies/kernels_test.hpp"

namespace bough::solver::testing {
namespace {

BOUGH_KERNELS_OF(solver, OfThisMachine);

TEST(Kernels, AreEigensProductsAndFactors) { compare_kernels_with_eigen<OfThisMachine>(); }

TEST(RowBasisTest, KeepsWhatOthersDoNotGive) {
  const Eigen::MatrixXd rows = Eigen::MatrixXd::Random(3, 50);
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(7, 50);
  T.row(0) = rows.row(0);
  T.row(2) = 1e-6 * rows.row(1);            // small, but there
  T.row(3) = rows.row(0) - 2e6 * T.row(2);  // follows
  T.row(4) = 1e-17 * rows.row(2);           // rounding
  T.row(5) = rows.row(2);
  T.row(6) = T.row(0) + T.row(5) - T.row(3);
  const RowBasis basis = find_row_basis(T, 7);
  EXPECT_EQ(basis.rows.rows(), 3);
  EXPECT_EQ(basis.E.cols(), 7);
  EXPECT_LT((basis.E.transpose() * basis.rows - T).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((basis.E.transpose() * basis.rows - T).row(2).cwiseAbs().maxCoeff(), 1e-19);
  EXPECT_TRUE(basis.E.col(1).isZero(0));
  EXPECT_EQ(find_row_basis(Eigen::MatrixXd::Zero(6, 9), 0).rows.rows(), 0);
}

}  // namespace
}  // namespace bough::solver::testing
