// Rigid stops and dry friction against closed forms: bounces, rest, sticking and slipping at located times.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "solver/builder/build_system.hpp"
#include "solver/linear/linearize.hpp"
#include "solver/system/derivative.hpp"
#include "tests/solver/support/motions.hpp"
#include "tests/solver/support/runs.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;
using ::testing::HasSubstr;

records::SystemSpec make_slider(double mass = 2) {
  auto spec = make_one_body(HingeType::Prismatic);
  spec.bodies[0].mass = mass;
  spec.hinges[0].axis = {1, 0, 0};
  spec.simulation.output_step = 0.01;
  spec.simulation.integrator = "rk";
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-12;
  return spec;
}

/// A rod of mass 1.5 that turns on a slider of mass 2.
records::SystemSpec make_slider_with_rod() {
  auto spec = make_slider(2);
  spec.bodies.push_back(make_body_record("rod", 1.5, {0.1, 0.1, 0.1}, {0, 0.7, 0}));
  auto pin = make_hinge_record("pin", HingeType::Revolute, "body", "rod");
  pin.axis = {0, 0, 1};
  spec.hinges.push_back(pin);
  return spec;
}

void add_friction(records::HingeRecord& hinge, double coulomb, double static_friction = 0) {
  hinge.law.has_friction = true;
  hinge.law.coulomb = {coulomb};
  if (static_friction > 0) hinge.law.static_friction = {static_friction};
}

void add_stop(records::HingeRecord& hinge, double lower, double restitution) {
  hinge.law.has_stops = true;
  hinge.law.stop_lower = {lower};
  hinge.law.stop_restitution = {restitution};
}

int count_events(const MemorySink& sink, const std::string& part) {
  return static_cast<int>(std::count_if(sink.events().begin(), sink.events().end(),
                                        [&](const auto& e) { return e.what.find(part) != std::string::npos; }));
}

double find_event(const MemorySink& sink, const std::string& part) {
  for (const auto& e : sink.events()) {
    if (e.what.find(part) != std::string::npos) return e.time;
  }
  return -1;
}

// v = v0 - μg t until it stops at v0/μg, and it stays there: by every method.
TEST(DryFriction, ABlockStopsAndStays) {
  for (const std::string integrator : {"rk", "radau", "adams", "bdf", "rk4", "implicit"}) {
    auto spec = make_slider();
    const double v0 = 1.3, force = 5.3, a = force / 2;
    spec.hinges[0].rate = {v0};
    add_friction(spec.hinges[0], force);
    spec.simulation.integrator = integrator;
    spec.simulation.step = integrator == "rk4" || integrator == "implicit" ? 7e-3 : 0;
    const double tolerance = integrator == "bdf" ? 1e-8 : 1e-10;
    if (integrator == "bdf") spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-11;
    const RunResult r = run(spec);
    EXPECT_NEAR(find_event(r.sink, "sticks"), v0 / a, tolerance) << integrator;
    EXPECT_NEAR(get_last(r.sink, "/hinges/hinge/q"), v0 * v0 / (2 * a), tolerance) << integrator;
    EXPECT_EQ(get_last(r.sink, "/hinges/hinge/qdot"), 0) << integrator;
    // The quadrature of the work by adaptive multistep methods has the square root of the tolerance.
    const double quadrature = integrator == "bdf" || integrator == "adams" ? 1e-5 : 1e-9;
    EXPECT_NEAR(get_last(r.sink, "/energy/dissipated"), 0.5 * 2 * v0 * v0, quadrature) << integrator;
    EXPECT_LT(r.sink.energy_error(), quadrature) << integrator;
  }
}

