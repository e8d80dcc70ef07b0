// The coefficients of the pairs against the order conditions of Butcher's rooted trees.
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

/// Checks the conditions of the pair up to its order; the next order must fail, and so must that of the embedded one.
void check_order_conditions(const ButcherTable& table) {
  EXPECT_LT((table.A.rowwise().sum() - table.c).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_TRUE(table.A.triangularView<Eigen::Upper>().toDenseMatrix().isZero(0));
  const auto trees = make_trees(table.A, table.q + 1);
  const std::vector<size_t> count = {0, 1, 1, 2, 4, 9, 20, 48, 115, 286};
  double beyond = 0, embedded_beyond = 0;
  for (int order = 1; order <= table.q + 1; ++order) {
    EXPECT_EQ(trees[static_cast<size_t>(order)].size(), count[static_cast<size_t>(order)]);
    for (const auto& tree : trees[static_cast<size_t>(order)]) {
      const double error = std::abs(table.b.dot(tree.stages) - 1 / tree.density);
      const double embedded = std::abs(table.d.dot(tree.stages) - 1 / tree.density);
      if (order <= table.q)
        EXPECT_LT(error, 1e-14) << order;
      else
        beyond = std::max(beyond, error);
      if (order < table.q) EXPECT_LT(embedded, 1e-14) << order;
      if (order == table.q) embedded_beyond = std::max(embedded_beyond, embedded);
    }
  }
  EXPECT_GT(beyond, 1e-8);
  EXPECT_GT(embedded_beyond, 1e-8);
}

TEST(DormandPrince, PairOfOrders5And4) {
  const ButcherTable table = make_dormand_prince_54();
  check_order_conditions(table);
  EXPECT_EQ(VectorXd(table.A.row(6)), table.b);  // its last stage is the first of the next step
}

TEST(DormandPrince, PairOfOrders8And7) {
  const ButcherTable table = make_dormand_prince_87();
  check_order_conditions(table);
  const VectorXd difference = (table.b - table.d).cwiseAbs();
  EXPECT_GT(difference.tail(8).minCoeff(), 0);  // the middle of the step counts
}

}  // namespace
}  // namespace bough::solver
