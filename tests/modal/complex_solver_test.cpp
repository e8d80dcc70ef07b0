#include "modal/complex/complex_solver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "base/diagnostic.hpp"
#include "fe/linear/petsc.hpp"

namespace bough::modal::complex_modes {
namespace {

constexpr int kSize = 500;
constexpr double kAlpha = 0.02, kBeta = 1e-3;

/// A chain of unit masses between unit springs with B = α M + β K; `turn`: an unsymmetric K similar to the symmetric
/// one, D K D⁻¹ with D = diag(1 + turn i / n).
QuadraticPencil make_chain(double turn) {
  linear::initialize_petsc();
  std::vector<Eigen::Triplet<Complex>> K, M;
  const auto d = [turn](int i) { return 1 + turn * i / kSize; };
  for (int i = 0; i < kSize; ++i) {
    M.emplace_back(i, i, 1);
    K.emplace_back(i, i, 2);
    if (i > 0) K.emplace_back(i, i - 1, -d(i) / d(i - 1));
    if (i + 1 < kSize) K.emplace_back(i, i + 1, -d(i) / d(i + 1));
  }
  QuadraticPencil pencil;
  pencil.K.resize(kSize, kSize);
  pencil.M = pencil.K;
  pencil.K.setFromTriplets(K.begin(), K.end());
  pencil.M.setFromTriplets(M.begin(), M.end());
  pencil.B = kAlpha * pencil.M + kBeta * pencil.K;
  pencil.is_symmetric = turn == 0;
  return pencil;
}

SolverOptions make_options(int num_modes) {
  SolverOptions options;
  options.num_modes = num_modes;
  options.shifts = {0};
  options.scale = 0.05;
  return options;
}

std::string name_unknown(Index i) { return "unknown " + std::to_string(i); }

/// ω_j = 2 sin(j π / 2 (n + 1)), λ² + (α + β ω²) λ + ω² = 0.
TEST(ComplexSolver, ChainWithProportionalDamping) {
  for (const double turn : {0.0, 3.0}) {
    const auto pencil = make_chain(turn);
    const auto pairs = solve_pencil(pencil, make_options(15), name_unknown);
    EXPECT_FALSE(pairs.is_dense);
    std::vector<Complex> oscillating;
    for (const Complex value : pairs.lambda)
      if (value.imag() > 0) oscillating.push_back(value);
    ASSERT_EQ(oscillating.size(), 15U);
    int next = 0;
    for (int j = 1; next < 15; ++j) {
      const double omega = 2 * std::sin(j * std::numbers::pi / (2 * (kSize + 1)));
      const double c = (kAlpha + kBeta * omega * omega) / 2;
      if (c >= omega) continue;
      const Complex expected(-c, std::sqrt(omega * omega - c * c));
      EXPECT_LT(std::abs(oscillating[static_cast<std::size_t>(next)] - expected), 1e-9 * std::abs(expected)) << j;
      ++next;
    }
    EXPECT_LT(pairs.residual.maxCoeff(), 1e-10);
    EXPECT_LT(pairs.biorthogonality, 1e-7);
    for (Index j = 0; j < pairs.lambda.size(); ++j) {
      const VectorXcd left = pairs.Y.col(j).transpose() * pencil.calc_matrix(pairs.lambda(j));
      EXPECT_LT(left.norm(), 1e-8 * pairs.Y.col(j).norm()) << j;
    }
  }
}

TEST(ComplexSolver, SaysWhenItDoesNotConverge) {
  auto options = make_options(40);
  options.max_restarts = 1;
  try {
    solve_pencil(make_chain(0), options, name_unknown);
    FAIL() << "one restart is not enough";
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.items().front().id, "modal.complex-convergence");
  }
}

TEST(ComplexSolver, FactorOfTransposedMatrix) {
  linear::initialize_petsc();
  std::mt19937 random(4);
  const int n = 60;
  MatrixXcd dense = MatrixXcd::Zero(n, n);
  for (int k = 0; k < 300; ++k)
    dense(random() % n, random() % n) = Complex(random() % 100, random() % 100) / 50.0 - Complex(1, 1);
  dense.diagonal().array() += 7;
  const MatrixXcd F = MatrixXcd::Constant(n, 2, Complex(1, -2));
  const linear::ComplexLu factor(dense.sparseView(), false);
  EXPECT_LT((dense * factor.solve(F) - F).norm(), 1e-12 * F.norm());
  EXPECT_LT((dense.transpose() * factor.solve(F, true) - F).norm(), 1e-12 * F.norm());
  const MatrixXcd symmetric = dense + dense.transpose();
  EXPECT_LT((symmetric * linear::ComplexLu(symmetric.sparseView(), true).solve(F) - F).norm(), 1e-12 * F.norm());
}

}  // namespace
}  // namespace bough::modal::complex_modes