// A slope holds a block up to tan of its angle; past it the block goes with g (sin - μ cos).
TEST(DryFriction, ASlopeHoldsUpToItsAngle) {
  for (const double angle : {0.19, 0.21}) {
    auto spec = make_slider(1);
    spec.simulation.gravity = {9.81 * std::sin(angle), 0, -9.81 * std::cos(angle)};
    const double hold = 0.2 * 9.81 * std::cos(angle);
    add_friction(spec.hinges[0], hold);
    const MemorySink sink = run(spec).sink;
    const double force = 9.81 * std::sin(angle) - hold;
    if (angle < 0.2) {
      EXPECT_EQ(get_last(sink, "/hinges/hinge/q"), 0);
      EXPECT_NEAR(get_last(sink, "/hinges/hinge/force"), -9.81 * std::sin(angle), 1e-12);
    } else {
      EXPECT_NEAR(get_last(sink, "/hinges/hinge/q"), 0.5 * force, 1e-10);
    }
  }
}

// An oscillator with dry friction loses 2 F/k of its amplitude each half swing and stops where the spring is too weak.
TEST(DryFriction, AnOscillatorLosesTheSameEachHalfSwing) {
  auto spec = make_slider(2);
  const double k = 50, F = 3, x0 = 0.73;
  spec.hinges[0].stiffness = {k};
  spec.hinges[0].position = {x0};
  add_friction(spec.hinges[0], F);
  spec.simulation.duration = 6;
  const MemorySink sink = run(spec).sink;
  double x = x0;
  int swings = 0;
  while (std::abs(x) > F / k) {
    x = -(x - std::copysign(2 * F / k, x));
    ++swings;
  }
  EXPECT_GT(swings, 4);
  EXPECT_NEAR(get_last(sink, "/hinges/hinge/q"), x, 1e-9);
  EXPECT_NEAR(find_event(sink, "sticks"), swings * std::numbers::pi / std::sqrt(k / 2), 1e-9);
}

// A mass on a belt: sticks until k x = F_s, slips with F_c about it, sticks again where the speeds agree.
TEST(DryFriction, ABeltDragsAMassByStickAndSlip) {
  auto spec = make_slider(1);
  const double k = 100, belt = 0.1, Fs = 4, Fc = 2, w = 10;
  add_copy(spec, "mass", "on_belt");
  spec.hinges[1].parent = "body";
  spec.functions = {make_ramp("belt", belt)};
  spec.hinges[0].motion = {"belt"};
  add_friction(spec.hinges[1], Fc, Fs);
  spec.force_elements = {make_spring("spring", "mass", {-10, 0, 0}, k, 10)};
  spec.simulation.duration = 4;
  for (const std::string integrator : {"rk", "rk4"}) {
    spec.simulation.integrator = integrator;
    spec.simulation.step = integrator == "rk4" ? 1e-3 : 0;
    const MemorySink sink = run(spec).sink;
    std::vector<double> slips;
    for (const auto& e : sink.events()) {
      if (e.what.find("slips") != std::string::npos) slips.push_back(e.time);
    }
    ASSERT_GE(slips.size(), 4u) << integrator;
    const double jump = (Fs - Fc) / k;
    const double period = 2 * jump / belt + 2 / w * (std::numbers::pi - std::atan(w * jump / belt));
    EXPECT_NEAR(slips[0], Fs / k / belt, 1e-9) << integrator;
    for (size_t i = 1; i < slips.size(); ++i) EXPECT_NEAR(slips[i] - slips[i - 1], period, 1e-6) << integrator;
  }
}

