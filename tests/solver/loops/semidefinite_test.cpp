// The sparse semidefinite factor against the pseudo-inverse of the scaled matrix.
#include "solver/loops/semidefinite.hpp"

#include <gtest/gtest.h>

#include "tests/solver/support/models.hpp"

namespace bough::solver::testing {
namespace {

/// Blocks of 1 to 4 rows; A = B Bᵀ with columns of B on one or two blocks that meet, some rows of B repeated.
struct Case {
  std::vector<int> sizes, first;
  std::vector<std::pair<int, int>> meets;
  MatrixXd A;
};

Case make_case(unsigned seed, bool is_tree) {
  Random random(seed);
  Case c;
  int rows = 0;
  const int n = 9;
  for (int i = 0; i < n; ++i) {
    c.sizes.push_back(random.integer(1, 4));
    c.first.push_back(rows);
    rows += c.sizes.back();
  }
  for (int i = 1; i < n; ++i) c.meets.emplace_back(is_tree ? random.integer(0, i - 1) : i - 1, i);
  if (!is_tree) c.meets.emplace_back(0, n - 1);  // a ring
  c.A = MatrixXd::Zero(rows, rows);
  const auto add = [&](const std::vector<int>& blocks, int columns) {
    MatrixXd B = MatrixXd::Zero(rows, columns);
    for (const int i : blocks) {
      for (int k = 0; k < c.sizes[static_cast<size_t>(i)]; ++k) {
        const int row = c.first[static_cast<size_t>(i)] + k;
        B.row(row) = random.vector_n(columns).transpose();
        // The last of four rows says what the first two say.
        if (k == 3) B.row(row) = B.row(row - 3) - 2 * B.row(row - 2);
      }
    }
    c.A += B * B.transpose();
  };
  for (const auto& [i, j] : c.meets) add({i, j}, 1);
  for (int i = 0; i < n; ++i) {
    if (i % 3 != 0) add({i}, 2);
  }
  return c;
}

TEST(Semidefinite, SparseSolvesByLeastNorm) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const Case c = make_case(seed, seed % 2 == 0);
    SemidefiniteFactor factor;
    factor.arrange(c.sizes, c.meets);
    for (auto& pair : factor.pairs)
      pair.A = c.A.block(c.first[static_cast<size_t>(pair.i)], c.first[static_cast<size_t>(pair.j)],
                         c.sizes[static_cast<size_t>(pair.i)], c.sizes[static_cast<size_t>(pair.j)]);
    factor.compute();
    Random random(seed + 100);
    const VectorXd b = c.A * random.vector_n(static_cast<int>(c.A.rows()));
    VectorXd x = b;
    factor.solve(x);
    EXPECT_LT((c.A * x - b).norm(), 1e-9 * b.norm()) << seed;
    const VectorXd s = c.A.diagonal().cwiseSqrt();
    const MatrixXd scaled = s.cwiseInverse().asDiagonal() * c.A * s.cwiseInverse().asDiagonal();
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> cod;
    cod.setThreshold(1e-9);
    cod.compute(scaled);
    EXPECT_EQ(factor.rank(), cod.rank()) << seed;
    const VectorXd expected =
        s.cwiseInverse().asDiagonal() * VectorXd(cod.solve(VectorXd(s.cwiseInverse().asDiagonal() * b)));
    EXPECT_LT((x - expected).norm(), 1e-7 * expected.norm()) << seed;
  }
}

// A chain of a thousand blocks has fronts of two of them.
TEST(Semidefinite, AChainStaysAChain) {
  std::vector<std::pair<int, int>> meets;
  for (int i = 1; i < 1000; ++i) meets.emplace_back(i - 1, i);
  SemidefiniteFactor factor;
  factor.arrange(std::vector<int>(1000, 2), meets);
  EXPECT_EQ(factor.num_fronts(), 999);
  EXPECT_EQ(factor.pairs.size(), 1999u);
}

}  // namespace
}  // namespace bough::solver::testing
