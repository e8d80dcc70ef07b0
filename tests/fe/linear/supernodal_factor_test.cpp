/// A factor in two parts against one in one part, and what it refuses.
#include "fe/linear/supernodal_factor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "fe/linear/factor.hpp"
#include "fe/linear/ordering.hpp"
#include "fe/linear/symmetric_matrix.hpp"
#include "tests/fe/linear/paired_rows.hpp"
#include "tests/support/threads.hpp"

namespace bough::linear {
namespace {

using bough::test::Threads;

/// Nine points of a grid of num_x x num_y nodes of two rows each, with `shift` of the identity taken away. Definite
/// below about 1.5 ((π / num_x)² + (π / num_y)²).
SymmetricMatrix make_grid(int num_x, int num_y, double shift = 0, bool is_apart = false) {
  const int n = 2 * num_x * num_y;
  PetscMat A;
  check_petsc(MatCreateSeqAIJ(PETSC_COMM_SELF, n, n, 18, nullptr, A.out()));
  for (int y = 0; y < num_y; ++y)
    for (int x = 0; x < num_x; ++x)
      for (int d = 0; d < 2; ++d) {
        const int row = 2 * (y * num_x + x) + d;
        check_petsc(MatSetValue(A.get(), row, row, 5 + 0.1 * d - shift, INSERT_VALUES));
        // Apart: the second rows alone, and the columns of nodes left and right of the 30th.
        if (!is_apart) check_petsc(MatSetValue(A.get(), row, 2 * (y * num_x + x) + 1 - d, 0.005, INSERT_VALUES));
        if (is_apart && d == 1) continue;
        for (int dx = -1; dx <= 1; ++dx)
          for (int dy = -1; dy <= 1; ++dy) {
            if ((dx == 0 && dy == 0) || x + dx < 0 || x + dx >= num_x || y + dy < 0 || y + dy >= num_y) continue;
            if (is_apart && dx != 0 && std::min(x, x + dx) == 30) continue;
            check_petsc(
                MatSetValue(A.get(), row, row + 2 * (dy * num_x + dx), dx * dy == 0 ? -1 : -0.25, INSERT_VALUES));
          }
      }
  return assemble_in_pairs(std::move(A), n);
}

class SupernodalFactorOn : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (initialize_petsc().size > 1) GTEST_SKIP() << "several processes factor together";
  }
};
INSTANTIATE_TEST_SUITE_P(Threads, SupernodalFactorOn, ::testing::Values(1, 2));

TEST_P(SupernodalFactorOn, SolvesAsThePivotedOneDoes) {
  const Threads threads(GetParam());
  const SymmetricMatrix A = make_grid(90, 60);
  const SupernodalFactor own = make_supernodal_factor(A, 0);
  ASSERT_TRUE(own.solver);
  EXPECT_TRUE(own.is_definite);
  EXPECT_EQ(own.num_parts, GetParam());
  const SymmetricFactor pivoted(A, false, FactorMethod::Pivoting);
  const Eigen::MatrixXd B = Eigen::MatrixXd::Random(2 * 90 * 60, 21);
  for (const int m : {1, 4, 5, 8, 21}) {  // few, many, and more than go together
    const Eigen::MatrixXd X = own.solver->solve(B.leftCols(m));
    const Eigen::MatrixXd R = B.leftCols(m) - multiply(A, X);
    EXPECT_LT(R.cwiseAbs().maxCoeff(), 1e-12 * X.cwiseAbs().maxCoeff()) << m;
    EXPECT_LT((X - pivoted.solve(B.leftCols(m))).cwiseAbs().maxCoeff(), 1e-11 * X.cwiseAbs().maxCoeff()) << m;
    // Again, to the bit: nothing depends on which thread comes first.
    const SupernodalFactor again = make_supernodal_factor(A, 0);
    EXPECT_TRUE((again.solver->solve(B.leftCols(m)).array() == X.array()).all()) << m;
  }
}

/// Rotations in another unit of length: S A S with powers of two in S is factored without another rounding error, so
/// that S X solves it to the last bit. Row sums over both kinds as the shift lose its digits.
TEST_P(SupernodalFactorOn, UnitsOfRowsChangeNoDigit) {
  const Threads threads(GetParam());
  const SymmetricMatrix A = make_grid(90, 60);
  const Eigen::MatrixXd B = Eigen::MatrixXd::Random(2 * 90 * 60, 5);
  const Eigen::MatrixXd X = make_supernodal_factor(A, 0).solver->solve(B);
  for (const double unit : {0x1p-20, 0x1p20}) {
    PetscVec scale;
    check_petsc(MatCreateVecs(A.sparse(), scale.out(), nullptr));
    Eigen::VectorXd S(B.rows());
    for (Eigen::Index i = 0; i < S.size(); ++i) S(i) = i % 2 == 0 ? 1 : unit;
    PetscScalar* values = nullptr;
    check_petsc(VecGetArray(scale.get(), &values));
    Eigen::VectorXd::Map(values, S.size()) = S;
    check_petsc(VecRestoreArray(scale.get(), &values));
    const SymmetricMatrix scaled = make_grid(90, 60);
    check_petsc(MatDiagonalScale(scaled.sparse(), scale.get(), scale.get()));
    const SupernodalFactor factor = make_supernodal_factor(scaled, 0);
    ASSERT_TRUE(factor.solver) << unit;
    EXPECT_EQ(factor.num_parts, GetParam());
    EXPECT_EQ(S.asDiagonal() * factor.solver->solve(S.asDiagonal() * B), X) << unit;
  }
}

