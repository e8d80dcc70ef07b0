// Dry friction and rigid stops of systems with closed loops, against closed forms and the same system without a loop.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/solver/support/runs.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;

const std::vector<std::string> kIntegrators = {"rk", "radau", "bdf", "rk4"};

std::vector<double> find_events(const MemorySink& sink, const std::string& part) {
  std::vector<double> times;
  for (const auto& e : sink.events()) {
    if (e.what.find(part) != std::string::npos) times.push_back(e.time);
  }
  return times;
}

void set_integrator(records::SystemSpec& spec, const std::string& integrator) {
  auto& s = spec.simulation;
  s.integrator = integrator;
  s.step = integrator == "rk4" ? 5e-3 : 0;
  s.relative_tolerance = integrator == "bdf" ? 1e-11 : 1e-12;
  s.absolute_tolerance = s.relative_tolerance;
}

void set_run(records::SystemSpec& spec, const std::string& integrator, double duration, double output_step) {
  spec.simulation.duration = duration;
  spec.simulation.output_step = output_step;
  set_integrator(spec, integrator);
}

records::BodyRecord make_wheel(const std::string& name, double inertia, double mass = 1) {
  return make_body_record(name, mass, Vector3d::Constant(inertia));
}

void add_sine(records::SystemSpec& spec, const std::string& name, double amplitude, double omega) {
  spec.functions.push_back(make_function(name, "sine", {{"amplitude", amplitude}, {"omega", omega}}));
}

void add_load(records::SystemSpec& spec, records::ForceKind kind, const std::string& body, const Vector3d& direction,
              const std::string& function) {
  spec.forces.push_back(make_force("load " + body, body, direction, function, kind));
}

/// A parallelogram of cranks of length 1 (inertia 0.35 about their pins) and a bar of mass 2: together 2.7 about either
/// crank's pin. Names end with `id`; torque `function` on crank a.
void add_parallelogram(records::SystemSpec& spec, const std::string& id, const Vector3d& at,
                       const std::string& function) {
  for (const std::string name : {"a", "b"}) {
    auto crank = make_wheel(name + id, 0.1);
    crank.cg = {0, 0.5, 0};
    crank.nodes = {{1, {0, 1, 0}}};
    spec.bodies.push_back(crank);
  }
  auto bar = make_wheel("bar" + id, 0.5, 2);
  bar.cg = {1, 0, 0};
  bar.nodes = {{1, {2, 0, 0}}};
  spec.bodies.push_back(bar);
  auto a = make_hinge_record("a" + id, HingeType::Revolute, "ground", "a" + id);
  a.parent_position = at;
  auto b = make_hinge_record("b" + id, HingeType::Revolute, "ground", "b" + id);
  b.parent_position = at + Vector3d(2, 0, 0);
  auto c = make_hinge_record("c" + id, HingeType::Revolute, "a" + id, "bar" + id);
  c.parent_node = 1;
  for (const auto& hinge : {a, b, c}) spec.hinges.push_back(hinge);
  records::ConstraintRecord pin;
  pin.name = "pin" + id;
  pin.hinge = HingeType::Revolute;
  pin.parent = "bar" + id;
  pin.child = "b" + id;
  pin.parent_node = pin.child_node = 1;
  spec.constraints.push_back(pin);
  add_load(spec, records::ForceKind::Moment, "a" + id, {0, 0, 1}, function);
}

records::HingeRecord& get_hinge_record(records::SystemSpec& spec, const std::string& name) {
  for (auto& hinge : spec.hinges) {
    if (hinge.name == name) return hinge;
  }
  throw std::out_of_range(name);
}

void add_friction(records::HingeRecord& hinge, double coulomb) {
  hinge.law.has_friction = true;
  hinge.law.coulomb = {coulomb};
}

