// Eigenvalues and zeros of models whose answer is known.
#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <random>

#include "base/diagnostic.hpp"
#include "solver/statespace/blocks.hpp"
#include "solver/statespace/poles.hpp"
#include "solver/statespace/zeros.hpp"

namespace bough::statespace {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd make_random(int rows, int cols, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, cols, [&] { return normal(engine); });
}

TEST(Blocks, EachDependsOnThoseBeforeIt) {
  MatrixXd a = MatrixXd::Zero(5, 5);
  a(0, 3) = a(3, 0) = 1;  // {0, 3}
  a(0, 1) = 1;            // needs {1}
  a(2, 4) = a(4, 2) = a(4, 0) = 1;
  const auto blocks = find_blocks(a);
  ASSERT_EQ(blocks.size(), 3u);
  EXPECT_EQ(blocks[0], (std::vector<int>{1}));
  EXPECT_EQ(blocks[1], (std::vector<int>{0, 3}));
  EXPECT_EQ(blocks[2], (std::vector<int>{2, 4}));
}

TEST(Blocks, BalancingKeepsTheEigenvalues) {
  MatrixXd a(2, 2);
  a << 0, 1, -1e10, 0;
  const VectorXd d = balance(a);
  EXPECT_NEAR(std::abs(a(0, 1)) / std::abs(a(1, 0)), 1, 3.1);
  EXPECT_DOUBLE_EQ(a(0, 1) * a(1, 0), -1e10);
  EXPECT_GT(d[1] / d[0], 1e4);
}

TEST(Poles, OfOscillatorsAndOfAFloatingBody) {
  // Two oscillators of 3 and 40 rad/s with 1 and 5 % damping, and a free translation that drives the first.
  MatrixXd A = MatrixXd::Zero(6, 6);
  A.topRightCorner(3, 3).setIdentity();
  A(3, 0) = -9, A(3, 3) = -2 * 0.01 * 3;
  A(4, 1) = -1600, A(4, 4) = -2 * 0.05 * 40;
  A(3, 5) = 0.7;
  const auto poles = calc_poles(A, {"a:eta1", "a:eta2", "h:1", "a:eta1_dot", "a:eta2_dot", "h:1_dot"});
  ASSERT_EQ(poles.size(), 6);
  EXPECT_EQ(poles.real[0], 0);
  EXPECT_EQ(poles.imag[1], 0);
  EXPECT_EQ(poles.mode[0], "h:1");
  EXPECT_NEAR(poles.frequency_hz[2] * 2 * M_PI, 3, 1e-13);
  EXPECT_NEAR(poles.damping[3], 0.01, 1e-13);
  EXPECT_GT(poles.imag[2], 0);
  EXPECT_EQ(poles.imag[3], -poles.imag[2]);
  EXPECT_EQ(poles.mode[2], "a:eta1");
  EXPECT_NEAR(poles.frequency_hz[5] * 2 * M_PI, 40, 1e-12);
  EXPECT_NEAR(poles.damping[4], 0.05, 1e-13);
  EXPECT_EQ(poles.mode[5], "a:eta2");
}

// A pole that rounding of the largest makes is zero: neither stable nor not.
TEST(Poles, OfTheOriginHaveNoDamping) {
  const auto poles = calc_poles(Eigen::Vector3d(1e-9, -1e-3, -2e3).asDiagonal(), {"a", "b", "c"});
  EXPECT_EQ(poles.damping[0], 0);
  EXPECT_EQ(poles.damping[1], 1);
  EXPECT_EQ(poles.damping[2], 1);
}

TEST(Poles, ErrorsBoundWhatEntriesAreOffBy) {
  // A soft oscillator between stiff ones, in units that are far apart.
  Eigen::Matrix3d K;
  K << 2e8, -1e8, 3e3, -1e8, 1.5e8, -2e3, 3e3, -2e3, 1.0;
  MatrixXd A = MatrixXd::Zero(6, 6);
  A.topRightCorner(3, 3).setIdentity();
  A.bottomLeftCorner(3, 3) = -K;
  A.bottomRightCorner(3, 3) = -1e-3 * Eigen::Matrix3d::Identity();
  MatrixXd error = MatrixXd::Zero(6, 6);
  error.bottomLeftCorner(3, 3) = 1e-9 * K.cwiseAbs();
  const std::vector<std::string> names{"a", "b", "c", "a_dot", "b_dot", "c_dot"};
  const auto poles = statespace::calc_poles(A, names, error);
  ASSERT_EQ(poles.error.size(), 6);
  EXPECT_EQ(statespace::calc_poles(A, names).error.size(), 0);
  std::srand(7);
  VectorXd most = VectorXd::Zero(6);
  for (int trial = 0; trial < 200; ++trial) {
    const MatrixXd sign = MatrixXd::Random(6, 6).cwiseSign();
    const auto other = statespace::calc_poles(A + error.cwiseProduct(sign), names);
    for (Eigen::Index i = 0; i < 6; ++i)
      most[i] = std::max(most[i], std::hypot(other.real[i] - poles.real[i], other.imag[i] - poles.imag[i]));
  }
  for (Eigen::Index i = 0; i < 6; ++i) {
    EXPECT_LE(most[i], 1.01 * poles.error[i]) << i;
    EXPECT_GE(most[i], 0.3 * poles.error[i]) << i;
  }
}