TEST(SupernodalFactor, IsOfLargeMatricesInGroups) {
  if (initialize_petsc().size > 1) GTEST_SKIP() << "several processes factor together";
  const Threads two(2);
  EXPECT_FALSE(make_supernodal_factor(make_grid(90, 60)).solver) << "small";
  EXPECT_EQ(make_supernodal_factor(make_grid(4000, 1), 0).num_parts, 2) << "a line";
  const SymmetricMatrix bare = make_grid(90, 60);
  bare.row_order() = {};
  EXPECT_FALSE(make_supernodal_factor(bare, 0).solver) << "rows without groups";
  EXPECT_EQ(make_supernodal_factor(make_grid(6, 6), 0).num_parts, 1) << "many rows between";
}

/// A negative eigenvalue of the whole (0.0055) may be none of either part (0.011): the rows between have it.
TEST_P(SupernodalFactorOn, IndefiniteMatricesAreTold) {
  const Threads threads(GetParam());
  EXPECT_TRUE(make_supernodal_factor(make_grid(90, 60, 0.002), 0).is_definite);
  for (const double shift : {0.006, 0.05, 3.0}) {
    const SupernodalFactor own = make_supernodal_factor(make_grid(90, 60, shift), 0);
    EXPECT_FALSE(own.is_definite) << shift;
    EXPECT_FALSE(own.solver) << shift;
  }
}

TEST_P(SupernodalFactorOn, LargeMatricesTakeIt) {
  const Threads threads(GetParam());
  const SymmetricMatrix A = make_grid(160, 90);
  const auto factor = SymmetricFactor::try_definite(A);
  ASSERT_TRUE(factor);
  const Eigen::MatrixXd B = Eigen::MatrixXd::Random(2 * 160 * 90, 3);
  EXPECT_EQ(factor->solve(B), make_supernodal_factor(A).solver->solve(B));
  const Eigen::MatrixXd X = SymmetricFactor(A, false).solve(B);
  EXPECT_LT((B - multiply(A, X)).cwiseAbs().maxCoeff(), 1e-12 * X.cwiseAbs().maxCoeff());
}

/// Two pieces that do not touch, and rows of a piece that stand alone: trees without a way to the rows between.
/// K + s M of a body that nothing holds is factored as K would be, whatever M couples beside K.
TEST_P(SupernodalFactorOn, SumsAreFactoredInPartsToo) {
  const Threads threads(GetParam());
  const SymmetricMatrix K = make_grid(90, 60, 0, true), M = make_grid(90, 60);
  ASSERT_TRUE(make_supernodal_factor(K, 0).solver);  // K knows its parts, which M couples
  const SymmetricMatrix sum = add(K, 0.5, M);
  const SupernodalFactor own = make_supernodal_factor(sum, 0);
  ASSERT_TRUE(own.solver);
  EXPECT_EQ(own.num_parts, GetParam());
  const Eigen::MatrixXd B = Eigen::MatrixXd::Random(2 * 90 * 60, 3), X = own.solver->solve(B);
  const Eigen::MatrixXd R = B - multiply(K, X) - 0.5 * multiply(M, X);
  EXPECT_LT(R.cwiseAbs().maxCoeff(), 1e-12 * X.cwiseAbs().maxCoeff());
}

TEST_P(SupernodalFactorOn, PiecesMayBeApart) {
  const Threads threads(GetParam());
  const SymmetricMatrix A = make_grid(90, 60, 0, true);
  const SupernodalFactor own = make_supernodal_factor(A, 0);
  ASSERT_TRUE(own.solver);
  const Eigen::MatrixXd B = Eigen::MatrixXd::Random(2 * 90 * 60, 4);
  const Eigen::MatrixXd X = own.solver->solve(B);
  EXPECT_LT((B - multiply(A, X)).cwiseAbs().maxCoeff(), 1e-12 * X.cwiseAbs().maxCoeff());
}

/// What was found of a matrix is found anew when it has got an entry between its parts.
TEST(SupernodalFactor, PartsAreThoseOfTheMatrixAsItIs) {
  if (initialize_petsc().size > 1) GTEST_SKIP() << "several processes factor together";
  const SymmetricMatrix A = make_grid(90, 60);
  const auto before = find_two_parts(A, 0), again = find_two_parts(A, 0);
  ASSERT_TRUE(before && again);
  EXPECT_EQ(before->first, again->first);
  EXPECT_EQ(before->second, again->second);
  EXPECT_EQ(before->between, again->between);
  check_petsc(MatSetOption(A.sparse(), MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  const PetscInt i = before->first.front(), j = before->second.front();
  check_petsc(MatSetValue(A.sparse(), i, j, -0.1, INSERT_VALUES));
  check_petsc(MatSetValue(A.sparse(), j, i, -0.1, INSERT_VALUES));
  check_petsc(MatAssemblyBegin(A.sparse(), MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(A.sparse(), MAT_FINAL_ASSEMBLY));
  const auto after = find_two_parts(A, 0);
  ASSERT_TRUE(after);
  const auto has = [](const std::vector<PetscInt>& rows, PetscInt row) {
    return std::find(rows.begin(), rows.end(), row) != rows.end();
  };
  EXPECT_FALSE(has(after->first, i) && has(after->second, j));
  EXPECT_FALSE(has(after->second, i) && has(after->first, j));
}

}  // namespace
}  // namespace bough::linear
