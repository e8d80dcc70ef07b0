// Output times, restarts at jumps, and the checks of [simulation].
#include "solver/integrate/plan.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bough::solver {
namespace {

records::SimulationRecord make_simulation(double duration, double output_step) {
  records::SimulationRecord s;
  s.duration = duration;
  s.output_step = output_step;
  return s;
}

TEST(RunPlan, OutputsEndExactlyAtTheEnd) {
  Diagnostics d;
  const RunPlan even = make_run_plan(make_simulation(1, 0.1), {}, d);
  ASSERT_EQ(even.outputs.size(), 11u);
  EXPECT_EQ(even.outputs[3], 3 * 0.1);
  EXPECT_EQ(even.outputs.back(), 1);
  const RunPlan uneven = make_run_plan(make_simulation(1, 0.4), {}, d);
  ASSERT_EQ(uneven.outputs.size(), 4u);
  EXPECT_EQ(uneven.outputs[2], 0.8);
  EXPECT_EQ(uneven.outputs[3], 1);
  EXPECT_EQ(make_run_plan(make_simulation(5, 0), {}, d).outputs.size(), 1001u);
  EXPECT_TRUE(d.items().empty());
}

TEST(RunPlan, SegmentsMeetAtTheJumps) {
  Diagnostics d;
  const double a = 0.3, b = std::nextafter(a, 1.0);
  const RunPlan plan = make_run_plan(make_simulation(1, 0.1), {0.7, 0, a, b, 1, 5, -3}, d);
  ASSERT_EQ(plan.segments.size(), 3u);
  EXPECT_EQ(plan.segments[0].start, 0);
  EXPECT_EQ(plan.segments[0].end, b);  // two jumps a rounding apart are one
  EXPECT_EQ(plan.segments[0].latest, std::nextafter(a, 0.0));
  EXPECT_EQ(plan.segments[1].start, b);
  EXPECT_EQ(plan.segments[1].end, 0.7);
  EXPECT_EQ(plan.segments[2].end, 1);
  EXPECT_EQ(plan.segments[2].latest, 1);
}

TEST(RunPlan, Rk4StepDividesTheOutputStep) {
  Diagnostics d;
  auto s = make_simulation(1, 0.1);
  s.integrator = "rk4";
  s.step = 0.02;
  EXPECT_NEAR(make_run_plan(s, {}, d).step, 0.02, 1e-16);
  EXPECT_TRUE(d.items().empty());
  s.step = 0.03;
  EXPECT_NEAR(make_run_plan(s, {}, d).step, 0.025, 1e-16);
  EXPECT_TRUE(d.has("run.step-adjusted"));
  EXPECT_EQ(d.num_errors(), 0);
}

TEST(RunPlan, FaultsAreReported) {
  Diagnostics d;
  auto s = make_simulation(1, 0.1);
  s.integrator = "adam";
  make_run_plan(s, {}, d);
  ASSERT_TRUE(d.has("run.unknown-integrator"));
  EXPECT_NE(format(d.items()[0]).find("did you mean 'adams'?"), std::string::npos);

  Diagnostics all;
  s = make_simulation(-1, std::nan(""));
  s.relative_tolerance = 0;
  s.absolute_tolerance = -1;
  s.divergence_limit = 0;
  make_run_plan(s, {}, all);
  EXPECT_TRUE(all.has("run.bad-simulation"));
  EXPECT_EQ(all.num_errors(), 5);

  Diagnostics step;
  s = make_simulation(1, 0.1);
  s.integrator = "rk4";
  make_run_plan(s, {}, step);
  EXPECT_TRUE(step.has("run.bad-simulation"));
}

}  // namespace
}  // namespace bough::solver
