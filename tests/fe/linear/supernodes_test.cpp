/// Triangular solutions by supernodes against Eigen's.
#include "fe/linear/supernodes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

// The same as compiled for a processor without wide registers, under another name.
namespace bough::narrow {
using linear::kNarrowRhs;
using linear::kWideRhs;
using linear::Supernodes;
}  // namespace bough::narrow
#define BOUGH_NARROW
#define linear narrow
#include "fe/linear/supernodes.cpp"
#undef linear
#undef BOUGH_NARROW

namespace bough::linear {
namespace {

using Eigen::MatrixXd;

/// A lower triangle of 13 rows whose columns fall into supernodes of 1, 6, 2 and 4, with rows of some left out.
struct Example {
  std::vector<int> super{0, 1, 7, 9, 13}, row_at{0}, row;
  std::vector<double> value;
  Supernodes packed;
  MatrixXd L = MatrixXd::Zero(13, 13);

  /// `size` columns of it, packed.
  explicit Example(int size) {
    std::vector<int> value_at{0};
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
    const auto num = std::lower_bound(super.begin(), super.end(), size) - super.begin();
    packed = {static_cast<int>(num), size, super.data(), row_at.data(), row.data()};
    packed.num_values = pack_supernodes(packed, value_at.data(), value.data());
    packed.value = value.data();
  }
};

/// The first `size` columns of Z solved for, the others relieved or known, by four ways.
void expect_solutions(int size, Eigen::Index m) {
  const Example example(size);
  const int left = 13 - size;
  const MatrixXd L_pp = example.L.topLeftCorner(size, size), L_sp = example.L.bottomLeftCorner(left, size);
  const MatrixXd B = MatrixXd::Random(m, 13);
  MatrixXd forward = B, backward = B;
  forward.leftCols(size) = L_pp.triangularView<Eigen::Lower>().solve(B.leftCols(size).transpose()).transpose();
  forward.rightCols(left) -= forward.leftCols(size) * L_sp.transpose();
  const MatrixXd B_p = (B.leftCols(size) - B.rightCols(left) * L_sp).transpose();
  backward.leftCols(size) = L_pp.transpose().triangularView<Eigen::Upper>().solve(B_p).transpose();
  MatrixXd Z = B;
  solve_lower(example.packed, Z);
  EXPECT_LT((Z - forward).cwiseAbs().maxCoeff(), 1e-12) << size << " " << m;
  Z = B;
  solve_lower_transposed(example.packed, Z);
  EXPECT_LT((Z - backward).cwiseAbs().maxCoeff(), 1e-12) << size << " " << m;
  // As processors without wide registers do.
  Z = B;
  narrow::solve_lower(example.packed, Z);
  EXPECT_LT((Z - forward).cwiseAbs().maxCoeff(), 1e-12) << size << " " << m;
  Z = B;
  narrow::solve_lower_transposed(example.packed, Z);
  EXPECT_LT((Z - backward).cwiseAbs().maxCoeff(), 1e-12) << size << " " << m;
}

TEST(Supernodes, AreSolvedWithForwardsAndBackwards) {
  for (const auto m : {kNarrowRhs, kWideRhs}) expect_solutions(13, m);
}

/// Supernodes cut after the first, second, third column of a group and between groups; the rest of L is not read.
TEST(Supernodes, AreCutWhereColumnsEnd) {
  for (const auto m : {kNarrowRhs, kWideRhs})
    for (int size = 1; size < 13; ++size) expect_solutions(size, m);
}

/// Triangles without what lies above them, rows below side by side.
TEST(Supernodes, ArePackedWithoutUpperTriangles) {
  const Example example(13);
  // Columns of a supernode by rows: 1 x 3, 6 x 9, 2 x 4 and 4 x 4.
  EXPECT_EQ(example.packed.num_values, 3 + (10 + 4 * 5 + 3 + 2 * 3) + (3 + 2 * 2) + 10);
}

}  // namespace
}  // namespace bough::linear
