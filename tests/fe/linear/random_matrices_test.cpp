/// Random matrices: solutions, counts and residuals against dense algebra, in any units of the unknowns.
#include <gtest/gtest.h>

#include <random>

#include <Eigen/Eigenvalues>

#include "fe/linear/complex_factor.hpp"
#include "fe/linear/factor.hpp"
#include "fe/linear/inertia.hpp"
#include "fe/linear/residual.hpp"
#include "tests/support/threads.hpp"

namespace bough::linear {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Springs between random neighbours and a few to ground: positive definite, with a condition of about 1e6.
Sparse make_springs(int n, std::mt19937& random) {
  std::uniform_real_distribution<double> decade(-2, 2);
  std::vector<Eigen::Triplet<double>> entries;
  const auto connect = [&](int i, int j) {
    const double k = std::pow(10, decade(random));
    for (const auto& [row, column, sign] : {std::tuple{i, i, 1}, {j, j, 1}, {i, j, -1}, {j, i, -1}})
      entries.emplace_back(row, column, sign * k);
  };
  for (int i = 1; i < n; ++i) {
    connect(i, i - 1);
    connect(i, static_cast<int>(random() % static_cast<unsigned>(i)));
  }
  for (int i = 0; i < n; i += 7) entries.emplace_back(i, i, 0.1);
  Sparse K(n, n);
  K.setFromTriplets(entries.begin(), entries.end());
  K.prune(0.0);
  return K;
}

MatrixXd make_random(int rows, int columns, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  return MatrixXd::NullaryExpr(rows, columns, [&] { return uniform(random); });
}

RowKinds make_kinds(int n, std::mt19937& random) {
  RowKinds kinds(static_cast<std::size_t>(n));
  for (RowKind& kind : kinds) kind = static_cast<RowKind>(random() % 3);
  return kinds;
}

/// A unit for the rows of each kind; powers of two, so that scaled matrices have the same digits.
VectorXd make_units(const RowKinds& kinds, std::mt19937& random) {
  double unit[3];
  for (double& one : unit) one = std::ldexp(1.0, static_cast<int>(random() % 60) - 30);
  VectorXd units(static_cast<Eigen::Index>(kinds.size()));
  for (std::size_t i = 0; i < kinds.size(); ++i)
    units(static_cast<Eigen::Index>(i)) = unit[static_cast<std::size_t>(kinds[i])];
  return units;
}

class RandomMatrices : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Threads, RandomMatrices, ::testing::Values(1, 2));

TEST_P(RandomMatrices, AreSolvedInAnyUnits) {
  const test::Threads threads(GetParam());
  for (unsigned seed = 1; seed <= 12; ++seed) {
    std::mt19937 random(seed);
    const int n = 40 + static_cast<int>(random() % 400);
    const Sparse K = make_springs(n, random);
    const RowKinds kinds = make_kinds(n, random);
    const VectorXd s = make_units(kinds, random);
    const Sparse scaled = s.asDiagonal() * K * s.asDiagonal();
    const MatrixXd B = make_random(n, 3, random), exact = MatrixXd(K).ldlt().solve(B);
    const SymmetricMatrix one(K), other(scaled);
    const MatrixXd X = SymmetricFactor(one, false).solve(B);
    EXPECT_LT((X - exact).norm(), 1e-9 * exact.norm()) << seed;
    const MatrixXd SB = s.asDiagonal() * B;
    const MatrixXd Y = SymmetricFactor(other, false, FactorMethod::Pivoting).solve(SB);
    EXPECT_LT((s.asDiagonal() * Y - exact).norm(), 1e-9 * exact.norm()) << seed;
    EXPECT_LT(calc_static_residuals(get_diagonal(other), Y, multiply(other, Y), SB, kinds).maxCoeff(), 1e-10) << seed;
    // A residual is that of the equations, not of their units.
    const MatrixXd rough = X + 1e-4 * make_random(n, 3, random);
    const VectorXd a = calc_static_residuals(get_diagonal(one), rough, multiply(one, rough), B, kinds);
    const MatrixXd rough_scaled = s.cwiseInverse().asDiagonal() * rough;
    const VectorXd b =
        calc_static_residuals(get_diagonal(other), rough_scaled, multiply(other, rough_scaled), SB, kinds);
    EXPECT_LT((a - b).norm(), 1e-12 * a.norm()) << seed;
  }
}

TEST_P(RandomMatrices, HaveAsManyEigenvaluesBelowAnyNumber) {
  const test::Threads threads(GetParam());
  for (unsigned seed = 1; seed <= 6; ++seed) {
    std::mt19937 random(seed);
    const Sparse K = make_springs(30 + static_cast<int>(random() % 250), random);
    const auto n = static_cast<int>(K.rows());
    const VectorXd mass = make_random(n, 1, random).cwiseAbs() + VectorXd::Constant(n, 0.1);
    Sparse M(n, n);
    M = Sparse(mass.asDiagonal());
    const VectorXd values =
        Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(MatrixXd(K), MatrixXd(M), Eigen::EigenvaluesOnly)
            .eigenvalues();
    const SymmetricMatrix A(K), B(M);
    for (const int below : {1, n / 3, n - 1}) {
      if (values(below) - values(below - 1) < 1e-9 * values(below)) continue;
      EXPECT_EQ(count_eigenvalues_below(A, B, 0.5 * (values(below - 1) + values(below))), below) << seed;
    }
  }
}

TEST(RandomSums, WithAPartOfLowRankAndAnImaginaryPartAreSolved) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    std::mt19937 random(seed);
    const int n = 60;
    const Sparse K = make_springs(n, random), C = make_springs(n, random);
    const MatrixXd D = make_random(n, 2, random), W = make_random(2, 2, random);
    const SymmetricMatrix A = SymmetricMatrix(K).with_low_rank(make_form_part(D.sparseView(), W + W.transpose()));
    const SymmetricMatrix B(C);
    const MatrixXd dense = MatrixXd(K) + D * (W + W.transpose()) * D.transpose();
    const MatrixXd F = make_random(n, 2, random);
    EXPECT_LT((multiply(A, SymmetricFactor(A, false).solve(F)) - F).norm(), 1e-8 * F.norm()) << seed;
    const Eigen::MatrixXcd sides = F.cast<std::complex<double>>();
    const Eigen::MatrixXcd X = ComplexFactor(A, B).solve(sides);
    const Eigen::MatrixXcd all = dense.cast<std::complex<double>>() + std::complex<double>(0, 1) * MatrixXd(C);
    EXPECT_LT((all * X - sides).norm(), 1e-10 * sides.norm()) << seed;
  }
}

}  // namespace
}  // namespace bough::linear
