// Events, relays, contacts and stops between the ends of long steps are not missed if the samples show them; and the
// evaluations that are made are the evaluations that are reported.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/builder/build_system.hpp"
#include "solver/control/hosted.hpp"
#include "tests/solver/control/support.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;

const std::vector<std::string> kAdaptive = {"adams", "bdf", "rk", "radau"};

/// A body that flies along x at `speed` from `x`, 0.5 beside the origin, with its distance from there as "range": free
/// motion, of which adaptive methods make a few steps.
records::SystemSpec make_fly_by(double x, double speed) {
  auto spec = make_one_body(HingeType::Free);
  spec.hinges[0].position = {1, 0, 0, 0, x, 0.5, 0};
  spec.hinges[0].rate = {0, 0, 0, speed, 0, 0};
  auto range = make_sensor("range", records::SensorType::Distance, "body");
  range.target = Vector3d::Zero();
  spec.sensors = {range};
  spec.simulation.duration = 10;
  spec.simulation.output_step = 0.01;
  return spec;
}

TEST(Scan, AnEventWithinALongStepStopsTheRun) {
  for (const auto& integrator : kAdaptive) {
    auto spec = make_fly_by(-500, 100);
    spec.simulation.integrator = integrator;
    auto near = make_trigger("near", "range", 1);
    near.direction = records::EventDirection::Falling;
    near.action = records::EventAction::Stop;
    spec.events = {near};
    const RunResult r = run(spec);
    const double expected = (500 - std::sqrt(0.75)) / 100;
    EXPECT_NEAR(r.outcome.time, expected, 1e-9) << integrator;
    EXPECT_EQ(r.sink.time()[r.sink.num_samples() - 1], r.outcome.time) << integrator;
    if (integrator == "adams") {
      EXPECT_LT(r.outcome.last.num_steps, 10);
    }
  }
}

// In and out of two ranges, in the order of time, each logged once.
TEST(Scan, EventsWithinOneStepComeInOrder) {
  for (const auto& integrator : kAdaptive) {
    auto spec = make_fly_by(-500, 100);
    spec.simulation.integrator = integrator;
    spec.events = {make_trigger("inner", "range", 1), make_trigger("outer", "range", 2)};
    const MemorySink sink = run(spec).sink;
    const double inner = std::sqrt(0.75) / 100, outer = std::sqrt(3.75) / 100;
    const std::vector<double> expected = {5 - outer, 5 - inner, 5 + inner, 5 + outer};
    std::vector<double> found;
    for (const auto& e : sink.events()) found.push_back(e.time);
    ASSERT_EQ(found.size(), 4u) << integrator;
    for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(found[i], expected[i], 1e-9) << integrator << i;
  }
}

// A relay that is on while the range is below 1 (off from 1.1) drives another body by 5.
TEST(Scan, ARelayWithinALongStepSwitches) {
  for (const auto& integrator : kAdaptive) {
    auto spec = make_fly_by(-10, 10);
    spec.simulation.integrator = integrator;
    records::BodyRecord driven = spec.bodies[0];
    driven.name = "driven";
    driven.mass = 1;
    spec.bodies.push_back(driven);
    spec.hinges.push_back(make_hinge_record("slide", HingeType::Prismatic, "ground", "driven"));
    spec.controllers = {
        make_law("near", "gain", {"range"}, {{"gain", {-1}}}),
        make_law("relay", "relay", {"near"}, {{"on", {-1}}, {"off", {-1.1}}, {"value", {5}}, {"low", {0}}})};
    spec.actuators = {make_drive("drive", "slide", "relay")};
    const MemorySink sink = run(spec).sink;
    EXPECT_NEAR(get_last(sink, "/hinges/slide/qdot"), 5 * (std::sqrt(0.75) + std::sqrt(0.96)) / 10, 1e-8) << integrator;
  }
}

// Two balls of one mass meet head on, without a loss: the second one goes on with the rate of the first.
TEST(Scan, BallsWithinALongStepMeet) {
  for (const auto& integrator : kAdaptive) {
    auto spec = make_one_body(HingeType::Prismatic);
    spec.hinges[0].axis = {1, 0, 0};
    spec.hinges[0].rate = {100};
    add_copy(spec, "other", "far");
    spec.hinges[1].rate = {0};
    spec.hinges[1].position = {4};
    auto touch = make_contact("touch", records::ContactShape::Sphere, "body", 1e6);
    touch.to.body = "other";
    touch.radius = touch.to_radius = 0.1;
    spec.force_elements = {touch};
    spec.simulation.duration = 10;
    spec.simulation.output_step = 0.01;
    spec.simulation.integrator = integrator;
    const RunResult r = run(spec);
    EXPECT_TRUE(r.outcome.energy_is_kept) << integrator;
    EXPECT_NEAR(get_last(r.sink, "/hinges/far/qdot"), 100, 1e-3) << integrator;
    EXPECT_NEAR(get_last(r.sink, "/hinges/hinge/qdot"), 0, 1e-3) << integrator;
  }
}

