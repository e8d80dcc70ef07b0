// Stops, friction, preload, tables and motors of hinge coordinates against closed forms; what is refused.
#include "solver/forces/hinge_law.hpp"
#include "solver/builder/build_system.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/solver/support/runs.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;
constexpr double kPi = std::numbers::pi;

records::SystemSpec make_spec(HingeType type, double mass = 2, double J = 1) {
  records::SystemSpec spec;
  records::BodyRecord body;
  body.name = "body";
  body.mass = mass;
  body.inertia = J * Matrix3d::Identity();
  body.at = {"s.toml", 3};
  spec.bodies = {body};
  records::HingeRecord hinge;
  hinge.name = "h";
  hinge.type = type;
  hinge.child = "body";
  hinge.at = {"s.toml", 8};
  spec.hinges = {hinge};
  spec.simulation.duration = 1;
  spec.simulation.output_step = 0.01;
  spec.simulation.integrator = "rk";
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-12;
  return spec;
}

records::FunctionRecord make_table(std::vector<double> x, std::vector<double> y) {
  records::FunctionRecord f;
  f.name = "table";
  f.type = "table";
  f.interpolation = "cubic";
  f.x = std::move(x);
  f.y = std::move(y);
  return f;
}

TEST(HingeLaw, AStopThrowsBackByItsLaw) {
  for (const double side : {1.0, -1.0}) {
    auto spec = make_spec(HingeType::Prismatic);
    const double v0 = 0.8, c = 0.4;
    spec.hinges[0].rate = {side * v0};
    spec.hinges[0].law.has_stops = true;
    spec.hinges[0].law.stop_lower = {-0.2};
    spec.hinges[0].law.stop_upper = {0.2};
    spec.hinges[0].law.stop_stiffness = {2e4};
    spec.hinges[0].law.stop_damping = {c};
    spec.simulation.duration = 0.4;
    const MemorySink sink = run_kept(spec);
    const double v1 = -side * get_last(sink, "/hinges/h/qdot");
    // v dv/(1 + c v) is a function of the depth alone.
    const auto G = [&](double in) { return in / c - std::log(1 + c * in) / (c * c); };
    EXPECT_NEAR(G(v0), G(-v1), 1e-10);
    EXPECT_LT(v1, 0.9 * v0);
    EXPECT_NEAR(get_last(sink, "/energy/dissipated"), v0 * v0 - v1 * v1, 1e-10);
  }
}

TEST(HingeLaw, AStopWithoutDampingKeepsTheEnergy) {
  auto spec = make_spec(HingeType::Prismatic);
  spec.simulation.gravity = {0, 0, -9.81};
  spec.hinges[0].position = {0.1};
  spec.hinges[0].law.has_stops = true;
  spec.hinges[0].law.stop_lower = {0};
  spec.hinges[0].law.stop_stiffness = {2e4};
  const MemorySink sink = run_kept(spec);
  EXPECT_GT(sink.get("/energy/strain").maxCoeff(), 1.9);
  EXPECT_EQ(get_last(sink, "/energy/dissipated"), 0);
}

TEST(HingeLaw, CoulombFrictionBrings) {
  // J ω̇ = -F tanh(ω/v): sinh(ω/v) = sinh(ω0/v) exp(-F t/(J v)).
  auto spec = make_spec(HingeType::Revolute, 2, 1.5);
  const double w0 = 2, F = 6, v = 0.3;
  spec.hinges[0].rate = {w0};
  spec.hinges[0].law.has_friction = true;
  spec.hinges[0].law.coulomb = {F};
  spec.hinges[0].law.smoothing = {v};
  const MemorySink sink = run_kept(spec);
  const VectorXd t = sink.time(), w = sink.get("/hinges/h/qdot");
  for (int i = 0; i < t.size(); ++i)
    EXPECT_NEAR(w[i], v * std::asinh(std::sinh(w0 / v) * std::exp(-F * t[i] / (1.5 * v))), 1e-10);
}