// A motor with dry friction that turns a wheel of inertia J2 by a gear of ratio 10 is one wheel of J1 + J2/100.
TEST(HeldCoordinate, AGearedMotorOvercomesItsFriction) {
  for (const auto& integrator : kIntegrators) {
    records::SystemSpec spec;
    spec.bodies = {make_wheel("motor", 0.01), make_wheel("wheel", 1)};
    spec.hinges = {make_hinge_record("motor", HingeType::Revolute, "ground", "motor"),
                   make_hinge_record("wheel", HingeType::Revolute, "ground", "wheel")};
    spec.hinges[1].parent_position = {1, 0, 0};
    add_friction(spec.hinges[0], 0.05);
    records::ConstraintRecord teeth;
    teeth.name = "teeth";
    teeth.type = records::ConstraintType::Coupler;
    teeth.terms = {{"motor", 1, 1.0}, {"wheel", 1, 10.0}};
    spec.constraints = {teeth};
    add_load(spec, records::ForceKind::Moment, "motor", {0, 0, 0.2}, "");
    set_run(spec, integrator, 2, 0.1);
    const MemorySink steady = run(spec).sink;
    EXPECT_NEAR(get_last(steady, "/hinges/motor/q"), 0.5 * 0.15 / 0.02 * 4, 1e-7) << integrator;
    // It swings, sticks and slips as the one wheel does.
    spec.forces[0].direction = {0, 0, 1};
    spec.forces[0].function = "torque";
    add_sine(spec, "torque", 0.06, 3);
    spec.simulation.duration = 6;
    records::SystemSpec one = spec;
    one.bodies = {make_wheel("motor", 0.02)};
    one.hinges.pop_back();
    one.constraints.clear();
    const MemorySink swings = run(spec).sink, expected = run(one).sink;
    EXPECT_LT((swings.get("/hinges/motor/q") - expected.get("/hinges/motor/q")).cwiseAbs().maxCoeff(), 1e-7)
        << integrator;
    const auto sticks = find_events(swings, "sticks"), as_one = find_events(expected, "sticks");
    ASSERT_EQ(sticks.size(), as_one.size()) << integrator;
    ASSERT_GE(sticks.size(), 5u) << integrator;
    for (size_t i = 0; i < sticks.size(); ++i) EXPECT_NEAR(sticks[i], as_one[i], 1e-6) << integrator << i;
  }
}

// A box on a rough rail does not depend on linkages that do not touch it: it slips at ½ asin(F/T) and moves by
// m x'' = T sin 2t - F sign x'.
TEST(HeldCoordinate, ABoxOnARailIsIndependentOfLinkages) {
  for (const auto& integrator : kIntegrators) {
    records::SystemSpec spec;
    add_sine(spec, "drive", 3, 2);
    add_sine(spec, "small", 0.5, 2);
    spec.bodies = {make_wheel("box", 1, 2)};
    auto rail = make_hinge_record("rail", HingeType::Prismatic, "ground", "box");
    rail.axis = {1, 0, 0};
    add_friction(rail, 0.5);
    spec.hinges = {rail};
    add_load(spec, records::ForceKind::Force, "box", {1, 0, 0}, "drive");
    set_run(spec, integrator, 6, 0.05);
    const MemorySink alone = run(spec).sink;
    const double slip = 0.5 * std::asin(0.5 / 3);
    EXPECT_NEAR(find_events(alone, "slips").at(0), slip, 1e-8) << integrator;
    for (int num = 1; num <= 2; ++num) {
      add_parallelogram(spec, std::to_string(num), {0, 5.0 * num, 0}, "small");
      const MemorySink beside = run(spec).sink;
      EXPECT_LT((beside.get("/hinges/rail/q") - alone.get("/hinges/rail/q")).cwiseAbs().maxCoeff(), 1e-7)
          << integrator << num;
      EXPECT_LT((beside.get("/hinges/rail/force") - alone.get("/hinges/rail/force")).cwiseAbs().maxCoeff(), 1e-7)
          << integrator << num;
      EXPECT_NEAR(find_events(beside, "hinge 'rail' slips").at(0), slip, 1e-8) << integrator << num;
      // The linkage has no friction: 2.7 q'' = 0.5 sin 2t.
      EXPECT_NEAR(get_last(beside, "/hinges/a1/q"), 0.5 / 2.7 * (3.0 - std::sin(12.0) / 4), 1e-7) << integrator;
    }
  }
}

// A box that -3 sin 2t presses on a rigid stop leaves it at π/2.
TEST(HeldCoordinate, ABoxLeavesItsStopBesideALinkage) {
  for (const auto& integrator : kIntegrators) {
    records::SystemSpec spec;
    add_sine(spec, "drive", -3, 2);
    spec.bodies = {make_wheel("box", 1, 2)};
    auto rail = make_hinge_record("rail", HingeType::Prismatic, "ground", "box");
    rail.axis = {1, 0, 0};
    rail.law.has_stops = true;
    rail.law.stop_lower = {0};
    rail.law.stop_restitution = {0};
    spec.hinges = {rail};
    add_load(spec, records::ForceKind::Force, "box", {1, 0, 0}, "drive");
    add_parallelogram(spec, "1", {0, 5, 0}, "drive");
    set_run(spec, integrator, 2, 0.05);
    const MemorySink sink = run(spec).sink;
    EXPECT_NEAR(find_events(sink, "leaves its stop").at(0), std::numbers::pi / 2, 1e-8) << integrator;
    // 2 v' = 3 sin 2s, s from the start.
    const double s = 2 - std::numbers::pi / 2;
    EXPECT_NEAR(get_last(sink, "/hinges/rail/q"), 1.5 * (s / 2 - std::sin(2 * s) / 4), 1e-7) << integrator;
  }
}

