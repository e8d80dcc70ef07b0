/// Matrices that are sparse but for a part of low rank, against dense algebra.
#include <gtest/gtest.h>

#include <random>

#include "fe/linear/factor.hpp"
#include "fe/linear/inertia.hpp"
#include "fe/linear/ranks.hpp"
#include "fe/linear/symmetric_matrix.hpp"

namespace bough::linear {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

/// A band of 5 on the diagonal and -1, -1 beside it, `shift` added to the diagonal.
SymmetricMatrix make_band(int n, double shift) {
  PetscMat A;
  check_petsc(MatCreate(PETSC_COMM_WORLD, A.out()));
  check_petsc(MatSetSizes(A.get(), PETSC_DECIDE, PETSC_DECIDE, n, n));
  check_petsc(MatSetType(A.get(), MATAIJ));
  check_petsc(MatSetUp(A.get()));
  PetscInt first = 0, last = 0;
  check_petsc(MatGetOwnershipRange(A.get(), &first, &last));
  for (int i = first; i < last; ++i)
    for (int j = std::max(0, i - 2); j <= std::min(n - 1, i + 2); ++j)
      check_petsc(MatSetValue(A.get(), i, j, i == j ? 5 + shift : -1, INSERT_VALUES));
  check_petsc(MatAssemblyBegin(A.get(), MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(A.get(), MAT_FINAL_ASSEMBLY));
  return SymmetricMatrix(std::move(A));
}

MatrixXd to_dense(const SymmetricMatrix& A, int n) { return multiply(A, MatrixXd::Identity(n, n)); }

struct Parts {
  MatrixXd D, V, K;
};
Parts make_parts(int n, int r, unsigned seed, double size) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto make = [&](int rows, int cols) {
    return MatrixXd::NullaryExpr(rows, cols, [&] { return uniform(generator); });
  };
  MatrixXd K = make(r, r);
  return {make(n, r), size * make(n, r), size * (K + K.transpose()).eval()};
}
LowRankPart make_part(const Parts& p) {
  return make_product_part(Sparse(p.D.sparseView()), Sparse(p.V.sparseView()), p.K);
}
MatrixXd calc_dense(const Parts& p) {
  return p.V * p.D.transpose() + p.D * p.V.transpose() + p.D * p.K * p.D.transpose();
}
int count_negative(const MatrixXd& A) {
  return static_cast<int>((Eigen::SelfAdjointEigenSolver<MatrixXd>(A).eigenvalues().array() < 0).count());
}

TEST(SymmetricMatrixSum, ActsAsTheDenseSum) {
  constexpr int n = 30;
  const Parts p = make_parts(n, 3, 7, 0.3);
  const MatrixXd low = calc_dense(p), band = to_dense(make_band(n, 0), n);
  const SymmetricMatrix A = make_band(n, 0).with_low_rank(make_part(p)), B = make_band(n, 1);
  ASSERT_TRUE(A.low_rank());
  EXPECT_FALSE(B.low_rank());
  const auto expect_is = [](const SymmetricMatrix& found, const MatrixXd& expected) {
    const auto size = static_cast<int>(expected.rows());
    EXPECT_LT((to_dense(found, size) - expected).norm(), 1e-13 * expected.norm());
    EXPECT_LT((get_diagonal(found) - expected.diagonal()).norm(), 1e-13 * expected.norm());
    const VectorXd x = VectorXd::LinSpaced(size, -1, 2);
    EXPECT_LT((calc_residual(found, x, x) - (x - expected * x)).norm(), 1e-13 * expected.norm());
  };
  const MatrixXd one = MatrixXd::Identity(n, n);
  expect_is(A, band + low);
  expect_is(add(A, -2, B), band + low - 2 * (band + one));
  expect_is(add(B, -2, A), band + one - 2 * (band + low));
  expect_is(add(A, 3, A), 4 * (band + low));
  expect_is(scale(A, -3), -3 * (band + low));
  expect_is(add_diagonal(A, VectorXd::LinSpaced(n, 1, 2)),
            band + low + MatrixXd(VectorXd::LinSpaced(n, 1, 2).asDiagonal()));
  const std::vector<int> kept{0, 3, 4, 11, 17, 29};
  expect_is(take_kept(A, kept), (band + low)(kept, kept));
  // PETSc's product with a vector, which SLEPc takes.
  PetscVec x, y;
  const PetscMat op = make_operator(A);
  check_petsc(MatCreateVecs(op.get(), x.out(), y.out()));
  check_petsc(VecSet(x.get(), 1));
  check_petsc(MatMult(op.get(), x.get(), y.get()));
  PetscReal norm = 0;
  check_petsc(VecNorm(y.get(), NORM_2, &norm));
  EXPECT_NEAR(norm, ((band + low) * VectorXd::Ones(n)).norm(), 1e-12);
}

TEST(SymmetricMatrixSum, LeavesOutWhatIsZero) {
  Parts p = make_parts(30, 4, 9, 1);
  p.V.col(1).setZero();
  p.K.row(1).setZero(), p.K.col(1).setZero();
  EXPECT_EQ(make_part(p).rank(), 6);
  const MatrixXd before = calc_dense(p);
  EXPECT_LT((make_part(p).multiply(MatrixXd::Identity(30, 30)) - before).norm(), 1e-13 * before.norm());
  // A mass with an offset and no inertia of its own: rank three of its 6 x 6.
  p.V.setZero();
  const Eigen::Matrix<double, 3, 4> arm{{1, 0, 0, 2}, {0, 1, 0, -1}, {0, 0, 0, 0}};
  p.K = 5 * arm.transpose() * arm;
  const LowRankPart part = make_part(p);
  EXPECT_EQ(part.rank(), 2);
  EXPECT_EQ(part.num_positive, 2);
  EXPECT_LT((part.multiply(MatrixXd::Identity(30, 30)) - calc_dense(p)).norm(), 1e-13 * calc_dense(p).norm());
  p.K.setZero();
  EXPECT_EQ(make_part(p).rank(), 0);
}

// Solutions and inertia by the factor of the sparse part, whichever of the two is definite.
TEST(SymmetricMatrixSum, FactorSolvesAndCounts) {
  constexpr int n = 40;
  bool seen_definite = false, seen_indefinite = false;
  for (unsigned seed = 1; seed < 9; ++seed)
    for (const double shift : {0.0, -4.0})
      for (const double size : {1e-3, 1.0, 1e4}) {
        const Parts p = make_parts(n, 3, seed, size);
        const SymmetricMatrix A = make_band(n, shift).with_low_rank(make_part(p));
        const MatrixXd dense = to_dense(make_band(n, shift), n) + calc_dense(p);
        const SymmetricFactor factor(A, false);
        const MatrixXd B = MatrixXd::Identity(n, 3), X = factor.solve(B);
        EXPECT_LT((dense * X - B).norm(), 1e-8 * B.norm()) << seed << " " << shift << " " << size;
        const int expected = count_negative(dense);
        EXPECT_EQ(count_negative_eigenvalues(A), expected);
        if (initialize_petsc().size == 1) {
          EXPECT_EQ(factor.is_definite(), shift == 0 && expected == 0);
        }
        (expected == 0 ? seen_definite : seen_indefinite) = true;
      }
  EXPECT_TRUE(seen_definite && seen_indefinite);
}

}  // namespace
}  // namespace bough::linear