TEST(HingeLaw, ABeltDragsAMassByStickAndSlip) {
  // Stick until k x = F_s, slip about F_c/k until the speeds agree again: the period of the piecewise linear motion.
  auto spec = make_spec(HingeType::Prismatic, 1);
  add_copy(spec, "mass", "on_belt");
  spec.hinges[1].parent = "body";
  for (auto& hinge : spec.hinges) hinge.axis = {1, 0, 0};
  const double k = 100, belt = 0.1, Fs = 4, Fc = 2, w = 10;
  records::FunctionRecord motion = make_table({0, 100}, {0, 100 * belt});
  motion.interpolation = "linear";
  spec.functions = {motion};
  spec.hinges[0].motion = {"table"};
  auto& law = spec.hinges[1].law;
  law.has_friction = true;
  law.coulomb = {Fc};
  law.static_friction = {Fs};
  law.stribeck_velocity = {2e-4};
  law.smoothing = {2e-6};
  spec.force_elements = {make_spring("spring", "mass", {-1, 0, 0}, k, 1)};
  spec.simulation.duration = 4;
  spec.simulation.output_step = 1e-3;
  spec.simulation.integrator = "bdf";
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-11;
  const MemorySink sink = run_kept(spec, 1e-3);  // the tolerance of work is the root of the absolute tolerance
  const VectorXd t = sink.time(), v = sink.get("/bodies/mass/velocity").col(0);
  const VectorXd length = sink.get("/forces/spring/length");
  std::vector<double> falls;  // it moves back from here on
  for (int i = 1; i < t.size(); ++i) {
    if (v[i - 1] >= 0 && v[i] < 0) falls.push_back(t[i] - (t[i] - t[i - 1]) * v[i] / (v[i] - v[i - 1]));
  }
  ASSERT_GE(falls.size(), 4u);
  const double jump = (Fs - Fc) / k;
  const double period = 2 * jump / belt + 2 / w * (kPi - std::atan(w * jump / belt));
  const double measured = (falls.back() - falls[1]) / static_cast<double>(falls.size() - 2);
  EXPECT_NEAR(measured, period, 0.01 * period);
  EXPECT_NEAR(length.maxCoeff() - 1, Fc / k + std::hypot(jump, belt / w), 0.01 * Fs / k);
}

TEST(HingeLaw, ACubicSpringByTableHasDuffingsPeriod) {
  // ẍ = -x³ from A: T = 7.41629871 / A.
  auto spec = make_spec(HingeType::Prismatic, 1);
  const double A = 1.5;
  spec.functions = {make_table({-2, -1, 1, 2}, {-8, -1, 1, 8})};
  spec.hinges[0].law.spring_table = {"table"};
  spec.hinges[0].position = {A};
  spec.simulation.duration = 7.416298709205487 / A;
  const MemorySink sink = run_kept(spec);
  EXPECT_NEAR(get_last(sink, "/hinges/h/q"), A, 1e-9);
  EXPECT_NEAR(get_last(sink, "/hinges/h/qdot"), 0, 1e-9);
}

TEST(HingeLaw, AQuadraticDamperByTableAndAPreload) {
  auto spec = make_spec(HingeType::Prismatic, 2);  // 2 v̇ = -v²
  spec.functions = {make_table({0, 1, 2, 3}, {0, 1, 4, 9})};
  spec.hinges[0].law.damper_table = {"table"};
  spec.hinges[0].rate = {3};
  EXPECT_NEAR(get_last(run_kept(spec), "/hinges/h/qdot"), 3 / (1 + 3.0 / 2), 1e-10);
  spec.hinges[0].law.damper_table.clear();
  spec.hinges[0].law.preload = {-5};
  EXPECT_NEAR(get_last(run_kept(spec), "/hinges/h/q"), 3 - 5.0 / 2 / 2, 1e-10);
}

TEST(HingeLaw, ARotorIsInertiaOfItsCoordinate) {
  // Rod of length 1 and mass 2 on a geared motor: (m l²/3 + J n²) θ̈ = -m g l/2 sin θ.
  auto spec = make_spec(HingeType::Revolute, 2, 2.0 / 12);
  spec.bodies[0].cg = {0, -0.5, 0};
  spec.simulation.gravity = {0, -9.81, 0};
  spec.hinges[0].law.rotor_inertia = {1e-3};
  spec.hinges[0].law.gear_ratio = {50};
  const System system = build(spec);
  auto data = system.make_data();
  const VectorXd q = VectorXd::Constant(1, 0.4), u = VectorXd::Zero(1);
  const double whole = 2.0 / 3 + 2.5;
  EXPECT_NEAR(calc_u_dot(system, *data, 0, q, u)[0], -9.81 * std::sin(0.4) / whole, 1e-13);
  VectorXd dense(1);
  calc_accelerations_dense(system, *data, 0, dense);
  EXPECT_NEAR(dense[0], -9.81 * std::sin(0.4) / whole, 1e-13);
  spec.hinges[0].position = {0.4};
  run_kept(spec);
  // Driven, the motor turns it too: torque and energy.
  records::FunctionRecord angle = make_table({0, 1, 2, 3}, {0, 0.5, 2, 4.5});
  spec.functions = {angle};
  spec.hinges[0].motion = {"table"};
  spec.hinges[0].position.clear();
  spec.simulation.gravity.setZero();
  const MemorySink sink = run_kept(spec);
  EXPECT_NEAR(sink.get("/hinges/h/force")(50, 0), whole, 1e-9);
  EXPECT_NEAR(get_last(sink, "/energy/kinetic"), 0.5 * whole, 1e-9);
}

