/// Sums of weighted products; that each element fills them rightly is seen wherever SmallModel makes a K_G.
#include "fe/elements/geometric_projection.hpp"

#include <random>

#include <gtest/gtest.h>

namespace bough::fe {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// More terms than are held at once, and one element with more than that.
TEST(GeometricProjection, SumsWeightedProducts) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto make = [&](Eigen::Index rows, Eigen::Index cols) -> MatrixXd {
    return MatrixXd::NullaryExpr(rows, cols, [&] { return normal(random); });
  };
  const Eigen::Index n = 5, num_loads = 3;
  GeometricProjection sums(n, num_loads);
  std::vector<MatrixXd> expected(3, MatrixXd::Zero(n, n));
  for (const Eigen::Index num_terms : {7, 300, 400, 900, 2}) {
    auto terms = sums.add_terms(num_terms);
    terms.weights = make(num_terms, num_loads);
    for (Eigen::Index k = 0; k < num_terms; ++k) {
      const VectorXd a = make(n, 1), b = make(n, 1);
      const MatrixXd Phi = make(4, n), half = make(4, 4), K = half + half.transpose();
      add_square(a, 2, terms.products.col(k));
      add_cross(a, b, -3, terms.products.col(k));
      add_projection(K, Phi, terms.products.col(k));
      const MatrixXd P =
          2 * a * a.transpose() - 3 * (a * b.transpose() + b * a.transpose()) + Phi.transpose() * K * Phi;
      for (std::size_t c = 0; c < 3; ++c) expected[c] += terms.weights(k, static_cast<Eigen::Index>(c)) * P;
    }
  }
  const auto result = sums.finish();
  ASSERT_EQ(result.size(), 3u);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_LT((result[c] - expected[c]).norm(), 1e-12 * expected[c].norm());
}

}  // namespace
}  // namespace bough::fe