// A ball thrown up against a ceiling just below the top of its way, which a step of a polynomial motion passes over.
TEST(Scan, AStopWithinALongStepIsMet) {
  for (const auto& integrator : kAdaptive) {
    auto spec = make_one_body(HingeType::Prismatic);
    spec.hinges[0].axis = {0, 0, 1};
    spec.hinges[0].rate = {10};
    spec.hinges[0].law.has_stops = true;
    spec.hinges[0].law.stop_upper = {4.99};
    spec.hinges[0].law.stop_restitution = {0.5};
    spec.simulation.gravity = {0, 0, -10};
    spec.simulation.duration = 2;
    spec.simulation.output_step = 0.01;
    spec.simulation.integrator = integrator;
    const MemorySink sink = run(spec).sink;
    const double v = std::sqrt(100 - 2 * 10 * 4.99), hit = (10 - v) / 10, rest = 2 - hit;
    ASSERT_EQ(sink.events().size(), 1u) << integrator;
    EXPECT_NEAR(sink.events()[0].time, hit, 1e-6) << integrator;
    EXPECT_NEAR(get_last(sink, "/hinges/hinge/q"), 4.99 - 0.5 * v * rest - 5 * rest * rest, 1e-6) << integrator;
  }
}

/// A ball on a soft floor with a relay, an event and a controller of the host, which counts its calls.
struct CountedRun {
  long calls = 0;
  SimulateOutcome outcome;
  int num_samples = 0;
};

CountedRun run_counted(const std::string& integrator) {
  CountedRun counted;
  ControllerFunctions f;
  f.language = "host";
  f.version = [] { return BOUGH_CONTROLLER_VERSION; };
  f.open = [](bough_controller* c) {
    c->outputs = 1;
    return 0;
  };
  f.outputs = [&counted](void*, double, const double* u, const double*, const double*, double* y) {
    ++counted.calls;
    y[0] = -0.1 * u[0];
    return 0;
  };
  const HostedController lent("host:count", f);
  auto spec = make_one_body(HingeType::Prismatic);
  spec.bodies[0].mass = 1;
  spec.hinges[0].axis = {0, 0, 1};
  spec.hinges[0].position = {1};
  auto floor = make_contact("floor", records::ContactShape::Plane, "body", 1e4);
  floor.normal = {0, 0, 1};
  floor.damping = 0.2;
  spec.force_elements = {floor};
  auto z = make_sensor("z", records::SensorType::HingeAngle, "", "hinge");
  spec.sensors = {z};
  spec.controllers = {
      make_law("host", "library", {"z"}),
      make_law("relay", "relay", {"z"}, {{"on", {0.6}}, {"off", {0.4}}, {"value", {0.5}}, {"low", {0}}}),
      make_law("both", "sum", {"host", "relay"})};
  spec.controllers[0].settings.words["file"] = {"host:count"};
  spec.actuators = {make_drive("drive", "hinge", "both")};
  auto low = make_trigger("low", "z", 0.2);
  low.direction = records::EventDirection::Falling;
  spec.events = {low};
  spec.simulation.duration = 3;
  spec.simulation.gravity = {0, 0, -9.81};
  spec.simulation.integrator = integrator;
  spec.simulation.step = integrator == "rk4" || integrator == "implicit" ? 1e-3 : 100;
  Diagnostics diagnostics;
  const System system = build_system(spec, {}, diagnostics);
  MemorySink sink;
  counted.calls = 0;
  counted.outcome = simulate(system, spec, sink, {}, diagnostics);
  counted.num_samples = sink.num_samples();
  EXPECT_GE(sink.events().size(), 2u);
  return counted;
}

TEST(Scan, ReportsTheEvaluationsThatItMakes) {
  for (const std::string integrator : {"adams", "bdf", "rk", "radau", "rk4", "implicit"}) {
    const CountedRun r = run_counted(integrator);
    EXPECT_EQ(r.calls, r.outcome.last.num_evaluations) << integrator;
  }
}

// One look at the end of each step and at each sample, a few at each change.
TEST(Scan, LooksOnceAtEachStep) {
  const CountedRun r = run_counted("adams");
  EXPECT_LT(r.calls, 3200);
  EXPECT_GT(r.outcome.last.num_steps, 900);
}

}  // namespace
}  // namespace bough::solver::testing
