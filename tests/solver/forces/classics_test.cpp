// Elements of force in motion against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/solver/support/runs.hpp"

namespace bough::solver::testing {
namespace {

using records::ElementType;
using records::HingeType;
constexpr double kPi = std::numbers::pi;

records::BodyRecord make_ball(const std::string& name, double mass) {
  records::BodyRecord b;
  b.name = name;
  b.mass = mass;
  b.inertia = Matrix3d::Identity();
  return b;
}

/// One body on a hinge from ground.
records::SystemSpec make_spec(HingeType type, double mass = 2) {
  records::SystemSpec spec;
  spec.bodies = {make_ball("ball", mass)};
  spec.hinges = {make_hinge_record("h", type, "ground", "ball")};
  for (auto* v : {&spec.hinges[0].parent_position, &spec.hinges[0].child_position}) v->setZero();
  for (auto* R : {&spec.hinges[0].parent_rotation, &spec.hinges[0].child_rotation}) R->setIdentity();
  spec.hinges[0].axis = {0, 0, 1};
  spec.simulation.duration = 1;
  spec.simulation.output_step = 0.01;
  spec.simulation.integrator = "rk";
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-12;
  return spec;
}

records::ForceElementRecord make_element(ElementType type, const std::string& body) {
  records::ForceElementRecord e;
  e.name = "e";
  e.type = type;
  e.from.body = body;
  return e;
}

TEST(ForceClassics, TwoBallsOnASpringSwingAtTheReducedMass) {
  records::SystemSpec spec = make_spec(HingeType::Prismatic);
  spec.bodies = {make_ball("a", 2), make_ball("b", 3)};
  spec.hinges[0].child = "a";
  spec.hinges.push_back(spec.hinges[0]);
  spec.hinges[1].name = "g";
  spec.hinges[1].child = "b";
  spec.hinges[1].position = {1.3};
  auto e = make_element(ElementType::Spring, "a");
  e.to.body = "b";
  e.stiffness = 50;
  e.damping = 2;
  e.free_length = 1;
  spec.force_elements = {e};
  const MemorySink sink = run_kept(spec);
  const double m = 6.0 / 5, decay = e.damping / (2 * m), w = std::sqrt(e.stiffness / m - decay * decay);
  const VectorXd t = sink.time(), length = sink.get("/forces/e/length"), force = sink.get("/forces/e/force");
  const VectorXd rate = sink.get("/forces/e/rate");
  for (int i = 0; i < t.size(); ++i) {
    const double x = 0.3 * std::exp(-decay * t[i]) * (std::cos(w * t[i]) + decay / w * std::sin(w * t[i]));
    EXPECT_NEAR(length[i], 1 + x, 1e-10);
    EXPECT_NEAR(force[i], 50 * (length[i] - 1) + 2 * rate[i], 1e-10);
  }
  EXPECT_LT(sink.get("/momentum/linear").cwiseAbs().maxCoeff(), 1e-10);
}

TEST(ForceClassics, ACableOnlyPulls) {
  // Thrown up from a cable of length 1 at 3 m/s: rises free, falls, is caught.
  auto spec = make_spec(HingeType::Prismatic);
  spec.simulation.gravity = {0, 0, -9.81};
  spec.hinges[0].position = {-1};
  spec.hinges[0].rate = {3};
  auto e = make_element(ElementType::Spring, "ball");
  e.stiffness = 1e4;
  e.free_length = 1;
  e.sense = records::SpringSense::Tension;
  spec.force_elements = {e};
  spec.simulation.duration = 0.5;
  const MemorySink sink = run_kept(spec);
  const VectorXd t = sink.time(), q = sink.get("/hinges/h/q");
  for (int i = 0; i < t.size(); ++i) EXPECT_NEAR(q[i], -1 + 3 * t[i] - 9.81 / 2 * t[i] * t[i], 1e-9);
  EXPECT_EQ(sink.get("/forces/e/force").maxCoeff(), 0);
  spec.simulation.duration = 0.7;  // caught at 0.6116 s; half a swing takes 0.0444 s
  const MemorySink longer = run_kept(spec, 1e-8);
  EXPECT_GT(longer.get("/forces/e/force").maxCoeff(), 300);
  EXPECT_GE(longer.get("/forces/e/force").minCoeff(), 0);
}

TEST(ForceClassics, HertzImpact) {
  // δ_max = (5 m v²/(4 k))^(2/5), duration 2.9432 δ_max / v (Johnson, Contact Mechanics, 11.4).
  auto spec = make_spec(HingeType::Prismatic);
  const double m = 2, v = 0.8, k = 1e6;
  auto e = make_element(ElementType::Contact, "ball");
  e.normal = {0, 0, 1};
  e.radius = 0.1;
  e.stiffness = k;
  spec.force_elements = {e};
  spec.hinges[0].position = {0.1 + 0.01 * v};
  spec.hinges[0].rate = {-v};
  spec.simulation.duration = 0.04;
  spec.simulation.output_step = 1e-5;
  const MemorySink sink = run_kept(spec);
  const VectorXd t = sink.time(), gap = sink.get("/forces/e/gap"), force = sink.get("/forces/e/force");
  const double depth = std::pow(5 * m * v * v / (4 * k), 0.4);
  EXPECT_NEAR(-gap.minCoeff(), depth, 1e-6 * depth);
  EXPECT_NEAR(force.maxCoeff(), k * std::pow(depth, 1.5), 1e-6 * k * std::pow(depth, 1.5));
  EXPECT_NEAR(t[0], 0, 0);
  double begins = 0, ends = 0;  // where the gap crosses zero
  for (int i = 1; i < t.size(); ++i) {
    const double at = t[i] - (t[i] - t[i - 1]) * gap[i] / (gap[i] - gap[i - 1]);
    if (gap[i - 1] >= 0 && gap[i] < 0) begins = at;
    if (gap[i - 1] < 0 && gap[i] >= 0) ends = at;
  }
  EXPECT_NEAR(begins, 0.01, 1e-8);
  EXPECT_NEAR(ends - begins, 2.943275 * depth / v, 2e-6 * depth / v);
  EXPECT_NEAR(get_last(sink, "/hinges/h/qdot"), v, 1e-9);
}

TEST(ForceClassics, HuntAndCrossleyLoseWhatTheirLawSays) {
  // With v inwards, v dv/(1 + c v) is a function of δ alone: G(v0) = G(-v1), G(v) = v/c - ln(1 + c v)/c².
  auto spec = make_spec(HingeType::Prismatic);
  const double v0 = 0.8, c = 0.5;
  auto e = make_element(ElementType::Contact, "ball");
  e.normal = {0, 0, 1};
  e.stiffness = 1e5;
  e.damping = c;
  spec.force_elements = {e};
  spec.hinges[0].position = {0.01};
  spec.hinges[0].rate = {-v0};
  spec.simulation.duration = 0.1;
  spec.simulation.integrator = "adams";  // rk's error estimate does not see that δ^1.5 has no second derivative at 0
  const MemorySink sink = run_kept(spec, 1e-8);
  const double v1 = get_last(sink, "/hinges/h/qdot");
  const auto G = [&](double in) { return in / c - std::log(1 + c * in) / (c * c); };
  EXPECT_NEAR(G(v0), G(-v1), 1e-9);
  EXPECT_LT(v1, 0.9 * v0);
  EXPECT_NEAR(get_last(sink, "/energy/dissipated"), 0.5 * 2 * (v0 * v0 - v1 * v1), 1e-9);
}

TEST(ForceClassics, ASlidingBlockStopsWhereFrictionSays) {
  // ∫ √(v² + v_s²) dv = μ g x from v0 to 0.
  auto spec = make_spec(HingeType::Planar);
  spec.hinges[0].axis = {0, 0, 1};
  spec.hinges[0].type = HingeType::Free;
  spec.bodies[0].inertia = 1e6 * Matrix3d::Identity();
  auto e = make_element(ElementType::Contact, "ball");
  e.normal = {0, 0, 1};
  e.stiffness = 2 * 9.81 / 1e-3;  // sinks in by a millimetre
  e.exponent = 1;
  e.friction = 0.3;
  e.slip_velocity = 1e-3;
  spec.force_elements = {e};
  const double v0 = 1.5, vs = 1e-3;
  spec.simulation.gravity = {0, 0, -9.81};
  spec.hinges[0].position = {1, 0, 0, 0, 0, 0, -1e-3};
  spec.hinges[0].rate = {0, 0, 0, v0, 0, 0};
  spec.simulation.duration = 0.53;
  spec.simulation.integrator = "bdf";
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-10;
  const MemorySink sink = run_kept(spec, 1e-6);
  const double whole = (0.5 * v0 * std::sqrt(v0 * v0 + vs * vs) + 0.5 * vs * vs * std::asinh(v0 / vs)) / (0.3 * 9.81);
  EXPECT_NEAR(get_last(sink, "/bodies/ball/position", 0), whole, 2e-6);
  EXPECT_NEAR(get_last(sink, "/energy/dissipated"), 0.5 * 2 * v0 * v0, 1e-5);
  EXPECT_LT(std::abs(get_last(sink, "/bodies/ball/velocity", 0)), 1e-4);
}

/// Body on a circular orbit of radius 1 with μ = 1: period 2π.
records::SystemSpec make_orbit(double inclination, double turns) {
  auto spec = make_spec(HingeType::Free, 1);
  spec.hinges[0].position = {1, 0, 0, 0, 1, 0, 0};
  spec.hinges[0].rate = {0, 0, 0, 0, std::cos(inclination), std::sin(inclination)};
  auto e = make_element(ElementType::CentralGravity, "");
  e.mu = 1;
  spec.force_elements = {e};
  spec.simulation.duration = turns * 2 * kPi;
  spec.simulation.output_step = spec.simulation.duration / 1000;
  return spec;
}

TEST(ForceClassics, TheNodeOfAnOrbitDriftsByJ2) {
  // dΩ/dt = -3/2 n J2 (a/p)² cos i, first order in J2 (any textbook).
  const double i = 0.9, j2 = 1e-5, turns = 20;
  auto spec = make_orbit(i, turns);
  spec.bodies[0].inertia = 1e-12 * Matrix3d::Identity();
  spec.force_elements[0].j2 = j2;
  spec.force_elements[0].equator = 0.9;
  const MemorySink sink = run_kept(spec);
  const auto h = sink.get("/momentum/angular");
  const Eigen::Index n = h.rows() - 1;
  const double node = std::atan2(h(n, 0), -h(n, 1));  // of the line z × h
  const double expected = -1.5 * j2 * 0.81 * std::cos(i) * turns * 2 * kPi;
  EXPECT_NEAR(node, expected, 2e-3 * std::abs(expected));
  EXPECT_NEAR(h(n, 2), std::cos(i), 1e-11);  // about the poles nothing turns
}

TEST(ForceClassics, ADumbbellLibratesAtRootThree) {
  // Planar libration in a circular orbit: √(3 (Jy - Jx)/Jz) n for small angles, √3 n of a thin dumbbell.
  const double angle = 1e-3, size = 1e-5;
  auto spec = make_orbit(0, 3);
  spec.bodies[0].inertia = size * size * Vector3d(1e-3, 1, 1).asDiagonal();
  spec.hinges[0].position = {std::cos(angle / 2), 0, 0, std::sin(angle / 2), 1, 0, 0};
  spec.hinges[0].rate = {0, 0, 1, 0, 1, 0};
  spec.simulation.absolute_tolerance = 1e-14;
  spec.simulation.relative_tolerance = 1e-13;
  const MemorySink sink = run_kept(spec);
  const auto q = sink.get("/bodies/ball/quaternion"), p = sink.get("/bodies/ball/position");
  const VectorXd t = sink.time();
  for (int k = 0; k < t.size(); ++k) {
    const double turned = 2 * std::atan2(q(k, 3), q(k, 0)), orbit = std::atan2(p(k, 1), p(k, 0));
    const double pitch = std::remainder(turned - orbit, 2 * kPi);
    EXPECT_NEAR(pitch, angle * std::cos(std::sqrt(3 * 0.999) * t[k]), 3e-5 * angle);
  }
}

TEST(ForceClassics, DragOfAFallingBodyEndsAtItsSpeed) {
  auto spec = make_spec(HingeType::Prismatic);
  spec.simulation.gravity = {0, 0, -9.81};
  auto e = make_element(ElementType::Drag, "ball");
  e.area = 0.5;
  e.coefficient = 1.2;
  e.density = 1.1;
  spec.force_elements = {e};
  spec.simulation.duration = 3;
  const MemorySink sink = run_kept(spec);
  const double terminal = std::sqrt(2 * 2 * 9.81 / (0.5 * 1.2 * 1.1));
  EXPECT_NEAR(get_last(sink, "/hinges/h/qdot"), -terminal * std::tanh(9.81 * 3 / terminal), 1e-9);
  // A plate edge on feels none; with the wind a body is carried along.
  spec.force_elements[0].normal = {1, 0, 0};
  EXPECT_NEAR(get_last(run_kept(spec), "/hinges/h/qdot"), -9.81 * 3, 1e-9);
}

TEST(ForceClassics, DragBelowTheGroundIsAWarningAndAnEvent) {
  auto spec = make_spec(HingeType::Prismatic);
  spec.simulation.gravity = {0, 0, -9.81};
  spec.hinges[0].position = {1.2};
  auto planet = make_element(ElementType::CentralGravity, "");
  planet.name = "planet";
  planet.mu = 1e-12;
  planet.equator = 1;
  auto e = make_element(ElementType::Drag, "ball");
  e.area = 1e-6;
  e.coefficient = e.density = e.scale_height = 1;
  e.planet = "planet";
  spec.force_elements = {planet, e};
  spec.simulation.output_step = 0.01;
  const auto has_warning = [](const RunResult& r) { return r.diagnostics.has("run.below-ground"); };
  spec.simulation.duration = 0.2;  // the ground is reached at 0.2019
  EXPECT_FALSE(has_warning(run(spec)));
  spec.simulation.duration = 0.3;
  const RunResult r = run(spec);
  EXPECT_TRUE(r.outcome.completed);
  EXPECT_TRUE(has_warning(r));
  ASSERT_EQ(r.sink.events().size(), 1U);
  EXPECT_NEAR(r.sink.events()[0].time, 0.2019, 0.011);
}

TEST(ForceClassics, BushingOfOneBodyIsItsFrequencies) {
  // Diagonal bushing at the mass centre: small motions at √(k/m), √(k/J).
  auto spec = make_spec(HingeType::Free, 2);
  spec.bodies[0].inertia = Vector3d(1, 2, 3).asDiagonal();
  auto e = make_element(ElementType::Bushing, "ball");
  e.stiffness6.diagonal() << 2, 8, 18, 4, 18, 48;
  spec.force_elements = {e};
  const double a = 1e-5;
  spec.hinges[0].rate = {2 * a, 3 * a, 4 * a, a, 2 * a, 3 * a};
  const MemorySink sink = run_kept(spec, 1e-8);
  const double t = 1;
  const double w[6] = {1, 2, 3, 2, 3, 4};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(get_last(sink, "/forces/e/displacement", i), -a * (i + 1) * std::sin(w[i] * t) / w[i], 1e-9);
    EXPECT_NEAR(get_last(sink, "/forces/e/rotation", i), -a * (i + 2) * std::sin(w[3 + i] * t) / w[3 + i], 1e-9);
  }
}

}  // namespace
}  // namespace bough::solver::testing
