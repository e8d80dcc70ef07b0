// NASA-CR-202063, 4.1.4.3: a simply supported plate under a running load p(t) on its short edges. Theory: it buckles at
// p = k π² D / b², k = (m b/a + a/(m b))², m = 2: 0.1675 lb/in. The load is a pattern of the body file.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "tests/cases/support/example.hpp"

namespace bough::test {
namespace {

constexpr double kE = 9.84e4, kNu = 0.3, kThickness = 0.1, kLength = 72, kWidth = 48;

double calc_theory() {
  const double D = kE * std::pow(kThickness, 3) / (12 * (1 - kNu * kNu));
  const double side = 2 * kWidth / kLength + kLength / (2 * kWidth);
  return side * side * std::pow(std::numbers::pi / kWidth, 2) * D;
}

/// Reduced once: both systems have the same body file.
const records::FlexBody& get_body() {
  static const Example example = load_example("ex05-plate", "plate-0.165.toml");
  return example.flex.begin()->second;
}

VectorXd run_plate(const std::string& level, VectorXd& time, const std::string& sensor = "deflection") {
  Example example = load_example("ex05-plate", "plate-" + level + ".toml");
  solver::MemorySink sink;
  example.run(sink);
  time = sink.time();
  return sink.get("/sensors/" + sensor).col(2);
}

double calc_largest(const VectorXd& t, const VectorXd& v, double from, double to) {
  double largest = 0;
  for (Eigen::Index i = 0; i < t.size(); ++i)
    if (t[i] >= from - 1e-9 && t[i] <= to + 1e-9) largest = std::max(largest, std::abs(v[i]));
  return largest;
}

TEST(Plate, CriticalRunningLoad) {
  EXPECT_NEAR(calc_theory(), 0.1675, 0.00005);  // the report's theory
  const auto& body = get_body();
  ASSERT_EQ(body.num_modes(), 10);
  ASSERT_EQ(body.locators.back().name, "running");
  // K + p K_G2 = 0, the smallest p.
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(body.kg_external.back(), body.modal_stiffness);
  const double critical = -1 / solver.eigenvalues().minCoeff();
  record("critical_running_load", critical);
  EXPECT_NEAR(critical / calc_theory(), 1, 0.01);
  // A running load on two opposite edges is in equilibrium: it pushes no frame, and bends nothing.
  EXPECT_LT(body.load_resultant.rightCols<1>().norm(), 1e-10);
  EXPECT_LT(body.external_load.rightCols<1>().norm(), 1e-6);
}

TEST(Plate, BoundedBelowTheCriticalLoad) {
  VectorXd t;
  const VectorXd w = run_plate("0.165", t);
  const double early = calc_largest(t, w, 1, 20), late = calc_largest(t, w, 20, 40);
  record("largest_1_to_20_s", early);
  record("largest_20_to_40_s", late);
  EXPECT_LT(calc_largest(t, w, 0, 0.98), 1e-6 * early);  // flat until the tap
  EXPECT_GT(early, 1e-3);
  EXPECT_LT(early, 0.01);
  EXPECT_LT(late, 1.1 * early);  // an undamped swing of several modes, no growth
}

TEST(Plate, UnboundedAboveIt) {
  VectorXd t;
  const VectorXd w = run_plate("0.170", t, "quarter");
  // It leaves as exp(s t), s² = -λ the negative eigenvalue of K + p K_G2, as long as it is small beside the plate: 2 in
  // at 9 s. Later its edges draw in so fast that their motion takes up energy.
  const auto& body = get_body();
  const MatrixXd K = body.modal_stiffness + 0.170 * body.kg_external.back();
  const double rate = std::sqrt(-Eigen::SelfAdjointEigenSolver<MatrixXd>(K).eigenvalues()[0]);
  const double growth = std::log(calc_largest(t, w, 8.5, 9) / calc_largest(t, w, 6.5, 7)) / 2;
  record("growth_rate", growth);
  EXPECT_NEAR(growth / rate, 1, 0.01);
  EXPECT_GT(calc_largest(t, w, 14.5, 15), 1);
}

}  // namespace
}  // namespace bough::test
