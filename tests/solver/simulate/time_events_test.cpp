// Time events of a run: output times, jumps, mesh times, and the checks of [simulation].
#include "solver/simulate/time_events.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/diagnostic.hpp"

namespace bough::solver {
namespace {

records::SimulationRecord make_simulation(double duration, double output_step) {
  records::SimulationRecord s;
  s.duration = duration;
  s.output_step = output_step;
  return s;
}

RunPlan plan(double duration, double output_step) {
  Diagnostics d;
  const RunPlan made = make_run_plan(make_simulation(duration, output_step), d);
  EXPECT_TRUE(d.items().empty());
  return made;
}

TEST(TimeEvents, OutputsEndExactlyAtTheEnd) {
  const TimeEvents even(plan(1, 0.1));
  ASSERT_EQ(even.num_outputs(), 11);
  EXPECT_EQ(even.calc_output(3), 3 * 0.1);
  EXPECT_EQ(even.calc_output(10), 1);
  EXPECT_EQ(even.calc_output(11), std::numeric_limits<double>::infinity());
  const TimeEvents uneven(plan(1, 0.4));
  ASSERT_EQ(uneven.num_outputs(), 4);
  EXPECT_EQ(uneven.calc_output(2), 0.8);
  EXPECT_EQ(uneven.calc_output(3), 1);
  EXPECT_EQ(TimeEvents(plan(5, 0)).num_outputs(), 1001);
}

// 3 · 0.1 is one rounding above 0.3: the sample is the jump's.
TEST(TimeEvents, OutputsNextToAJumpAreAtTheJump) {
  ASSERT_NE(3 * 0.1, 0.3);
  const TimeEvents timeline(plan(1, 0.1), {0.3}, {});
  EXPECT_EQ(timeline.calc_output(3), 0.3);
  EXPECT_EQ(timeline.calc_output(6), 6 * 0.1);
}

TEST(TimeEvents, StopsAreTheJumpsInsideAndTheEnd) {
  const double a = 0.3, b = std::nextafter(a, 1.0);
  const TimeEvents timeline(plan(1, 0.1), {0.7, 0, a, b, 1, 5, -3}, {0.5, 0.7, 2});
  const TimeEvent first = timeline.find_next(0);
  EXPECT_EQ(first.time, b);  // two jumps a rounding apart are one
  EXPECT_EQ(first.left, std::nextafter(a, 0.0));
  EXPECT_TRUE(first.is_jump);
  const TimeEvent mesh = timeline.find_next(b);
  EXPECT_EQ(mesh.time, 0.5);
  EXPECT_EQ(mesh.left, 0.5);
  EXPECT_FALSE(mesh.is_jump);
  EXPECT_EQ(timeline.find_next(0.5).time, 0.7);
  EXPECT_TRUE(timeline.find_next(0.5).is_jump);  // the mesh time there is the jump
  EXPECT_EQ(timeline.find_next(0.7).time, 1);
  EXPECT_EQ(timeline.find_next(0.7).left, std::nextafter(1.0, 0.0));  // a jump there: the steps see what is before
  EXPECT_EQ(TimeEvents(plan(1, 0.1), {0.7}, {}).find_next(0.7).left, 1);
}

TEST(TimeEvents, GoesOnFromAnyTime) {
  TimeEvents timeline(plan(1, 0.1));
  timeline.skip_outputs(0.2);
  EXPECT_EQ(timeline.next_output(), 3 * 0.1);
  timeline.skip_outputs(0.55);
  EXPECT_EQ(timeline.next_output(), 6 * 0.1);
  timeline.take_output();
  EXPECT_EQ(timeline.next_index(), 7);
  timeline.skip_outputs(1);
  EXPECT_EQ(timeline.next_output(), std::numeric_limits<double>::infinity());
}

// 1e8 samples were a vector of 0.8 GB.
TEST(TimeEvents, ManyOutputsTakeNoMemory) {
  const TimeEvents timeline(plan(1e5, 1e-3));
  EXPECT_EQ(timeline.num_outputs(), 100000001);
  EXPECT_NEAR(timeline.calc_output(12345678), 12345.678, 1e-9);
}

TEST(RunPlan, Rk4StepDividesTheOutputStep) {
  Diagnostics d;
  auto s = make_simulation(1, 0.1);
  s.integrator = "rk4";
  s.step = 0.02;
  EXPECT_NEAR(make_run_plan(s, d).step, 0.02, 1e-16);
  EXPECT_TRUE(d.items().empty());
  s.step = 0.03;
  EXPECT_NEAR(make_run_plan(s, d).step, 0.025, 1e-16);
  EXPECT_TRUE(d.has("run.step-adjusted"));
  EXPECT_EQ(d.num_errors(), 0);
}

TEST(RunPlan, FaultsAreReported) {
  Diagnostics d;
  auto s = make_simulation(1, 0.1);
  s.integrator = "adam";
  make_run_plan(s, d);
  ASSERT_TRUE(d.has("run.unknown-integrator"));
  EXPECT_NE(format(d.items()[0]).find("did you mean 'adams'?"), std::string::npos);

  Diagnostics all;
  s = make_simulation(-1, std::nan(""));
  s.relative_tolerance = 0;
  s.absolute_tolerance = -1;
  s.divergence_limit = 0;
  make_run_plan(s, all);
  EXPECT_TRUE(all.has("run.bad-simulation"));
  EXPECT_EQ(all.num_errors(), 5);

  Diagnostics step;
  s = make_simulation(1, 0.1);
  s.integrator = "rk4";
  make_run_plan(s, step);
  EXPECT_TRUE(step.has("run.bad-simulation"));
}

TEST(RunPlan, TimesThatCannotBeToldApartAreRefused) {
  Diagnostics d;
  auto s = make_simulation(1, 0.1);
  s.start = 1e18;
  make_run_plan(s, d);
  ASSERT_EQ(d.num_errors(), 1);
  EXPECT_THAT(d.items()[0].what, ::testing::HasSubstr("start = 1e+18 is too far from zero: times there are"));
  Diagnostics near;
  s.start = 1e9;
  make_run_plan(s, near);
  EXPECT_EQ(near.num_errors(), 0);
}

TEST(RunPlan, StepsWithoutEndAreRefused) {
  Diagnostics d;
  auto s = make_simulation(20, 0.1);
  s.step = 1e-12;
  make_run_plan(s, d);
  ASSERT_EQ(d.num_errors(), 1);
  EXPECT_THAT(d.items()[0].what, ::testing::HasSubstr("more than 1e11 steps"));
}

}  // namespace
}  // namespace bough::solver
