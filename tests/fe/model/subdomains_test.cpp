/// Rows cut among ranks against the whole matrix; on one process there is nothing to cut.
#include "fe/linear/subdomains.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include <Eigen/SparseCholesky>

#include "fe/linear/factor.hpp"
#include "fe/linear/fronts.hpp"
#include "fe/linear/ordering.hpp"
#include "fe/linear/ranks.hpp"

namespace bough::fe {
namespace {

using Eigen::MatrixXd;

constexpr int kWide = 60, kHigh = 40, kRows = 2 * kWide * kHigh;

/// Two rows a node, each coupled to the four nodes around and to each other, on all ranks; `reach`: to the node that
/// many further on too.
PetscMat make_grid(double diagonal, int reach = 0) {
  PetscMat A;
  check_petsc(MatCreate(PETSC_COMM_WORLD, A.out()));
  check_petsc(MatSetSizes(A.get(), PETSC_DECIDE, PETSC_DECIDE, kRows, kRows));
  check_petsc(MatSetType(A.get(), MATAIJ));
  check_petsc(MatSeqAIJSetPreallocation(A.get(), 9, nullptr));
  check_petsc(MatMPIAIJSetPreallocation(A.get(), 9, nullptr, 9, nullptr));
  PetscInt first = 0, last = 0;
  check_petsc(MatGetOwnershipRange(A.get(), &first, &last));
  std::vector<int> start;
  for (PetscInt row = first; row < last; ++row) {
    if (row == first || row % 2 == 0) start.push_back(row);
    const int node = row / 2, x = node % kWide;
    const auto set = [&](int column, double value) {
      if (column >= 0 && column < kRows) check_petsc(MatSetValue(A.get(), row, column, value, INSERT_VALUES));
    };
    set(row, diagonal + 0.01 * (row % 7));
    set(row ^ 1, 0.1);
    if (x > 0) set(row - 2, -1);
    if (x + 1 < kWide) set(row + 2, -1);
    set(row - 2 * kWide, -1);
    set(row + 2 * kWide, -1);
    if (reach > 0) set(row - 2 * reach, 0.05), set(row + 2 * reach, 0.05);
  }
  start.push_back(last);
  check_petsc(MatAssemblyBegin(A.get(), MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(A.get(), MAT_FINAL_ASSEMBLY));
  set_row_groups(A.get(), start);
  return A;
}

/// Cut by METIS, or where PETSc has cut the rows.
class SubdomainsOf : public ::testing::TestWithParam<bool> {
 protected:
  void mark(Mat A) const {
    if (GetParam()) set_rows_by_parts(A);
  }
};
INSTANTIATE_TEST_SUITE_P(ByParts, SubdomainsOf, ::testing::Bool());

TEST_P(SubdomainsOf, MultiplyAndSolveAsTheWholeDoes) {
  const PetscMat A = make_grid(4.5), B = make_grid(2, 3);  // B couples what A does not
  mark(A.get());
  const auto domains = find_subdomains(A.get(), B.get(), 0);
  ASSERT_EQ(domains.has_value(), initialize_petsc().size > 1);
  if (!domains) return;
  std::srand(1);
  const MatrixXd X = MatrixXd::Random(kRows, 13);
  EXPECT_EQ(domains->replicate(domains->take_own(X)), X);
  for (Mat matrix : {A.get(), B.get()}) {
    const MatrixXd Y = domains->replicate(SubdomainMatrix(matrix, *domains).multiply(domains->take_own(X)));
    EXPECT_LT((Y - multiply(matrix, X)).cwiseAbs().maxCoeff(), 1e-13);
  }
  const SubdomainFactor factor(A.get(), *domains);
  ASSERT_TRUE(factor.is_definite());
  for (const int m : {1, 4, 8, 13}) {
    const MatrixXd solution = domains->replicate(factor.solve(domains->take_own(X.leftCols(m))));
    EXPECT_LT((multiply(A.get(), solution) - X.leftCols(m)).cwiseAbs().maxCoeff(), 1e-12) << m;
  }
}

/// Every second row in another unit, a power of two: the solution is the same to the last bit.
TEST_P(SubdomainsOf, UnitsOfRowsChangeNoDigit) {
  std::srand(1);
  const MatrixXd B = MatrixXd::Random(kRows, 4);
  MatrixXd X;
  for (const double unit : {1.0, 0x1p-20, 0x1p20}) {
    const PetscMat A = make_grid(4.5);
    PetscVec scale;
    check_petsc(MatCreateVecs(A.get(), scale.out(), nullptr));
    PetscInt first = 0, last = 0;
    check_petsc(VecGetOwnershipRange(scale.get(), &first, &last));
    for (PetscInt i = first; i < last; ++i)
      check_petsc(VecSetValue(scale.get(), i, i % 2 == 0 ? 1 : unit, INSERT_VALUES));
    check_petsc(VecAssemblyBegin(scale.get()));
    check_petsc(VecAssemblyEnd(scale.get()));
    check_petsc(MatDiagonalScale(A.get(), scale.get(), scale.get()));
    Eigen::VectorXd S(kRows);
    for (int i = 0; i < kRows; ++i) S(i) = i % 2 == 0 ? 1 : unit;
    mark(A.get());
    const auto domains = find_subdomains(A.get(), A.get(), 0);
    ASSERT_EQ(domains.has_value(), initialize_petsc().size > 1);
    if (!domains) return;
    const SubdomainFactor factor(A.get(), *domains);
    ASSERT_TRUE(factor.is_definite());
    const MatrixXd Y = S.asDiagonal() * domains->replicate(factor.solve(domains->take_own(S.asDiagonal() * B)));
    if (unit == 1)
      X = Y;
    else
      EXPECT_EQ(Y, X) << unit;
  }
}

/// On every rank.
Eigen::SparseMatrix<double> gather_matrix(Mat A) {
  PetscInt first = 0, last = 0, num = 0;
  check_petsc(MatGetOwnershipRange(A, &first, &last));
  const PetscInt* columns = nullptr;
  const PetscScalar* values = nullptr;
  std::vector<int> places;
  std::vector<double> entries;
  for (PetscInt row = first; row < last; ++row) {
    check_petsc(MatGetRow(A, row, &num, &columns, &values));
    for (PetscInt k = 0; k < num; ++k) {
      places.push_back(row);
      places.push_back(columns[k]);
      entries.push_back(values[k]);
    }
    check_petsc(MatRestoreRow(A, row, &num, &columns, &values));
  }
  places = join_over_ranks(places);
  entries = join_over_ranks(entries);
  std::vector<Eigen::Triplet<double>> all;
  for (std::size_t i = 0; i < entries.size(); ++i) all.emplace_back(places[2 * i], places[2 * i + 1], entries[i]);
  Eigen::SparseMatrix<double> whole(kRows, kRows);
  whole.setFromTriplets(all.begin(), all.end());
  return whole;
}

TEST_P(SubdomainsOf, CountAsAFactorOfTheWholeDoes) {
  const PetscMat A = make_grid(4.5), B = make_grid(2, 3);
  mark(A.get());
  const Eigen::SparseMatrix<double> K = gather_matrix(A.get()), M = gather_matrix(B.get());
  for (const double mu : {0.0, 0.3, 0.9, 20.0}) {
    const auto count = count_negative_by_fronts(A.get(), -mu, B.get(), 0);
    if (!count) continue;  // a pivot was small
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(K - mu * M);
    ASSERT_EQ(factor.info(), Eigen::Success);
    EXPECT_EQ(*count, (factor.vectorD().array() < 0).count()) << mu;
  }
  EXPECT_EQ(count_negative_by_fronts(A.get(), 0, B.get(), 0), 0);
}

/// A keeps its parts for one B alone.
TEST_P(SubdomainsOf, AreKeptForOneOther) {
  const PetscMat A = make_grid(4.5), B = make_grid(2, 3), C = make_grid(2, 90);
  mark(A.get());
  const auto first = find_subdomains(A.get(), B.get(), 0), again = find_subdomains(A.get(), B.get(), 0),
             other = find_subdomains(A.get(), C.get(), 0);
  ASSERT_EQ(first.has_value(), initialize_petsc().size > 1);
  if (!first) return;
  EXPECT_EQ(again->inner, first->inner);
  EXPECT_EQ(again->between, first->between);
  EXPECT_EQ(again->num_shared, first->num_shared);
  ASSERT_TRUE(other.has_value());
  EXPECT_NE(other->between, first->between);
  const MatrixXd X = MatrixXd::Random(first->num_own(), 3);
  EXPECT_EQ(first->from_rows(first->to_rows(X)), X);
}

TEST(Subdomains, TellWhatIsNotDefinite) {
  const PetscMat A = make_grid(3);
  if (const auto domains = find_subdomains(A.get(), A.get(), 0))
    EXPECT_FALSE(SubdomainFactor(A.get(), *domains).is_definite());
}

TEST(Subdomains, LeaveSmallMatricesWhole) {
  const PetscMat A = make_grid(4.5);
  EXPECT_FALSE(find_subdomains(A.get(), A.get(), kRows + 1));
}

}  // namespace
}  // namespace bough::fe
