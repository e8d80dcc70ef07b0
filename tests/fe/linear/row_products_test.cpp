#include "fe/linear/row_products.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fe/linear/wide.hpp"

namespace bough::linear {
namespace {

using Eigen::MatrixXd;

/// A of whole numbers, so that every sum is known to the last digit.
class RowProducts : public testing::TestWithParam<int> {
 protected:
  static constexpr int kRows = 200, kTerms = 30;
  RowProducts() : X(kRows, GetParam()), B(kRows, GetParam()) {
    std::mt19937_64 random(7);
    std::uniform_int_distribution<long long> number(-(1LL << 40), 1LL << 40), place(0, kRows - 1);
    for (double& x : X.reshaped()) x = static_cast<double>(number(random));
    for (int row = 0; row < kRows; ++row) {
      for (int k = 0; k < kTerms; ++k) {
        column.push_back(static_cast<int>(place(random)));
        value.push_back(static_cast<double>(number(random)));
      }
      start.push_back(static_cast<int>(column.size()));
    }
    for (int c = 0; c < B.cols(); ++c)
      for (int row = 0; row < kRows; ++row) B(row, c) = static_cast<double>(multiply_exactly(row, c));
  }
  __int128 multiply_exactly(int row, int c) const {
    __int128 sum = 0;
    for (int k = start[row]; k < start[row + 1]; ++k)
      sum += static_cast<__int128>(value[k]) * static_cast<__int128>(X(column[k], c));
    return sum;
  }
  MatrixRows rows() const { return {start.data(), column.data(), value.data()}; }

  std::vector<PetscInt> start{0}, column;
  std::vector<double> value;
  MatrixXd X, B;
};

TEST_P(RowProducts, ProductsOfAnyNumberOfColumns) {
  const MatrixXd Y = multiply_rows(rows(), X);
  ASSERT_EQ(Y.cols(), X.cols());
  for (int c = 0; c < X.cols(); ++c)
    for (int row = 0; row < kRows; ++row) EXPECT_NEAR(Y(row, c), B(row, c), 1e-15 * std::ldexp(kTerms, 80));
}

/// B is the product rounded: the difference has none of its digits, which one precision would not see.
TEST_P(RowProducts, WhatCancelsKeepsItsDigits) {
  const MatrixXd R = subtract_precisely(rows(), X, B);
  ASSERT_EQ(R.cols(), X.cols());
#ifdef BOUGH_WIDE
  const bool is_precise = has_wide();
#else
  const bool is_precise = false;
#endif
  double largest = 0;
  for (int c = 0; c < X.cols(); ++c)
    for (int row = 0; row < kRows; ++row) {
      const auto exact = static_cast<double>(static_cast<__int128>(B(row, c)) - multiply_exactly(row, c));
      largest = std::max(largest, std::abs(exact));
      EXPECT_NEAR(R(row, c), exact, is_precise ? 1e-12 * std::abs(exact) : std::ldexp(kTerms, 83 - 64));
    }
  EXPECT_GT(largest, 1e8);
}

INSTANTIATE_TEST_SUITE_P(Columns, RowProducts, testing::Values(1, 3, 4, 7));

}  // namespace
}  // namespace bough::linear