// Drops from h: times between impacts 2 e^n sqrt(2h/g), all of them over at sqrt(2h/g) (1 + e)/(1 - e): then rest.
TEST(RigidStop, ABallBouncesAndComesToRest) {
  for (const std::string integrator : {"rk", "radau", "bdf", "rk4", "implicit"}) {
    auto spec = make_slider(3);
    const double h = 0.4, g = 9.81, e = 0.6, first = std::sqrt(2 * h / g);
    spec.simulation.gravity = {-g, 0, 0};
    spec.hinges[0].position = {0.1 + h};
    add_stop(spec.hinges[0], 0.1, e);
    spec.simulation.duration = 2;
    spec.simulation.integrator = integrator;
    spec.simulation.step = integrator == "rk4" || integrator == "implicit" ? 0.01 : 0;
    if (integrator == "bdf") spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-10;
    const double tolerance = integrator == "bdf" ? 1e-6 : 1e-9;
    const RunResult r = run(spec);
    std::vector<double> hits;
    for (const auto& event : r.sink.events()) {
      if (event.what.find("meets its stop") != std::string::npos) hits.push_back(event.time);
    }
    ASSERT_GT(hits.size(), 10u) << integrator;
    double at = first;
    for (int n = 0; n < 8; ++n) {
      EXPECT_NEAR(hits[static_cast<size_t>(n)], at, tolerance) << integrator << n;
      at += 2 * std::pow(e, n + 1) * first;
    }
    EXPECT_NEAR(find_event(r.sink, "comes to rest at its stop"), first * (1 + e) / (1 - e),
                integrator == "bdf" ? 1e-4 : 1e-6)  // its tolerance is a bounce of 1e-5 s
        << integrator;
    EXPECT_NEAR(get_last(r.sink, "/hinges/hinge/q"), 0.1, 1e-9) << integrator;
    EXPECT_EQ(get_last(r.sink, "/hinges/hinge/qdot"), 0) << integrator;
    EXPECT_NEAR(get_last(r.sink, "/hinges/hinge/force"), 3 * g, 1e-9) << integrator;  // the stop carries it
    EXPECT_NEAR(get_last(r.sink, "/energy/dissipated"), 3 * g * h, 1e-6) << integrator;
  }
}

// A ball at rest at its stop leaves it when it is pulled away.
TEST(RigidStop, ABallIsLiftedOff) {
  auto spec = make_slider(1);
  spec.simulation.gravity = {-10, 0, 0};
  spec.hinges[0].position = {0.0};
  add_stop(spec.hinges[0], 0, 0.5);
  spec.functions = {make_function("lift", "ramp", {{"value", 20}, {"from", 0}, {"to", 1}})};
  spec.forces = {make_force("lift", "body", {1, 0, 0}, "lift")};
  const MemorySink sink = run(spec).sink;
  EXPECT_NEAR(find_event(sink, "leaves its stop"), 0.5, 1e-9);
  EXPECT_NEAR(get_last(sink, "/hinges/hinge/q"), 20 * std::pow(0.5, 3) / 6, 1e-9);
}

// A rod on a slide strikes a stop of the slide: the impulse goes along that coordinate alone, the momentum of the free
// angle holds. M = [m + M, m c cos; ., J + m c²].
TEST(RigidStop, TheRestOfTheSystemFollows) {
  auto spec = make_slider_with_rod();
  spec.hinges[0].rate = {-2};
  spec.hinges[0].position = {0.5};
  spec.hinges[1].rate = {0};
  add_stop(spec.hinges[0], 0, 0.25);
  spec.simulation.duration = 0.251;
  const RunResult r = run(spec);
  ASSERT_EQ(count_events(r.sink, "meets its stop"), 1);
  // At rest relative to the slide until then: x' = -2, angle 0.
  const double coupling = -1.5 * 0.7, J = 0.1 + 1.5 * 0.49;
  const double x = 0.5, angle = -coupling * (x + 2) / J;
  const int n = r.sink.num_samples() - 1;
  EXPECT_NEAR(r.sink.get("/hinges/hinge/qdot")(n, 0), x, 2e-2);
  EXPECT_NEAR(r.sink.get("/hinges/pin/qdot")(n, 0), angle, 2e-2);
  EXPECT_NEAR(get_last(r.sink, "/energy/kinetic"), 0.5 * (3.5 * x * x + 2 * coupling * x * angle + J * angle * angle),
              1e-8);
  EXPECT_LT(r.sink.energy_error(), 1e-9);
}