std::string build_error(const records::SystemSpec& spec) {
  Diagnostics diagnostics;
  draft_system(spec, {}, diagnostics);
  std::string ids;
  for (const auto& item : diagnostics.items())
    if (item.severity == Severity::Error) ids += item.id + " ";
  return ids;
}

TEST(HingeLaw, WhatMakesNoSenseIsRefused) {
  const auto plain = make_spec(HingeType::Revolute);
  const auto error_of = [&](const auto& change) {
    auto spec = plain;
    change(spec.hinges[0]);
    return build_error(spec);
  };
  EXPECT_EQ(error_of([](auto&) {}), "");
  EXPECT_EQ(error_of([](auto& h) {
              h.type = HingeType::Spherical, h.law.preload = {1, 1, 1};
            }),
            "system.bad-hinge-law ");
  EXPECT_EQ(error_of([](auto& h) { h.law.has_stops = true, h.law.stop_upper = {1}; }), "system.bad-hinge-law ");
  EXPECT_EQ(error_of([](auto& h) {
              h.law.has_stops = true, h.law.stop_upper = {-1}, h.law.stop_lower = {1}, h.law.stop_stiffness = {1};
            }),
            "system.bad-hinge-law ");
  EXPECT_EQ(error_of([](auto& h) { h.law.has_friction = true, h.law.coulomb = {1}; }), "");  // dry
  EXPECT_EQ(error_of([](auto& h) { h.law.has_stops = true, h.law.stop_upper = {1}, h.law.stop_restitution = {1.5}; }),
            "system.bad-hinge-law ");
  EXPECT_EQ(error_of([](auto& h) {
              h.law.has_stops = true, h.law.stop_upper = {1}, h.law.stop_restitution = {0.5};
              h.law.stop_stiffness = {1};
            }),
            "system.bad-hinge-law ");
  EXPECT_EQ(error_of([](auto& h) { h.law.preload = {1, 2}; }), "system.bad-count ");
  EXPECT_EQ(error_of([](auto& h) { h.law.spring_table = {"tabel"}; }), "system.unknown-function ");
  auto spec = plain;
  spec.functions = {make_table({0, 1}, {0, 1})};
  spec.functions[0].type = "constant";
  spec.functions[0].x.clear();
  spec.functions[0].y.clear();
  spec.functions[0].values = {{"value", 1}};
  spec.hinges[0].law.spring_table = {"table"};
  EXPECT_EQ(build_error(spec), "system.not-a-table ");
}

TEST(ForceElements, WhatMakesNoSenseIsRefused) {
  const auto plain = make_spec(HingeType::Free);
  records::ForceElementRecord spring;
  spring.name = "e";
  spring.from.body = "body";
  spring.stiffness = 1;
  spring.to.position = {1, 0, 0};
  const auto error_of = [&](const auto& change) {
    auto spec = plain;
    spec.force_elements = {spring};
    change(spec.force_elements[0]);
    return build_error(spec);
  };
  using records::ElementType;
  EXPECT_EQ(error_of([](auto&) {}), "");
  EXPECT_EQ(error_of([](auto& e) { e.from.body = "ground"; }), "system.one-end ");
  EXPECT_EQ(error_of([](auto& e) { e.to.body = "body", e.to.position.setZero(); }), "system.one-end ");
  EXPECT_EQ(error_of([](auto& e) { e.to.body = "boby"; }), "system.unknown-body ");
  EXPECT_EQ(error_of([](auto& e) { e.to.node = 4; }), "system.unknown-node ");
  EXPECT_EQ(error_of([](auto& e) { e.stiffness = -1; }), "system.bad-force ");
  EXPECT_EQ(error_of([](auto& e) { e.type = ElementType::Contact; }), "system.bad-force ");  // no normal
  EXPECT_EQ(error_of([](auto& e) { e.type = ElementType::CentralGravity; }), "system.bad-force ");
  EXPECT_EQ(error_of([](auto& e) { e.type = ElementType::Bushing, e.stiffness6(0, 1) = 1; }), "system.bad-force ");
  EXPECT_EQ(error_of([](auto& e) { e.type = ElementType::Drag, e.area = -1; }), "system.bad-force ");
}

TEST(ForceElements, ABushingEndsAtHalfATurn) {
  auto spec = make_spec(HingeType::Revolute);
  records::ForceElementRecord e;
  e.name = "mount";
  e.type = records::ElementType::Bushing;
  e.from.body = "body";
  e.stiffness6.diagonal().setConstant(1e-3);
  spec.force_elements = {e};
  spec.hinges[0].rate = {4};
  EXPECT_EQ(run_to_failure<ComputationError>(spec).at(0).id, "solver.bushing-past-half-turn");
}

}  // namespace
}  // namespace bough::solver::testing
