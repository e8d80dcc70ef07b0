// [[event]]: located by every integrator as exactly as it steps; what they do to the run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "solver/integrate/locate.hpp"
#include "tests/solver/support/runs.hpp"

namespace bough::solver::testing {
namespace {

using records::EventAction;
using records::EventDirection;

/// 2 ẍ = -18 x on a slide along z: x = cos(3t) / 2.
records::SystemSpec make_oscillator() {
  auto spec = make_spring_mass();
  spec.sensors = {make_sensor("place", records::SensorType::Position, "body")};
  spec.simulation.duration = 3;
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-10;
  return spec;
}

TEST(Locate, FindsTheFarSideOfARoot) {
  const auto check = [](const std::function<double(double)>& g, double a, double b, double root) {
    int calls = 0;
    const auto counted = [&](double t) {
      ++calls;
      return g(t);
    };
    const double t = locate_crossing(counted, a, g(a), b, g(b), 1e-12);
    EXPECT_NEAR(t, root, 1.1e-12);
    EXPECT_GT(g(t) * g(b), 0);
    EXPECT_LE(calls, 100);  // twice what halving takes
  };
  check([](double t) { return t - 0.3; }, 0, 1, 0.3);
  check([](double t) { return 1 - t * t * t * t * t * t * t; }, 0, 40, 1);
  check([](double t) { return t < 0.7 ? -1e-9 : 1e9; }, 0, 1, 0.7);
  check([](double t) { return std::atan(1e6 * (t - 0.123)); }, 0, 1, 0.123);
  check([](double t) { return t; }, 0, 1, 0);  // it starts at the root
}

TEST(Events, AreLocatedByEveryIntegrator) {
  for (const std::string integrator : {"adams", "bdf", "rk", "radau", "rk4"}) {
    auto spec = make_oscillator();
    spec.simulation.integrator = integrator;
    spec.simulation.step = integrator == "rk4" ? 0.005 : 0;
    spec.events = {make_trigger("through", "place:z", 0.25),
                   make_trigger("down", "/hinges/hinge/q", 0.25, EventDirection::Falling),
                   make_trigger("up", "place:3", 0.25, EventDirection::Rising)};
    const RunResult r = run(spec);
    const double p = std::acos(-1.0), first = p / 9, second = (2 * p - p / 3) / 3, third = (2 * p + p / 3) / 3;
    std::vector<double> times;
    std::vector<std::string> names;
    for (const auto& e : r.sink.events()) {
      times.push_back(e.time);
      names.push_back(e.what);
    }
    const double tolerance = integrator == "bdf" ? 1e-6 : 2e-8;
    using ::testing::DoubleNear;
    EXPECT_THAT(times, ::testing::ElementsAre(DoubleNear(first, tolerance), DoubleNear(first, tolerance),
                                              DoubleNear(second, tolerance), DoubleNear(second, tolerance),
                                              DoubleNear(third, tolerance), DoubleNear(third, tolerance)))
        << integrator;
    ASSERT_EQ(names.size(), 6u);
    EXPECT_THAT(names, ::testing::Contains("event 'down': /hinges/hinge/q falls through 0.25").Times(2));
    EXPECT_THAT(names, ::testing::Contains("event 'up': place:3 rises through 0.25").Times(1));
    EXPECT_THAT(names, ::testing::Contains("event 'through': place:z rises through 0.25").Times(1));
  }
}

// A line in the log leaves the motion as it is, to the last bit.
TEST(Events, LogsDoNotTouchTheMotion) {
  for (const std::string integrator : {"adams", "bdf", "rk", "radau", "rk4"}) {
    auto spec = make_oscillator();
    spec.simulation.integrator = integrator;
    spec.simulation.step = integrator == "rk4" ? 0.02 : 0;
    const RunResult without = run(spec);
    spec.events = {make_trigger("through", "place:z", 0.25)};
    const RunResult with = run(spec);
    EXPECT_EQ(with.sink.events().size(), 3u);
    EXPECT_EQ(with.sink.get("/hinges/hinge/qdot"), without.sink.get("/hinges/hinge/qdot")) << integrator;
  }
}

TEST(Events, StopEndsTheRunThere) {
  for (const std::string integrator : {"adams", "bdf", "rk", "radau", "rk4"}) {
    auto spec = make_oscillator();
    spec.simulation.integrator = integrator;
    spec.simulation.step = integrator == "rk4" ? 0.005 : 0;
    spec.events = {make_trigger("later", "place:z", -0.4), make_trigger("contact", "place:z", 0)};
    spec.events[1].action = EventAction::Stop;
    const RunResult r = run(spec);
    const double end = std::acos(-1.0) / 6;
    EXPECT_TRUE(r.outcome.completed);
    EXPECT_TRUE(r.sink.completed());
    EXPECT_NEAR(r.outcome.time, end, 1e-6);
    EXPECT_THAT(r.sink.reason(), HasSubstr("stopped by event 'contact': place:z falls through 0 at t = 0.523599"));
    ASSERT_EQ(r.sink.num_samples(), 7);
    EXPECT_EQ(r.sink.time()[5], 0.5);
    EXPECT_EQ(r.sink.time()[6], r.outcome.time);
    EXPECT_NEAR(r.sink.get("/hinges/hinge/q")(6, 0), 0, integrator == "bdf" ? 1e-6 : 1e-11) << integrator;
    EXPECT_LE(r.sink.get("/hinges/hinge/q")(6, 0), 0);
    EXPECT_EQ(r.sink.checkpoints().back().time, r.outcome.time);
    EXPECT_EQ(r.sink.events().size(), 1u);
  }
}

TEST(Events, AtATime) {
  auto spec = make_oscillator();
  records::UserEventRecord log, stop, late;
  log.name = "half way";
  log.time = 0.55;
  stop.name = "enough";
  stop.time = 1.234;
  stop.action = EventAction::Stop;
  late.name = "late";
  late.time = 99;
  spec.events = {stop, log, late};
  const RunResult r = run(spec);
  EXPECT_EQ(r.outcome.time, 1.234);
  EXPECT_EQ(r.sink.time()[r.sink.num_samples() - 1], 1.234);
  EXPECT_NEAR(r.sink.get("/hinges/hinge/q")(r.sink.num_samples() - 1, 0), 0.5 * std::cos(3 * 1.234), 1e-7);
  ASSERT_EQ(r.sink.events().size(), 2u);
  EXPECT_EQ(r.sink.events()[0].time, 0.55);
  EXPECT_EQ(r.sink.events()[0].what, "event 'half way'");
  EXPECT_EQ(r.sink.reason(), "stopped by event 'enough' at t = 1.234");
  EXPECT_TRUE(r.diagnostics.has("run.event-never"));
}

// An acceleration that a step of a force carries over the value crosses it at the step, by any method.
TEST(Events, CrossingsByAJump) {
  auto spec = make_oscillator();
  spec.hinges[0].stiffness.clear();
  spec.functions = {make_function("f", "step", {{"value", 4}, {"at", 1.05}})};
  spec.forces = {make_force("push", "body", {0, 0, 1}, "f")};
  spec.sensors[0].type = records::SensorType::Acceleration;
  spec.events = {make_trigger("kick", "place:z", 1)};
  const RunResult r = run(spec);
  ASSERT_EQ(r.sink.events().size(), 1u);
  EXPECT_EQ(r.sink.events()[0].time, 1.05);
}

// A signal that starts at its value has not crossed it.
TEST(Events, TheStartIsNoCrossing) {
  auto spec = make_oscillator();
  spec.events = {make_trigger("start", "place:z", 0.5), make_trigger("rest", "place:x", 0)};
  spec.simulation.duration = 2;
  EXPECT_TRUE(run(spec).sink.events().empty());
}

TEST(Events, GoOnAfterAResume) {
  auto spec = make_oscillator();
  spec.events = {make_trigger("through", "place:z", 0.25)};
  std::atomic<bool> stop{false};
  SimulateOptions options, resume;
  options.stop = &stop;
  options.progress = [&](const Progress& p) { stop = p.time > 1; };
  const RunResult first = run(spec, {}, options);
  EXPECT_EQ(first.sink.events().size(), 1u);
  resume.resume = first.sink.checkpoints().back();
  const RunResult second = run(spec, {}, resume);
  ASSERT_EQ(second.sink.events().size(), 2u);
  EXPECT_NEAR(second.sink.events()[0].time, std::acos(-1.0) * 5 / 9, 1e-7);
}

TEST(Events, FaultsAreReported) {
  auto spec = make_oscillator();
  spec.events = {make_trigger("a", "plaice:z", 1), make_trigger("b", "place", 1), make_trigger("c", "place:w", 1),
                 make_trigger("d", "/hinges/hinge/q:z", 1), make_trigger("e", "place:z", std::nan(""))};
  Diagnostics diagnostics;
  const System system = build(spec);
  check_run(system, spec, diagnostics);
  ASSERT_EQ(diagnostics.num_errors(), 5);
  const auto text = [&](size_t i) { return format(diagnostics.items()[i]); };
  EXPECT_THAT(text(0), HasSubstr("event 'a' watches 'plaice:z', which is no sensor"));
  EXPECT_THAT(text(0), HasSubstr("did you mean 'place'?"));
  EXPECT_EQ(diagnostics.items()[0].id, "run.unknown-signal");
  EXPECT_THAT(text(1), HasSubstr("does not say which component; its components are x, y, z"));
  EXPECT_THAT(text(2), HasSubstr("there is no component 'w'; its components are x, y, z"));
  EXPECT_THAT(text(3), HasSubstr("it is a scalar: leave the component out"));
  EXPECT_EQ(diagnostics.items()[4].id, "run.bad-event");
  EXPECT_EQ(diagnostics.items()[4].where.line, 30);
}

}  // namespace
}  // namespace bough::solver::testing