// In a loop the constraint answers too: a parallelogram's crank against a stop throws back all of it.
TEST(RigidStop, ALoopIsThrownBackWhole) {
  records::SystemSpec spec;
  for (const std::string name : {"a", "b", "bar"}) {
    spec.bodies.push_back(make_rod_record(name));
    spec.hinges.push_back(make_hinge_record(name, HingeType::Revolute, "ground", name));
  }
  spec.hinges[1].parent_position = {1, 0, 0};
  spec.hinges[2].parent = "a";
  spec.hinges[2].parent_node = 1;
  spec.hinges[0].position = spec.hinges[1].position = {1.0};
  spec.hinges[2].position = {-1.0};
  spec.hinges[0].rate = spec.hinges[1].rate = {-2};
  spec.hinges[2].rate = {2};
  add_stop(spec.hinges[0], 0.5, 0.5);
  records::ConstraintRecord c;
  c.name = "pin";
  c.hinge = HingeType::Revolute;
  c.parent = "bar";
  c.parent_node = 1;
  c.child = "b";
  c.child_node = 1;
  spec.constraints = {c};
  spec.simulation.duration = 0.4;
  spec.simulation.output_step = 0.1;
  spec.simulation.integrator = "rk";
  const RunResult r = run(spec);
  EXPECT_NEAR(find_event(r.sink, "meets its stop"), 0.25, 1e-9);
  for (const std::string name : {"a", "b"}) {
    EXPECT_NEAR(get_last(r.sink, "/hinges/" + name + "/qdot"), 1, 1e-9);
    EXPECT_NEAR(get_last(r.sink, "/hinges/" + name + "/q"), 0.65, 1e-9);
  }
  EXPECT_NEAR(get_last(r.sink, "/energy/kinetic"), 0.5 * (5.0 / 3) * 1, 1e-9);
}

// A block slides into a stop and rests there by friction; and by friction alone where it stops before.
TEST(JointContacts, StopAndFrictionOfOneCoordinate) {
  auto spec = make_slider(1);
  spec.hinges[0].position = {1};
  spec.hinges[0].rate = {-2};
  add_friction(spec.hinges[0], 1);
  add_stop(spec.hinges[0], 0, 0.5);
  spec.simulation.duration = 3;
  const MemorySink sink = run(spec).sink;
  const double v = std::sqrt(4 - 2), back = 0.5 * v;  // at the stop; from it
  EXPECT_NEAR(get_last(sink, "/hinges/hinge/q"), back * back / 2, 1e-9);
  EXPECT_NEAR(find_event(sink, "sticks"), (2 - v) + back, 1e-9);
}

// Beyond a rigid stop there is nowhere to go: said before the run, with the hinge's line; rounding is put on the stop.
TEST(RigidStop, AStartBeyondItIsAnError) {
  for (const double position : {-0.3, 1.3}) {
    auto spec = make_slider(1);
    spec.hinges[0].at = {"slider.toml", 12};
    spec.hinges[0].position = {position};
    add_stop(spec.hinges[0], 0, 0.5);
    spec.hinges[0].law.stop_upper = {1};
    Diagnostics diagnostics;
    draft_system(spec, {}, diagnostics);
    ASSERT_TRUE(diagnostics.has("system.beyond-stop")) << position;
    EXPECT_THAT(format(diagnostics.items()[0]),
                HasSubstr(position < 0 ? "slider.toml:12: error: coordinate 1 of hinge 'hinge' starts at -0.3, beyond "
                                         "its lower stop at 0"
                                       : "starts at 1.3, beyond its upper stop at 1"));
  }
}

TEST(RigidStop, AStartBeyondItByRoundingIsAtIt) {
  auto spec = make_slider(1);
  spec.simulation.gravity = {-10, 0, 0};
  spec.hinges[0].position = {0.5 * (1 - 1e-7)};
  add_stop(spec.hinges[0], 0.5, 0.5);
  const RunResult r = run(spec);
  EXPECT_EQ(r.diagnostics.num_errors(), 0);
  EXPECT_EQ(r.sink.get("/hinges/hinge/q")(0, 0), 0.5);
  EXPECT_EQ(get_last(r.sink, "/hinges/hinge/q"), 0.5);
}

