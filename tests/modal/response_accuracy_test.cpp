// What a response says of itself, where it is right and where it has been spoiled.
#include "modal/response/accuracy.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace bough::modal::response {
namespace {

/// Two damped modes that a damper couples, and one load on both.
ResponseModel make_two_modes() {
  ResponseModel model;
  model.lambda = Eigen::Vector2d(100, 900);
  model.num_normal = 2;
  model.P = Eigen::Vector2d(1, -2);
  model.D = (Eigen::Matrix2d() << 0.4, 0.1, 0.1, 0.9).finished();
  model.S = Eigen::Matrix2d::Zero();
  model.is_coupled = true;
  return model;
}

/// The same at one frequency by the closed form of a 2 x 2 system.
Spectrum solve_by_hand(const ResponseModel& model, double hz) {
  using namespace std::complex_literals;
  const double omega = 2 * std::numbers::pi * hz;
  Eigen::Matrix2cd Z = 1i * omega * model.D.cast<std::complex<double>>();
  for (int j = 0; j < 2; ++j) Z(j, j) += model.lambda(j) - omega * omega;
  const auto det = Z(0, 0) * Z(1, 1) - Z(0, 1) * Z(1, 0);
  Spectrum spectrum;
  spectrum.hz = VectorXd::Constant(1, hz);
  spectrum.a = MatrixXcd::Ones(1, 1);
  const Eigen::Vector2cd f = model.P.cast<std::complex<double>>();
  spectrum.q.resize(2, 1);
  spectrum.q(0, 0) = (Z(1, 1) * f(0) - Z(0, 1) * f(1)) / det;
  spectrum.q(1, 0) = (Z(0, 0) * f(1) - Z(1, 0) * f(0)) / det;
  return spectrum;
}

TEST(ResponseAccuracy, TheSolutionOfTheEquationHasNoResidual) {
  const auto model = make_two_modes();
  for (const double hz : {0.0, 0.7, 1.6, 4.8}) EXPECT_LT(calc_solution_error(model, solve_by_hand(model, hz)), 1e-13);
}

TEST(ResponseAccuracy, ASpoiledSolutionIsTold) {
  const auto model = make_two_modes();
  auto spectrum = solve_by_hand(model, 0.7);
  spectrum.q(1, 0) *= 1 + 1e-5;
  const double error = calc_solution_error(model, spectrum);
  EXPECT_GT(error, 1e-6);
  EXPECT_LT(error, 1e-4);
  Diagnostics diagnostics;
  report_accuracy({1e-15, 1e-15}, error, {}, diagnostics);
  EXPECT_TRUE(diagnostics.has("modal.response-accuracy"));
  Diagnostics skewed;
  report_accuracy({0.5, 1e-9}, 1e-15, {}, skewed);  // by round-off of K
  EXPECT_TRUE(skewed.has("modal.response-accuracy"));
  Diagnostics good;
  report_accuracy({1e-9, 1e-9}, 1e-9, {}, good);
  EXPECT_TRUE(good.items().empty());
}

TEST(ResponseAccuracy, FarOffOrNoNumberEndsIt) {
  const auto model = make_two_modes();
  auto spectrum = solve_by_hand(model, 0.7);
  spectrum.q *= 1.5;
  Diagnostics diagnostics;
  const auto expect_end = [&](double basis, double solution) {
    try {
      report_accuracy({basis, basis}, solution, {}, diagnostics);
      FAIL();
    } catch (const ComputationError& error) {
      EXPECT_EQ(error.items().front().id, "modal.response-accuracy");
    }
  };
  expect_end(1e-15, calc_solution_error(model, spectrum));
  expect_end(std::nan(""), 1e-15);
  expect_end(0.48, 1e-15);
  expect_end(1e-15, std::nan(""));
}

// One step of 1 ms of 2 to 300 Hz, coupled and not: as two of half of it.
TEST(ResponseAccuracy, AStepIsTwoHalves) {
  for (const bool is_coupled : {false, true}) {
    auto model = make_two_modes();
    model.is_coupled = is_coupled;
    model.lambda(1) = 4e6;
    if (!is_coupled) model.D = model.D.diagonal().asDiagonal().toDenseMatrix();
    Excitation excitation;
    excitation.F = MatrixXd::Zero(1, 1);
    excitation.D = MatrixXd::Zero(0, 0);
    TimeGrid grid;
    grid.time = VectorXd::LinSpaced(11, 0, 0.01);
    grid.shown = {0, 10};
    const double error = calc_history(model, excitation, grid).step_error;
    EXPECT_GT(error, 0);
    EXPECT_LT(error, 1e-12);
  }
}

TEST(ResidualRecord, TakesTheWorstFrequencyAndTheWholeOfATime) {
  const VectorXd D = Eigen::Vector2d(4, 9);
  const Eigen::VectorXcd x = Eigen::Vector2cd(1, 0), A_x = Eigen::Vector2cd(2, 3), small = 1e-3 * A_x;
  // |D^-1/2 A x| = sqrt(1 + 1), what is wrong 3e-4 / 3.
  const Eigen::VectorXcd b = A_x + Eigen::Vector2cd(0, 3e-4);
  const double wrong = 1e-4 / (std::sqrt(2.0) + 2e-6);
  ResidualRecord over_frequency(false), over_time(true);
  EXPECT_EQ(over_frequency.worst(), 0);
  for (auto* record : {&over_frequency, &over_time}) {
    record->add(D, x, A_x, A_x);
    record->add(D, x, A_x, b);
    EXPECT_NEAR(record->worst(), wrong, 1e-12);
    record->add(D, 1e-3 * x, small, small + (b - A_x));
  }
  EXPECT_NEAR(over_frequency.worst(), 1e3 * wrong, 1e-9);
  EXPECT_NEAR(over_time.worst(), wrong, 1e-12);
  for (auto* record : {&over_frequency, &over_time}) {
    record->add(D, x, A_x, std::nan("") * b);
    record->add(D, x, A_x, b);
    EXPECT_FALSE(record->worst() <= 1);
  }
}

TEST(ResidualRecord, IsToldAndEndsWhatIsWrong) {
  Diagnostics diagnostics;
  report_residual(1e-7, {"d.bdf"}, diagnostics);
  EXPECT_TRUE(diagnostics.items().empty());
  report_residual(1e-5, {"d.bdf"}, diagnostics);
  ASSERT_EQ(diagnostics.items().size(), 1u);
  EXPECT_EQ(diagnostics.items()[0].id, "modal.response-accuracy");
  for (const double wrong : {1e-2, std::nan("")})
    EXPECT_THROW(report_residual(wrong, {"d.bdf"}, diagnostics), ComputationError);
}

}  // namespace
}  // namespace bough::modal::response
