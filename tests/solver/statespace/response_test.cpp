// Frequency response, margins, largest gain and Hankel values against closed forms and dense linear algebra.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "solver/statespace/cost.hpp"
#include "solver/statespace/frequency_response.hpp"
#include "solver/statespace/hankel.hpp"
#include "solver/statespace/poles.hpp"
#include "solver/statespace/track.hpp"

namespace bough::statespace {
namespace {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

records::LinearModel make_model(const MatrixXd& A, const MatrixXd& B, const MatrixXd& C, const MatrixXd& D) {
  records::LinearModel m;
  m.A = A, m.B = B, m.C = C, m.D = D;
  for (int i = 0; i < A.rows(); ++i) m.states.name.push_back("x" + std::to_string(i));
  for (int i = 0; i < B.cols(); ++i) m.inputs.name.push_back("u" + std::to_string(i));
  for (int i = 0; i < C.rows(); ++i) m.outputs.name.push_back("y" + std::to_string(i));
  m.poles = calc_poles(m.A, m.states.name);
  return m;
}

/// num / den of a strictly proper transfer function, highest power first; den monic of degree n, num of n entries.
records::LinearModel make_siso(const std::vector<double>& num, const std::vector<double>& den) {
  const auto n = static_cast<Eigen::Index>(den.size()) - 1;
  MatrixXd A = MatrixXd::Zero(n, n), B = MatrixXd::Zero(n, 1), C(1, n);
  for (Eigen::Index i = 0; i + 1 < n; ++i) A(i, i + 1) = 1;
  for (Eigen::Index i = 0; i < n; ++i) {
    A(n - 1, i) = -den[static_cast<std::size_t>(n - i)];
    C(0, i) = num[static_cast<std::size_t>(n - 1 - i)];
  }
  B(n - 1, 0) = 1;
  return make_model(A, B, C, MatrixXd::Zero(1, 1));
}

MatrixXd make_random(std::mt19937& engine, int rows, int cols) {
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, cols, [&] { return normal(engine); });
}

TEST(TransferMatrix, IsTheDenseSolution) {
  std::mt19937 engine(3);
  for (const int n : {1, 2, 3, 8, 15}) {
    const VectorXd scale = (4 * make_random(engine, n, 1)).array().exp();  // states in unlike units
    const MatrixXd A = scale.asDiagonal() * make_random(engine, n, n) * scale.cwiseInverse().asDiagonal();
    const MatrixXd B = scale.asDiagonal() * make_random(engine, n, 2);
    const MatrixXd C = make_random(engine, 3, n) * scale.cwiseInverse().asDiagonal(), D = make_random(engine, 3, 2);
    const TransferMatrix transfer(A, B, C, D);
    for (const std::complex<double> s : {std::complex<double>(0, 0.3), {0, 40.0}, {-0.7, 2.0}}) {
      const MatrixXcd full = s * MatrixXcd::Identity(n, n) - A;
      const MatrixXcd states = full.fullPivLu().solve(MatrixXcd(B));
      EXPECT_LT((transfer.calc(s) - (C * states + D)).norm(), 1e-11 * (1 + (C * states).norm())) << n;
      const MatrixXd back = scale.cwiseInverse().asDiagonal();
      EXPECT_LT((back * (transfer.calc_states(s) - states)).norm(), 1e-11 * (1 + (back * states).norm())) << n;
    }
  }
}

TEST(FrequencyResponse, ResolvesAResonanceAndANotch) {
  // Poles at 10 with 1e-4 of damping, zeros at 7 with 1e-4.
  const auto m = make_siso({1, 2e-4 * 7, 49}, {1, 2 + 2e-3, 100 + 4e-3, 200});
  const auto response = calc_frequency_response(m);
  double high = 0, low = 1e300;
  for (Eigen::Index k = 0; k < response.frequency_hz.size(); ++k) {
    const double gain = std::abs(response.value[static_cast<std::size_t>(k)](0, 0));
    EXPECT_NEAR(response.singular_values(k, 0), gain, 1e-12 * gain);
    if (response.frequency_hz[k] > 1 && response.frequency_hz[k] < 2)
      high = std::max(high, gain), low = std::min(low, gain);
  }
  const std::complex<double> j(0, 1);
  const auto exact = [&](double w) {
    const auto s = j * w;
    return std::abs((s * s + 2e-4 * 7 * s + 49.0) / (s * s * s + (2 + 2e-3) * s * s + (100 + 4e-3) * s + 200.0));
  };
  EXPECT_NEAR(high, exact(10), 0.1 * exact(10));
  EXPECT_LT(low, 20 * exact(7));
  EXPECT_GT(response.frequency_hz.size(), 300);
  EXPECT_LE(response.frequency_hz.size(), 6000);
}

TEST(Margins, OfAThirdOrderLoopAreThoseOfTheClosedForm) {
  // L = k / (s (s + 1) (s + 2)): the phase is -180 at sqrt 2, where L = -k / 6.
  const double k = 2;
  const auto m = make_siso({0, 0, k}, {1, 3, 2, 0});
  const auto margins = calc_margins(m, calc_frequency_response(m));
  ASSERT_EQ(margins.gain.size(), 1u);
  EXPECT_NEAR(margins.gain[0].frequency_hz * 2 * std::numbers::pi, std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(margins.gain[0].margin, 6 / k, 1e-12);
  ASSERT_EQ(margins.phase.size(), 1u);
  // |L| = 1: w² (w² + 1) (w² + 4) = k².
  const double w = margins.phase[0].frequency_hz * 2 * std::numbers::pi;
  EXPECT_NEAR(w * w * (w * w + 1) * (w * w + 4), k * k, 1e-11);
  const double phase = std::numbers::pi / 2 - std::atan(w) - std::atan(w / 2);
  EXPECT_NEAR(margins.phase[0].margin, phase, 1e-12);
  EXPECT_NEAR(margins.phase[0].delay, phase / w, 1e-12);
  EXPECT_TRUE(margins.is_stable);
  double least = 10;
  for (double v = 0.1; v < 3; v += 1e-5) {
    const std::complex<double> s(0, v);
    least = std::min(least, std::abs(1.0 + k / (s * (s + 1.0) * (s + 2.0))));
  }
  EXPECT_NEAR(margins.distance, least, 1e-8);
  // Six times the gain: at the edge; seven times: beyond.
  EXPECT_FALSE(calc_margins(make_siso({0, 0, 7}, {1, 3, 2, 0}), calc_frequency_response(m)).is_stable);
}

TEST(Margins, ADelayOfTheMarginDestabilizes) {
  // Padé's delay of a little less and a little more than the delay margin.
  const auto m = make_siso({0, 0, 2}, {1, 3, 2, 0});
  const double delay = calc_margins(m, calc_frequency_response(m)).phase.at(0).delay;
  for (const double factor : {0.97, 1.03}) {
    const double a = 12 / (factor * delay * factor * delay), b = 6 / (factor * delay);
    // (s² - b s + a) / (s² + b s + a), twelve a over delay squared
    const auto loop = make_siso({0, 0, 2, -2 * b, 2 * a}, {1, 3 + b, 2 + 3 * b + a, 2 * b + 3 * a, 2 * a, 0});
    EXPECT_EQ(calc_margins(loop, calc_frequency_response(loop)).is_stable, factor < 1) << factor;
  }
}

/// |L| of both sides of an undamped pole is infinite: no crossing there, wherever the grid has its points.
TEST(Margins, AnUndampedPoleIsNoCrossing) {
  for (const double w : {1.0, 0.37, 6.283185307179586, 1e-3, 4e4}) {
    // L = 4 (1 + s / 10 w) / (1 + s² / w²): |L| = 1 where 16 (1 + x / 100) = (1 - x)², x = (ω / w)² > 1.
    const auto m = make_siso({0.4 * w, 4 * w * w}, {1, 0, w * w});
    const double b = 2 + 0.16, x = (b + std::sqrt(b * b + 4 * 15)) / 2;
    for (const int points : {1, 10, 300}) {
      const FrequencyRange range{0, 0, points, 6000};
      for (const auto& response :
           {calc_frequency_response(m, range), calc_frequency_response(m, {w / 20 / std::numbers::pi, 0, points, 6000}),
            calc_frequency_response(m, widen_for_loop(m, range))}) {
        const auto margins = calc_margins(m, response);
        ASSERT_EQ(margins.phase.size(), 1u) << w << " " << points;
        EXPECT_NEAR(margins.phase[0].frequency_hz * 2 * std::numbers::pi, w * std::sqrt(x), 1e-10 * w);
        EXPECT_TRUE(margins.gain.empty());
      }
    }
  }
}

/// L = k / (s² + 4) passes through -1 at ω² = 4 + k: no phase margin and no delay margin, on whichever side of the real
/// axis round-off has put it.
TEST(Margins, AtMinusOneThereIsNoDelay) {
  for (const double k : {0.7, 1.7, 3.0, 5.0, 11.3}) {
    const auto m = make_siso({0, k}, {1, 0, 4});
    const auto margins = calc_margins(m, calc_frequency_response(m));
    ASSERT_FALSE(margins.phase.empty()) << k;
    const auto& last = margins.phase.back();
    EXPECT_NEAR(last.frequency_hz * 2 * std::numbers::pi, std::sqrt(4 + k), 1e-9) << k;
    EXPECT_NEAR(last.margin, 0, 1e-9) << k;
    EXPECT_NEAR(last.delay, 0, 1e-9) << k;
  }
}

TEST(Margins, OfAnUndampedPoleBelowOneAreItsTwoCrossings) {
  // L = 0.5 (1 + 0.01 s) / (1 + s²): |L| = 1 on both sides of the pole at 1.
  const auto m = make_siso({0.005, 0.5}, {1, 0, 1});
  const auto margins = calc_margins(m, calc_frequency_response(m));
  ASSERT_EQ(margins.phase.size(), 2u);
  for (const auto& c : margins.phase) {
    const double x = std::pow(c.frequency_hz * 2 * std::numbers::pi, 2);
    EXPECT_NEAR(0.25 * (1 + 1e-4 * x), (1 - x) * (1 - x), 1e-11);
  }
}

TEST(Margins, AnUndampedPoleThatAZeroCancelsIsNone) {
  // (s² + 1) / ((s² + 1) (s² + 0.2 s + 9)) times 4 and 16: |L(i)| is 0.5 and 2.
  for (const double k : {4.0, 16.0}) {
    const auto m = make_siso({0, k, 0, k}, {1, 0.2, 10, 0.2, 9});
    const auto plain = make_siso({0, k}, {1, 0.2, 9});
    const auto margins = calc_margins(m, calc_frequency_response(m));
    const auto expected = calc_margins(plain, calc_frequency_response(plain));
    ASSERT_EQ(margins.phase.size(), expected.phase.size()) << k;
    for (std::size_t i = 0; i < expected.phase.size(); ++i)
      EXPECT_NEAR(margins.phase[i].frequency_hz, expected.phase[i].frequency_hz, 1e-8);
    EXPECT_EQ(margins.gain.size(), expected.gain.size());
  }
}

TEST(Margins, OfASampledLoopWithAnUndampedPole) {
  // x⁺ = turn by w T: poles exp(± i w T). y = what is 4 / (z² - 2 c z + 1) times (z - 0.5).
  const double T = 0.1, w = 7, c = std::cos(w * T);
  auto m = make_siso({4, -2}, {1, -2 * c, 1});
  m.sample_time = T;
  m.poles.real.setZero(2);
  m.poles.imag.resize(2);
  m.poles.imag << w, -w;
  m.poles.frequency_hz = VectorXd::Constant(2, w / 2 / std::numbers::pi);
  m.poles.damping.setZero(2);
  const auto margins = calc_margins(m, calc_frequency_response(m));
  // |L| decreases through 1 at most once behind the pole.
  const auto size = [&](double omega) {
    const auto z = std::polar(1.0, omega * T);
    return std::abs(4.0 * (z - 0.5) / (z * z - 2 * c * z + 1.0));
  };
  EXPECT_GT(size(1), 1);
  EXPECT_EQ(margins.phase.size(), size(std::numbers::pi / T) < 1 ? 1u : 0u);
}

TEST(PeakGain, OfASecondOrderSystemIsTheClosedForm) {
  const double zeta = 1e-3;
  const auto m = make_siso({0, 1}, {1, 2 * zeta, 1});
  const auto peak = calc_peak_gain(m, calc_frequency_response(m));
  EXPECT_TRUE(peak.is_certified);
  EXPECT_NEAR(peak.value, 1 / (2 * zeta * std::sqrt(1 - zeta * zeta)), 2e-6 / zeta);
  EXPECT_NEAR(peak.frequency_hz * 2 * std::numbers::pi, std::sqrt(1 - 2 * zeta * zeta), 1e-6);
}

TEST(PeakGain, OfSeveralChannelsIsFoundWhereTheGridMissesIt) {
  // Two resonances; the frequencies looked at hold the lower one only.
  MatrixXd A = MatrixXd::Zero(4, 4), B = MatrixXd::Zero(4, 2), C = MatrixXd::Zero(2, 4);
  A << 0, 1, 0, 0, -1, -0.02, 0, 0, 0, 0, 0, 1, 0, 0, -900, -0.006;
  B << 0, 0, 1, 0.5, 0, 0, -3, 4;
  C << 1, 0, 2, 0, 0, 0, 5, 0;
  const auto m = make_model(A, B, C, MatrixXd::Zero(2, 2));
  const auto response = calc_frequency_response(m, {0.01, 0.5, 100, 200});
  const auto peak = calc_peak_gain(m, response);
  double best = 0;
  const TransferMatrix transfer(A, B, C, MatrixXd::Zero(2, 2));
  for (double w = 29.9; w < 30.1; w += 1e-5)
    best = std::max(best, Eigen::JacobiSVD<MatrixXcd>(transfer.calc({0, w})).singularValues()[0]);
  EXPECT_GT(best, response.singular_values.maxCoeff());
  EXPECT_NEAR(peak.value, best, 2e-6 * best);
  EXPECT_TRUE(peak.is_certified);
}

TEST(PeakGain, RigidMotionsAreInfiniteOnlyWhereTheyAreSeen) {
  MatrixXd A = MatrixXd::Zero(4, 4), B(4, 1), C(1, 4);
  A << 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, -4, -0.4;
  B << 0, 1, 0, 1;
  C << 0, 0, 1, 0;
  const auto m = make_model(A, B, C, MatrixXd::Zero(1, 1));
  const auto peak = calc_peak_gain(m, calc_frequency_response(m));
  EXPECT_TRUE(peak.is_finite);
  EXPECT_NEAR(peak.value, 1 / (2 * 0.1 * 4 * std::sqrt(1 - 0.01)), 1e-6);
  C << 1, 0, 1, 0;
  const auto seen = make_model(A, B, C, MatrixXd::Zero(1, 1));
  EXPECT_FALSE(calc_peak_gain(seen, calc_frequency_response(seen)).is_finite);
  A(3, 3) = 0;
  const auto undamped = make_model(A, B, C, MatrixXd::Zero(1, 1));
  EXPECT_FALSE(calc_peak_gain(undamped, calc_frequency_response(undamped)).is_finite);
}

TEST(Hankel, ValuesAreThoseOfTheGramians) {
  std::mt19937 engine(11);
  for (int trial = 0; trial < 4; ++trial) {
    const int n = 7;
    MatrixXd A = make_random(engine, n, n);
    A -= (A.eigenvalues().real().maxCoeff() + 0.2) * MatrixXd::Identity(n, n);
    const MatrixXd B = make_random(engine, n, 2), C = make_random(engine, 3, n);
    const auto hankel = calc_hankel(A, B, C);
    EXPECT_EQ(hankel.num_left_out, 0);
    const MatrixXd &P = hankel.controllability, &Q = hankel.observability;
    EXPECT_LT((A * P + P * A.transpose() + B * B.transpose()).norm(), 1e-10 * P.norm());
    EXPECT_LT((A.transpose() * Q + Q * A + C.transpose() * C).norm(), 1e-10 * Q.norm());
    VectorXd squares = (P * Q).eigenvalues().real();
    std::sort(squares.begin(), squares.end(), std::greater<>());
    EXPECT_LT((hankel.value.cwiseAbs2() - squares).norm(), 1e-10 * squares.norm());
    // The largest is at most the peak gain, which is at most twice their sum.
    const auto m = make_model(A, B, C, MatrixXd::Zero(3, 2));
    const double peak = calc_peak_gain(m, calc_frequency_response(m)).value;
    EXPECT_LE(hankel.value[0], peak * (1 + 1e-9));
    EXPECT_LE(peak, calc_truncation_bound(hankel.value, 0) * (1 + 1e-9));
    EXPECT_NEAR(calc_truncation_bound(hankel.value, 5), 2 * (hankel.value[5] + hankel.value[6]), 1e-12);
  }
}

TEST(Hankel, OfLightlyDampedModesAreTheClosedForm) {
  // γ = |b| |c| / (4 ζ ω²) twice a mode, modes apart.
  const double zeta = 1e-3;
  MatrixXd A = MatrixXd::Zero(4, 4), B = MatrixXd::Zero(4, 1), C = MatrixXd::Zero(1, 4);
  A << 0, 0, 1, 0, 0, 0, 0, 1, -9, 0, -2 * zeta * 3, 0, 0, -400, 0, -2 * zeta * 20;
  B << 0, 0, 2, 7;
  C << 1, 5, 0, 0;
  const auto value = calc_hankel(A, B, C).value;
  EXPECT_NEAR(value[0], 2 * 1 / (4 * zeta * 9), 0.01 * value[0]);
  EXPECT_NEAR(value[1], value[0], 0.01 * value[0]);
  EXPECT_NEAR(value[2], 7 * 5 / (4 * zeta * 400), 0.01 * value[2]);
  EXPECT_NEAR(value[3], value[2], 0.01 * value[2]);
}

TEST(Hankel, WhatDoesNotDecayIsLeftOut) {
  // A free mass, a growing pole and a mode that none of them touches.
  MatrixXd A = MatrixXd::Zero(5, 5), B(5, 1), C(1, 5);
  A.bottomRightCorner(2, 2) << 0, 1, -4, -0.1;
  A(0, 1) = 1;
  A(2, 2) = 0.3;
  B << 0, 1, 1, 0, 1;
  C << 1, 0, 1, 1, 0;
  const auto hankel = calc_hankel(A, B, C);
  EXPECT_EQ(hankel.num_left_out, 3);
  const auto alone = calc_hankel(A.bottomRightCorner(2, 2), B.bottomRows(2), C.rightCols(2));
  ASSERT_EQ(hankel.value.size(), 2);
  EXPECT_LT((hankel.value - alone.value).norm(), 1e-10);
}

TEST(Track, FollowsMotionsThroughACrossing) {
  // Two oscillators, hardly coupled, whose frequencies cross at p = 1, between two values; the order by size would
  // exchange them.
  records::LinearSweep sweep;
  sweep.parameter = "p";
  sweep.value = VectorXd::LinSpaced(20, 0, 2);
  for (const double p : sweep.value) {
    MatrixXd A = MatrixXd::Zero(4, 4);
    A(0, 2) = A(1, 3) = 1;
    A(2, 0) = -std::pow(1 + p, 2);
    A(3, 1) = -std::pow(3 - p, 2);
    A(2, 1) = A(3, 0) = 1e-3;
    sweep.models.push_back(make_model(A, MatrixXd::Zero(4, 0), MatrixXd::Zero(0, 4), MatrixXd::Zero(0, 0)));
  }
  track_poles(sweep);
  for (int b = 0; b < 4; ++b) {
    const bool is_rising = sweep.frequency_hz(0, b) * 2 * std::numbers::pi < 2;
    EXPECT_NEAR(sweep.frequency_hz(19, b) * 2 * std::numbers::pi, is_rising ? 3 : 1, 1e-3);
    EXPECT_GT(sweep.correlation(5, b), 0.99);
    for (int k = 1; k < 20; ++k) EXPECT_EQ(sweep.imag(k, b) > 0, sweep.imag(0, b) > 0);
  }
}

}  // namespace
}  // namespace bough::statespace
