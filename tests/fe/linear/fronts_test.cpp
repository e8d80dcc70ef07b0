/// Negative eigenvalues counted front by front, against dense algebra.
#include "fe/linear/fronts.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "fe/linear/factor.hpp"
#include "fe/linear/ordering.hpp"
#include "tests/fe/linear/paired_rows.hpp"
#include "tests/support/threads.hpp"

namespace bough::linear {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kLong = 60, kWide = 4, kRows = 2 * kLong * kWide;

int row_of(int x, int y, int d) { return 2 * (x * kWide + y) + d; }

/// A strip of nodes of two rows each, `stiffness` between neighbours, `inertia` in the nodes.
SymmetricMatrix make_strip(double stiffness, double inertia, double across = 0) {
  PetscMat A;
  check_petsc(MatCreateSeqAIJ(PETSC_COMM_SELF, kRows, kRows, 30, nullptr, A.out()));
  const auto add_to = [&](int i, int j, double value) { check_petsc(MatSetValue(A.get(), i, j, value, ADD_VALUES)); };
  const auto connect = [&](int i, int j, double k) {
    add_to(i, i, k);
    add_to(j, j, k);
    add_to(i, j, -k);
    add_to(j, i, -k);
  };
  for (int x = 0; x < kLong; ++x)
    for (int y = 0; y < kWide; ++y)
      for (int d = 0; d < 2; ++d) {
        const int row = row_of(x, y, d);
        add_to(row, row, inertia * (1 + 0.01 * x + 0.1 * y + 0.03 * d) + (x == 0 ? stiffness : 0));
        if (d == 0) connect(row, row + 1, 0.3 * stiffness);
        if (x + 1 < kLong) connect(row, row_of(x + 1, y, d), stiffness);
        if (y + 1 < kWide) connect(row, row_of(x, y + 1, d), 0.7 * stiffness);
        if (x + 1 < kLong && across != 0) connect(row, row_of(x + 1, y, 1 - d), across);
      }
  return assemble_in_pairs(std::move(A), kRows);
}

MatrixXd to_dense(const SymmetricMatrix& A) { return multiply(A, MatrixXd::Identity(kRows, kRows)); }

class FrontsOn : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (initialize_petsc().size > 1) GTEST_SKIP() << "several processes count together";
  }

 private:
  bough::test::Threads threads_{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Threads, FrontsOn, ::testing::Values(1, 2));

/// All along the spectrum, where more and more fronts are indefinite. B couples rows that A does not,
/// of nodes that A couples.
TEST_P(FrontsOn, CountAsTheEigenvaluesDo) {
  const SymmetricMatrix A = make_strip(1, 0), B = make_strip(0.05, 1, 0.02);
  const VectorXd values =
      Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(to_dense(A), to_dense(B), Eigen::EigenvaluesOnly)
          .eigenvalues();
  int num_counted = 0, num_tried = 0;
  for (Eigen::Index i = 0; i + 1 < values.size(); i += i < 40 ? 1 : 37) {
    const double mu = 0.5 * (values(i) + values(i + 1));
    if (values(i + 1) - values(i) < 1e-9 * mu) continue;
    ++num_tried;
    const auto count = count_negative_by_fronts(A, -mu, B, 0);
    if (!count) continue;  // a front was close to an eigenvalue of its own
    ++num_counted;
    EXPECT_EQ(*count, i + 1) << mu;
  }
  EXPECT_GT(num_tried, 40);
  EXPECT_GT(num_counted, num_tried * 8 / 10);
  EXPECT_EQ(count_negative_by_fronts(A, 0, B, 0), 0);
  EXPECT_EQ(count_negative_by_fronts(A, -1e6, B, 0), kRows);
}

/// Where a front adds far more to a row than stands on its diagonal, one that pivots freely counts.
TEST_P(FrontsOn, LeaveTinyPivotsToOthers) {
  const SymmetricMatrix A = make_strip(1, 0), B = make_strip(0, 1), weak = make_strip(1, 0);
  ASSERT_EQ(count_negative_by_fronts(A, 0, B, 0), 0);
  for (int x = 1; x < kLong; x += 2)
    for (int y = 0; y < kWide; ++y)
      for (int d = 0; d < 2; ++d)
        check_petsc(MatSetValue(weak.sparse(), row_of(x, y, d), row_of(x, y, d), 1e-12, INSERT_VALUES));
  check_petsc(MatAssemblyBegin(weak.sparse(), MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(weak.sparse(), MAT_FINAL_ASSEMBLY));
  EXPECT_FALSE(count_negative_by_fronts(weak, 0, B, 0));
}

/// B couples the ends of the strip, which A has in two parts: then one that pivots freely counts.
TEST_P(FrontsOn, TakeCoupledPartsForOne) {
  const SymmetricMatrix A = make_strip(1, 0), B = make_strip(0, 1);
  check_petsc(MatSetOption(B.sparse(), MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  for (const auto& [i, j] : {std::pair(row_of(0, 0, 0), row_of(kLong - 1, 0, 0))}) {
    check_petsc(MatSetValue(B.sparse(), i, j, 0.1, ADD_VALUES));
    check_petsc(MatSetValue(B.sparse(), j, i, 0.1, ADD_VALUES));
  }
  check_petsc(MatAssemblyBegin(B.sparse(), MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(B.sparse(), MAT_FINAL_ASSEMBLY));
  const auto count = count_negative_by_fronts(A, -0.1, B, 0);
  ASSERT_TRUE(count);
  const MatrixXd sum = to_dense(A) - 0.1 * to_dense(B);
  EXPECT_EQ(*count,
            (Eigen::SelfAdjointEigenSolver<MatrixXd>(sum, Eigen::EigenvaluesOnly).eigenvalues().array() < 0).count());
}

TEST_P(FrontsOn, AreNotForMatricesWithoutGroupsOrOfFewRows) {
  const SymmetricMatrix A = make_strip(1, 0), B = make_strip(0, 1);
  EXPECT_FALSE(count_negative_by_fronts(A, -1, B));
  const SymmetricMatrix bare = make_strip(1, 0);
  bare.row_order() = {};
  EXPECT_FALSE(count_negative_by_fronts(bare, -1, B, 0));
}

/// Definite but for a few, as a Schur complement above a few modes; any numbers; pivots that no block of rows has
/// alone.
TEST(Fronts, DenseMatricesAreCounted) {
  std::srand(3);
  for (const int n : {1, 5, 96, 97, 300}) {
    const Eigen::MatrixXd some = Eigen::MatrixXd::Random(n, n), few = Eigen::MatrixXd::Random(n, std::min(n, 3));
    Eigen::MatrixXd swapped = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i) swapped(i, n - 1 - i) = 1;
    swapped += 1e-9 * Eigen::MatrixXd::Identity(n, n);
    for (const Eigen::MatrixXd& S :
         {Eigen::MatrixXd(some * some.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n) - 5 * few * few.transpose()),
          Eigen::MatrixXd(some + some.transpose()), swapped}) {
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(S);
      Eigen::MatrixXd lower = S.triangularView<Eigen::Lower>();
      EXPECT_EQ(count_negative_of_dense(lower), (solver.eigenvalues().array() < 0).count()) << n;
    }
  }
  Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(4, 4);
  EXPECT_EQ(count_negative_of_dense(zero), -1);
}

}  // namespace
}  // namespace bough::linear
