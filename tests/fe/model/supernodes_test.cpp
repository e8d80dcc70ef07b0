/// Triangular solutions by supernodes against Eigen's.
#include "fe/linear/supernodes.hpp"

#include <gtest/gtest.h>

#include <vector>

// The same as compiled for a processor without wide registers, under another name.
namespace bough::narrow {
using fe::kFewSides;
using fe::kManySides;
using fe::Supernodes;
}  // namespace bough::narrow
#define BOUGH_NARROW
#define fe narrow
#include "fe/linear/supernodes.cpp"
#undef fe
#undef BOUGH_NARROW

namespace bough::fe {
namespace {

using Eigen::MatrixXd;

/// A lower triangle of 13 rows whose columns fall into supernodes of 1, 6, 2 and 4, with rows of some left out.
struct Example {
  std::vector<int> super{0, 1, 7, 9, 13}, row_at{0}, value_at{0}, row;
  std::vector<double> value;
  MatrixXd L = MatrixXd::Zero(13, 13);

  Example() {
    const std::vector<std::vector<int>> below{{3, 8}, {7, 8, 10}, {9, 12}, {}};
    double next = 0.3;
    for (int k = 0; k < 4; ++k) {
      std::vector<int> rows;
      for (int j = super[k]; j < super[k + 1]; ++j) rows.push_back(j);
      rows.insert(rows.end(), below[k].begin(), below[k].end());
      for (int j = super[k]; j < super[k + 1]; ++j)
        for (const int i : rows) {
          next = 3.9 * next * (1 - next);  // a chaotic sequence in (0, 1)
          value.push_back(i == j ? 1 + next : next - 0.5);
          if (i >= j) L(i, j) = value.back();
        }
      row.insert(row.end(), rows.begin(), rows.end());
      row_at.push_back(static_cast<int>(row.size()));
      value_at.push_back(static_cast<int>(value.size()));
    }
  }
  Supernodes get() const { return {4, super.data(), row_at.data(), value_at.data(), row.data(), value.data()}; }
};

TEST(Supernodes, AreSolvedWithForwardsAndBackwards) {
  const Example example;
  for (const auto m : {kFewSides, kManySides}) {
    const MatrixXd B = MatrixXd::Random(m, 13);
    const MatrixXd forward = example.L.triangularView<Eigen::Lower>().solve(B.transpose()).transpose();
    const MatrixXd backward = example.L.transpose().triangularView<Eigen::Upper>().solve(B.transpose()).transpose();
    MatrixXd Z = B;
    solve_lower(example.get(), Z);
    EXPECT_LT((Z - forward).cwiseAbs().maxCoeff(), 1e-12) << m;
    Z = B;
    solve_lower_transposed(example.get(), Z);
    EXPECT_LT((Z - backward).cwiseAbs().maxCoeff(), 1e-12) << m;
    // As processors without wide registers do.
    Z = B;
    narrow::solve_lower(example.get(), Z);
    EXPECT_LT((Z - forward).cwiseAbs().maxCoeff(), 1e-12) << m;
    Z = B;
    narrow::solve_lower_transposed(example.get(), Z);
    EXPECT_LT((Z - backward).cwiseAbs().maxCoeff(), 1e-12) << m;
  }
}

}  // namespace
}  // namespace bough::fe
