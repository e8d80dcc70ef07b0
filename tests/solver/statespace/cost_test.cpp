// Lyapunov's equation and component cost against dense linear algebra and closed forms.
#include <gtest/gtest.h>

#include <random>

#include "base/diagnostic.hpp"
#include "solver/statespace/cost.hpp"

namespace bough::statespace {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  MatrixXd matrix(int rows, int cols) {
    return MatrixXd::NullaryExpr(rows, cols, [&] { return normal_(engine_); });
  }

 private:
  std::mt19937 engine_;
  std::normal_distribution<double> normal_;
};

/// Modes with these frequencies and ratios.
MatrixXd make_modal(const VectorXd& omega, const VectorXd& zeta) {
  const auto n = omega.size();
  MatrixXd A = MatrixXd::Zero(2 * n, 2 * n);
  A.topRightCorner(n, n).setIdentity();
  A.bottomLeftCorner(n, n).diagonal() = -omega.cwiseAbs2();
  A.bottomRightCorner(n, n).diagonal() = -2 * zeta.cwiseProduct(omega);
  return A;
}

TEST(Lyapunov, LeavesNoResidue) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    const int n = 9;
    MatrixXd A = random.matrix(n, n);
    A -= (Eigen::EigenSolver<MatrixXd>(A, false).eigenvalues().real().maxCoeff() + 0.1) * MatrixXd::Identity(n, n);
    const VectorXd scale = (3 * random.matrix(n, 1)).array().exp();  // states in unlike units
    A = MatrixXd(scale.asDiagonal() * A * scale.cwiseInverse().asDiagonal());
    const MatrixXd B = scale.asDiagonal() * random.matrix(n, 2), Q = B * B.transpose();
    const MatrixXd X = solve_lyapunov(split_stable(A), Q);
    const MatrixXd left = A * X + X * A.transpose() + Q;
    const MatrixXd back = scale.cwiseInverse().asDiagonal();
    EXPECT_LT((back * left * back).norm(), 1e-10 * (back * X * back).norm()) << seed;
  }
}

TEST(ComponentCost, OfOneModeIsTheClosedForm) {
  const double w = 7, z = 0.3;
  MatrixXd B(2, 1), C(2, 2);
  B << 0, 2;
  C << 3, 0, 0, 0.5;
  const auto cost = calc_component_cost(make_modal(VectorXd::Constant(1, w), VectorXd::Constant(1, z)), B, C);
  EXPECT_NEAR(cost.total, calc_modal_cost(w, z, 4, 9, 0.25), 1e-13 * cost.total);
  EXPECT_NEAR(cost.state.sum(), cost.total, 1e-14 * cost.total);
}

TEST(ComponentCost, PartsSumToTheWholeAndNearTheClosedFormWhereModesAreApart) {
  Random random(5);
  const int n = 5;
  VectorXd omega(n), zeta = VectorXd::Constant(n, 0.003);
  omega << 2, 5, 11, 23, 47;
  const MatrixXd b = random.matrix(n, 3), c = random.matrix(4, n);
  MatrixXd B = MatrixXd::Zero(2 * n, 3), C = MatrixXd::Zero(4, 2 * n);
  B.bottomRows(n) = b;
  C.leftCols(n) = c;
  const auto cost = calc_component_cost(make_modal(omega, zeta), B, C);
  EXPECT_NEAR(cost.state.sum(), cost.total, 1e-12 * cost.total);
  for (int i = 0; i < n; ++i) {
    const double closed = calc_modal_cost(omega[i], zeta[i], b.row(i).squaredNorm(), c.col(i).squaredNorm(), 0);
    EXPECT_NEAR(cost.state[i] + cost.state[n + i], closed, 0.02 * closed + 1e-4 * cost.total) << i;
  }
}

TEST(ComponentCost, MotionsAtZeroTakeNoPart) {
  // Two modes and, coupled to their rates and to the output, a free translation.
  Random random(9);
  VectorXd omega(2), zeta(2);
  omega << 4, 9;
  zeta << 0.02, 0.01;
  MatrixXd A = MatrixXd::Zero(6, 6), B = MatrixXd::Zero(6, 1), C = MatrixXd::Zero(1, 6);
  const MatrixXd modal = make_modal(omega, zeta);
  A.topLeftCorner(4, 4) = modal;
  A(4, 5) = 1;
  A.block(5, 0, 1, 4) = random.matrix(1, 4);
  B.col(0) << 0, 0, 1, -2, 0, 3;
  C << 1, 2, 0, 0, 5, 0;
  const auto cost = calc_component_cost(A, B, C);
  EXPECT_EQ(cost.num_rigid, 2);
  // The translation that the modes force: z = x₄ - (row) A_m⁻² x_m and its rate are free of them.
  const MatrixXd row = A.block(5, 0, 1, 4), forced = row * (modal * modal).inverse();
  const MatrixXd seen = C.leftCols(4) + 5 * forced;
  const auto elastic = calc_component_cost(modal, B.topRows(4), seen);
  EXPECT_NEAR(cost.total, elastic.total, 1e-9 * elastic.total);
  EXPECT_NEAR(cost.state.sum(), cost.total, 1e-9 * cost.total);
}

TEST(ComponentCost, WithoutDampingThereIsNone) {
  const MatrixXd A = make_modal(VectorXd::Constant(1, 3), VectorXd::Zero(1));
  try {
    calc_component_cost(A, MatrixXd::Identity(2, 1), MatrixXd::Identity(1, 2));
    FAIL();
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.items()[0].id, "select.unstable");
  }
}

}  // namespace
}  // namespace bough::statespace