// A prescribed motion may pass a stop, but nothing comes free behind one.
TEST(RigidStop, AReleaseBeyondItIsAnError) {
  auto spec = make_slider(1);
  records::FunctionRecord f;
  f.name = "ramp";
  f.type = "ramp";
  f.values = {{"value", 1}, {"from", 0}, {"to", 0.5}};
  spec.functions = {f};
  spec.hinges[0].motion = {"ramp"};
  add_stop(spec.hinges[0], -1, 0.5);
  spec.hinges[0].law.stop_upper = {0.25};
  records::UserEventRecord release;
  release.name = "free";
  release.time = 0.75;
  release.action = records::EventAction::Release;
  release.target = "hinge";
  spec.events = {release};
  try {
    run(spec);
    FAIL();
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.items().at(0).id, "run.beyond-stop");
    EXPECT_THAT(error.items().at(0).what, HasSubstr("beyond its stop at 0.25"));
  }
}

// A coordinate that sticks with a last rate takes along the momentum of other coordinates: a pendulum swings on a slide
// while its bounces die out, and no energy is lost without being booked.
TEST(RigidStop, TheLastBouncesKeepTheEnergy) {
  auto spec = make_slider_with_rod();
  spec.hinges[1].rate = {1.5};
  spec.hinges[0].position = {0.2};
  spec.simulation.gravity = {-9.81, 0, 0};
  add_stop(spec.hinges[0], 0, 0.4);
  spec.simulation.duration = 1;
  const RunResult r = run(spec);
  const double rest = find_event(r.sink, "comes to rest at its stop");
  ASSERT_GT(rest, 0);
  EXPECT_LT(r.sink.energy_error(), 1e-11);
}

TEST(JointContacts, AStopWithoutARoomIsAnErrorNotAHang) {
  auto spec = make_slider(1);
  spec.hinges[0].rate = {1};
  add_stop(spec.hinges[0], -1e-15, 1);
  spec.hinges[0].law.stop_upper = {1e-15};
  try {
    run(spec);
    FAIL();
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.items().at(0).id, "run.endless-impacts");
  }
}

TEST(JointContacts, LinearModelsSayThatTheyLeaveThemOut) {
  auto spec = make_slider(1);
  add_friction(spec.hinges[0], 1);
  Diagnostics diagnostics;
  warn_of_latches(build(spec), {}, diagnostics);
  EXPECT_TRUE(diagnostics.has("linear.latches-left-out"));
  spec.hinges[0].law.smoothing = {1e-3};
  Diagnostics none;
  warn_of_latches(build(spec), {}, none);
  EXPECT_TRUE(none.items().empty());
}

// The direction of sliding belongs to the state: without it an evaluation lacks the force of dry friction.
TEST(JointContacts, TheDirectionOfSlidingIsState) {
  auto spec = make_slider(2);
  add_friction(spec.hinges[0], 1.5);
  const System system = build(spec);
  State state = system.make_initial_state();
  VectorXd x_dot(system.layout().size());
  for (const double slide : {-1.0, 1.0}) {
    get_u(system.layout(), state.x)[0] = 3 * slide;
    state.discrete.slide = VectorXd::Constant(1, slide);
    auto data = system.make_data();
    set_modes(system, *data, state.discrete);
    EXPECT_EQ(get_discrete(*data).slide, state.discrete.slide);
    calc_derivative(system, *data, state.t, state.x, x_dot);
    EXPECT_NEAR(get_u(system.layout(), x_dot)[0], -slide * 1.5 / 2, 1e-14);
  }
}

TEST(JointContacts, AResumedRunGoesOn) {
  auto spec = make_slider(1);
  spec.simulation.gravity = {-10, 0, 0};
  spec.hinges[0].position = {0.5};
  add_stop(spec.hinges[0], 0, 0.5);
  spec.simulation.integrator = "rk4";
  spec.simulation.step = 0.01;
  spec.simulation.duration = 2;
  const RunResult whole = run(spec);
  ASSERT_FALSE(whole.sink.checkpoints().empty());
  SimulateOptions options;
  options.resume = whole.sink.checkpoints().front();
  const RunResult rest = run(spec, {}, options);
  EXPECT_EQ(get_last(rest.sink, "/hinges/hinge/q"), get_last(whole.sink, "/hinges/hinge/q"));
  EXPECT_EQ(get_last(rest.sink, "/hinges/hinge/force"), get_last(whole.sink, "/hinges/hinge/force"));
}

}  // namespace
}  // namespace bough::solver::testing