// Friction at both cranks acts as their sum at one: 2.7 q'' = 3 sin 2t - 2 sign q', slips at ½ asin(2/3), wherever the
// loop is cut and whichever crank has the larger share.
TEST(HeldCoordinate, FrictionAtTwoCranksAddsUp) {
  records::SystemSpec one;
  add_sine(one, "drive", 3, 2);
  one.bodies = {make_wheel("wheel", 2.7)};
  one.hinges = {make_hinge_record("wheel", HingeType::Revolute, "ground", "wheel")};
  add_friction(one.hinges[0], 2);
  add_load(one, records::ForceKind::Moment, "wheel", {0, 0, 1}, "drive");
  one.simulation.duration = 6;
  one.simulation.output_step = 0.05;
  for (const auto& integrator : kIntegrators) {
    set_integrator(one, integrator);
    const MatrixXd expected = run(one).sink.get("/hinges/wheel/q");
    for (const double share : {0.5, 1.5, 1.0}) {
      records::SystemSpec spec;
      spec.simulation = one.simulation;
      add_sine(spec, "drive", 3, 2);
      add_parallelogram(spec, "", {0, 0, 0}, "drive");
      add_friction(get_hinge_record(spec, "a"), share);
      add_friction(get_hinge_record(spec, "b"), 2 - share);
      const MemorySink sink = run(spec).sink;
      EXPECT_LT((sink.get("/hinges/a/q") - expected).cwiseAbs().maxCoeff(), 1e-7) << integrator << share;
      EXPECT_LT((sink.get("/hinges/b/q") - expected).cwiseAbs().maxCoeff(), 1e-7) << integrator << share;
      const double slip = 0.5 * std::asin(2.0 / 3);
      double last = 0;
      for (const double t : find_events(sink, "slips")) last = t < 1 ? std::max(last, t) : last;
      EXPECT_NEAR(last, slip, 1e-8) << integrator << share;
    }
  }
}

// A flexible arm on a rough hinge, its motor as a body behind a gear of ratio 3 or as rotor_inertia of the hinge.
TEST(HeldCoordinate, AFlexibleArmBehindAGear) {
  PointBody points = make_point_body(3, 11);
  records::FlexBody file = points.make_record("arm");
  records::BodyRecord arm;
  arm.name = "arm";
  arm.file = "arm.h5";
  const std::map<std::string, records::FlexBody> flex = {{"arm.h5", file}};
  records::SystemSpec one;
  one.bodies = {arm};
  one.hinges = {make_hinge_record("root", HingeType::Revolute, "ground", "arm")};
  add_friction(one.hinges[0], 0.4);
  add_sine(one, "drive", 1, 2);
  add_load(one, records::ForceKind::Moment, "arm", {0, 0, 1}, "drive");
  one.simulation.duration = 4;
  one.simulation.output_step = 0.05;
  records::SystemSpec geared = one;
  one.hinges[0].law.rotor_inertia = {0.2 * 9};
  geared.bodies.push_back(make_wheel("motor", 0.2));
  geared.hinges.push_back(make_hinge_record("motor", HingeType::Revolute, "ground", "motor"));
  records::ConstraintRecord teeth;
  teeth.name = "teeth";
  teeth.type = records::ConstraintType::Coupler;
  teeth.terms = {{"motor", 1, 1.0}, {"root", 1, -3.0}};
  geared.constraints = {teeth};
  for (const auto& integrator : kIntegrators) {
    set_integrator(one, integrator);
    set_integrator(geared, integrator);
    one.simulation.step = geared.simulation.step = integrator == "rk4" ? 5e-4 : 0;
    const MemorySink expected = run(one, flex).sink, sink = run(geared, flex).sink;
    EXPECT_GT(expected.get("/hinges/root/q").cwiseAbs().maxCoeff(), 0.01);
    EXPECT_GE(find_events(expected, "slips").size(), 1u);
    EXPECT_EQ(find_events(expected, "slips").size(), find_events(sink, "slips").size()) << integrator;
    EXPECT_LT((sink.get("/hinges/root/q") - expected.get("/hinges/root/q")).cwiseAbs().maxCoeff(), 1e-6) << integrator;
    EXPECT_LT((sink.get("/bodies/arm/eta") - expected.get("/bodies/arm/eta")).cwiseAbs().maxCoeff(), 1e-6)
        << integrator;
    EXPECT_LT((sink.get("/hinges/motor/q") - 3 * sink.get("/hinges/root/q")).cwiseAbs().maxCoeff(), 1e-9) << integrator;
  }
}

}  // namespace
}  // namespace bough::solver::testing