TEST(Poles, NoneOfAMatrixThatIsNotFinite) {
  MatrixXd A(2, 2);
  A << 0, 1, -std::numeric_limits<double>::infinity(), 0;
  try {
    calc_poles(A, {"a:eta1", "a:eta1_dot"});
    FAIL();
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.items()[0].id, "linear.no-poles");
  }
}

TEST(Zeros, OfATransferFunction) {
  // (s + 2)(s² + 0.2 s + 25) / (s + 1)(s + 3)(s² + s + 7)(s + 10), in controller form, states scaled by 1e6 up and
  // down.
  const double den[] = {210, 331, 177, 67, 15, 1};  // ascending
  const double num[] = {50, 25.4, 2.2, 1};
  MatrixXd A = MatrixXd::Zero(5, 5), B = MatrixXd::Zero(5, 1), C = MatrixXd::Zero(1, 5);
  for (int i = 0; i < 4; ++i) A(i, i + 1) = 1;
  for (int i = 0; i < 5; ++i) A(4, i) = -den[i];
  B(4, 0) = 1;
  for (int i = 0; i < 4; ++i) C(0, i) = num[i];
  VectorXd scale(5);
  scale << 1e6, 1, 1e-6, 1e3, 1;
  const MatrixXd As = scale.asDiagonal() * A * scale.cwiseInverse().asDiagonal();
  const auto zeros =
      calc_zeros(As, scale.asDiagonal() * B, C * scale.cwiseInverse().asDiagonal(), MatrixXd::Zero(1, 1));
  ASSERT_EQ(zeros.size(), 3);
  EXPECT_NEAR(std::abs(zeros[0] - std::complex<double>(-2, 0)), 0, 1e-9);
  EXPECT_NEAR(std::abs(zeros[1] - std::complex<double>(-0.1, std::sqrt(24.99))), 0, 1e-9);
  EXPECT_NEAR(std::abs(zeros[2] - std::conj(zeros[1])), 0, 1e-9);
}

TEST(Zeros, MakeTheSystemMatrixSingular) {
  for (unsigned seed = 1; seed < 6; ++seed) {
    const int n = 7, m = 2;
    const MatrixXd A = make_random(n, n, seed), B = make_random(n, m, seed + 50), C = make_random(m, n, seed + 90);
    MatrixXd D = MatrixXd::Zero(m, m);
    if (seed % 2 == 0) D(0, 0) = 1;  // of rank one
    const auto zeros = calc_zeros(A, B, C, D);
    EXPECT_EQ(zeros.size(), seed % 2 == 0 ? n - 1 : n - m);
    for (const auto& s : zeros) {
      Eigen::MatrixXcd pencil(n + m, n + m);
      pencil << A.cast<std::complex<double>>() - s * Eigen::MatrixXcd::Identity(n, n), B, C, D;
      const auto singular = Eigen::JacobiSVD<Eigen::MatrixXcd>(pencil).singularValues();
      EXPECT_LT(singular[n + m - 1], 1e-10 * singular[0]);
    }
  }
}

TEST(Zeros, NoneWhereTheInputIsSeenAtOnceOrNever) {
  MatrixXd A(2, 2), B(2, 1), C(1, 2);
  A << 0, 1, -4, 0;
  B << 0, 1;
  C << 1, 0;
  EXPECT_EQ(calc_zeros(A, B, C, MatrixXd::Zero(1, 1)).size(), 0);
  EXPECT_EQ(calc_zeros(A, MatrixXd::Zero(2, 1), C, MatrixXd::Zero(1, 1)).size(), 0);
  // With the force on the mass itself measured, the pole at ±2i is answered by zeros at 0.
  C << -4, 0;
  const auto zeros = calc_zeros(A, B, C, MatrixXd::Ones(1, 1));
  ASSERT_EQ(zeros.size(), 2);
  EXPECT_NEAR(std::abs(zeros[0]), 0, 1e-7);
}

}  // namespace
}  // namespace bough::statespace
