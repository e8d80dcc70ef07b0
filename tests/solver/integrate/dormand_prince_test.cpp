// The coefficients of the pair of orders 8 and 7 against the order conditions of Butcher's rooted trees.
#include "solver/integrate/dormand_prince.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

namespace bough::solver {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A rooted tree: its order, its density γ, and what the stages weigh of it.
struct RootedTree {
  int order = 1;
  double density = 1;
  VectorXd stages;
};

/// Every rooted tree of each order up to `most`: 1, 1, 2, 4, 9, 20, 48, 115, ...
std::vector<std::vector<RootedTree>> make_trees(const MatrixXd& A, int most) {
  std::vector<std::vector<RootedTree>> trees(static_cast<size_t>(most) + 1);
  std::vector<const RootedTree*> below;
  std::vector<RootedTree> all;  // in the order made, so that a multiset of branches is taken once
  all.reserve(1000);
  for (int order = 1; order <= most; ++order) {
    const std::size_t known = all.size();
    const auto grow = [&](const auto& self, int left, std::size_t last, const VectorXd& product,
                          double density) -> void {
      if (left == 0) {
        RootedTree tree{order, density * order, product};
        trees[static_cast<size_t>(order)].push_back(tree);
        return;
      }
      for (std::size_t i = 0; i <= std::min(last, known - 1) && known > 0; ++i) {
        if (all[i].order > left) continue;
        self(self, left - all[i].order, i, product.cwiseProduct(A * all[i].stages), density * all[i].density);
      }
    };
    grow(grow, order - 1, known, VectorXd::Ones(A.rows()), 1);
    for (const auto& tree : trees[static_cast<size_t>(order)]) all.push_back(tree);
  }
  return trees;
}

TEST(DormandPrince87, MeetsItsOrderConditions) {
  const ButcherTable table = make_dormand_prince_87();
  const int s = table->stages;
  MatrixXd A(s, s);
  VectorXd b(s), d(s), c(s);
  for (int i = 0; i < s; ++i) {
    b[i] = table->b[i];
    d[i] = table->d[i];
    c[i] = table->c[i];
    for (int j = 0; j < s; ++j) A(i, j) = table->A[i][j];
  }
  EXPECT_LT((A.rowwise().sum() - c).cwiseAbs().maxCoeff(), 1e-14);
  const auto trees = make_trees(A, 9);
  const std::vector<size_t> count = {0, 1, 1, 2, 4, 9, 20, 48, 115, 286};
  double ninth = 0, eighth = 0;
  for (int order = 1; order <= 9; ++order) {
    EXPECT_EQ(trees[static_cast<size_t>(order)].size(), count[static_cast<size_t>(order)]);
    for (const auto& tree : trees[static_cast<size_t>(order)]) {
      const double error = std::abs(b.dot(tree.stages) - 1 / tree.density);
      const double embedded = std::abs(d.dot(tree.stages) - 1 / tree.density);
      if (order <= 8) EXPECT_LT(error, 1e-14) << order;
      if (order <= 7) EXPECT_LT(embedded, 1e-14) << order;
      if (order == 8) eighth = std::max(eighth, embedded);
      if (order == 9) ninth = std::max(ninth, error);
    }
  }
  EXPECT_GT(ninth, 1e-8);
  EXPECT_GT(eighth, 1e-8);
  EXPECT_GT((b - d).cwiseAbs().minCoeff() == 0 ? (b - d).cwiseAbs().tail(8).minCoeff() : 1, 0);  // the middle counts
}

}  // namespace
}  // namespace bough::solver
