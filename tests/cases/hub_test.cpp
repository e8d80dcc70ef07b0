// NASA-CR-202063, 4.1.4.2: a beam clamped to the rim of a rotating hub, pointing to the axis, buckles in its own
// centrifugal field past 2.1866 rad/s (rim radius 10 m).
#include <gtest/gtest.h>

#include <cmath>

#include "tests/cases/support/example.hpp"

namespace bough::test {
namespace {

VectorXd run_hub(const std::string& file, VectorXd& time) {
  solver::MemorySink sink;
  load_example("ex02-hub", file).run(sink);
  time = sink.time();
  return sink.get("/sensors/tip_deflection").col(1);
}

double calc_largest(const VectorXd& t, const VectorXd& v, double from, double to) {
  const int a = find_sample(t, from), b = find_sample(t, to);
  return v.segment(a, b - a + 1).cwiseAbs().maxCoeff();
}

TEST(Hub, BoundedBelowTheCriticalRate) {
  VectorXd t;
  const VectorXd v = run_hub("hub-2.18.toml", t);
  EXPECT_LT(calc_largest(t, v, 0, 2), 1e-12);  // m, before the tap: rounding
  record("largest_to_31_s", calc_largest(t, v, 2, 31));
  record("largest_to_60_s", calc_largest(t, v, 31, 60));
  EXPECT_GT(calc_largest(t, v, 2, 31), 1e-4);
  EXPECT_LT(calc_largest(t, v, 31, 60), 1.02 * calc_largest(t, v, 2, 31));  // an undamped swing, no growth
}

TEST(Hub, UnboundedAboveIt) {
  VectorXd t;
  const VectorXd v = run_hub("hub-2.19.toml", t);
  const double last = calc_largest(t, v, 59, 60);
  record("growth_30_to_60_s", last / calc_largest(t, v, 29, 30));
  EXPECT_GT(last, 50 * calc_largest(t, v, 29, 30));
  EXPECT_GT(calc_largest(t, v, 29, 30), 2 * calc_largest(t, v, 19, 20));
}

/// Lowest eigenvalue of -∂η̈/∂η at η = 0 and a steady rate: the beam buckles where it passes zero.
double calc_lowest_eigenvalue(double rate) {
  Example example = load_example("ex02-hub", "hub-2.18.toml");
  auto& ramp = example.spec.functions[0].values;
  ramp["value"] = (ramp.at("to") - ramp.at("from")) * rate;
  const solver::System system = example.build();
  const int body = system.find_body("boom"), n = system.num_modes(body), at = system.eta_offset(body);
  auto data = system.make_data();
  VectorXd q(system.num_q()), u(system.num_u());
  system.calc_initial_state(q, u);
  const auto calc = [&](int mode, double eta) {
    VectorXd moved = q, u_dot(system.num_u());
    moved[at + mode] = eta;
    calc_kinematics(system, *data, 1, moved, u);
    add_forces(system, *data, 1);
    calc_accelerations(system, *data, 1, u_dot);
    return VectorXd(u_dot.segment(system.eta_dot_offset(body), n));
  };
  MatrixXd A(n, n);
  const double h = 1e-4;
  for (int j = 0; j < n; ++j) A.col(j) = -(calc(j, h) - calc(j, -h)) / (2 * h);
  return A.eigenvalues().real().minCoeff();
}

TEST(Hub, CriticalRate) {
  double low = 2.0, high = 2.4;
  ASSERT_GT(calc_lowest_eigenvalue(low), 0);
  ASSERT_LT(calc_lowest_eigenvalue(high), 0);
  while (high - low > 1e-5) {
    const double middle = (low + high) / 2;
    (calc_lowest_eigenvalue(middle) > 0 ? low : high) = middle;
  }
  record("critical_rate", low);
  EXPECT_NEAR(low, 2.1866, 0.001 * 2.1866);
}

}  // namespace
}  // namespace bough::test
