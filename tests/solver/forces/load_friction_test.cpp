// Friction by bearing load against closed forms: it depends on reactions, these on accelerations, and those on it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "solver/builder/build_system.hpp"
#include "solver/linear/linearize.hpp"
#include "solver/system/derivative.hpp"
#include "tests/solver/support/malloc_count.hpp"
#include "tests/solver/support/runs.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;
constexpr double kG = 9.81;

records::SystemSpec make_block(double angle) {
  auto spec = make_one_body(HingeType::Prismatic);
  spec.hinges[0].axis = {1, 0, 0};
  spec.simulation.gravity = {kG * std::sin(angle), 0, -kG * std::cos(angle)};
  spec.simulation.integrator = "rk";
  spec.simulation.output_step = 0.01;
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-12;
  spec.hinges[0].law.has_friction = true;
  spec.hinges[0].law.mu = {0.2};
  return spec;
}

// A pendulum: mass m at l from a pin of radius r about y, inertia J about its centre; at rest it hangs along -z.
struct PinPendulum {
  double m = 1.3, l = 0.4, J = 0.05, mu = 0.35, r = 0.06;

  records::SystemSpec make() const {
    auto spec = make_one_body(HingeType::Revolute);
    spec.bodies[0].mass = m;
    spec.bodies[0].inertia = J * Matrix3d::Identity();
    spec.hinges[0].axis = {0, 1, 0};
    spec.hinges[0].child_position = {0, 0, l};
    spec.hinges[0].law.has_friction = true;
    spec.hinges[0].law.mu = {mu};
    spec.hinges[0].law.pin_radius = {r};
    spec.simulation.gravity = {0, 0, -kG};
    spec.simulation.integrator = "rk";
    spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-12;
    return spec;
  }

  /// (J + m l²) α = -m g l sin θ - s μ r N, N² = m² (l ω² + g cos θ)² + m² (l α + g sin θ)²: a quadratic in α; the
  /// root that is that without friction for μ = 0.
  double calc_acceleration(double theta, double omega, double side) const {
    const double I = J + m * l * l, c = side * mu * r, T = m * kG * l * std::sin(theta);
    const double radial = m * (l * omega * omega + kG * std::cos(theta));
    // (I α + T)² = c² (radial² + m² (l α + g sin θ)²), with I α + T of the sign of -c
    const double a = I * I - std::pow(c * m * l, 2), s = kG * std::sin(theta), b = I * T - c * c * m * m * l * s,
                 k = T * T - c * c * (radial * radial + m * m * s * s);
    return (-b - (c > 0 ? 1 : -1) * std::sqrt(b * b - a * k)) / a;
  }
};

double calc_pin_acceleration(const records::SystemSpec& spec, double theta, double omega) {
  const System system = build(spec);
  const auto data = system.make_data();
  data->tree.slide[0] = omega > 0 ? 1 : -1;
  VectorXd u_dot(1);
  calc_motion(system, *data, 0, VectorXd::Constant(1, theta), VectorXd::Constant(1, omega), VectorXd(), u_dot, [] {});
  return u_dot[0];
}

// tan of the angle against μ: it stays, or goes with g (sin - μ cos).
TEST(LoadFriction, ASlopeHoldsUpToItsAngle) {
  for (const double angle : {0.19, 0.21}) {
    const MemorySink sink = run_kept(make_block(angle));
    const double a = kG * (std::sin(angle) - 0.2 * std::cos(angle));
    EXPECT_NEAR(get_last(sink, "/hinges/hinge/q"), angle < 0.2 ? 0 : 0.5 * a, 1e-10);
  }
}

// Every method: the block stops at v²/2μg, and what it lost is what friction took.
TEST(LoadFriction, ABlockStopsAndStays) {
  for (const std::string integrator : {"rk", "adams", "bdf", "rk4", "implicit"}) {
    auto spec = make_block(0);
    spec.hinges[0].rate = {1.3};
    spec.simulation.integrator = integrator;
    spec.simulation.step = integrator == "rk4" || integrator == "implicit" ? 7e-3 : 0;
    if (integrator == "bdf") spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-11;
    const RunResult r = run(spec);
    EXPECT_NEAR(get_last(r.sink, "/hinges/hinge/q"), 1.3 * 1.3 / (2 * 0.2 * kG), 1e-8) << integrator;
    EXPECT_EQ(get_last(r.sink, "/hinges/hinge/qdot"), 0) << integrator;
    EXPECT_NEAR(get_last(r.sink, "/energy/dissipated"), 1.3 * 1.3, 1e-5) << integrator;
  }
}

// A block that slows down by a force h above its guides presses them apart: a = μ (g + |h a| / b).
TEST(LoadFriction, MomentsLoadAGuideByItsArms) {
  auto spec = make_block(0);
  spec.hinges[0].rate = {1};
  spec.hinges[0].child_position = {0, 0, -0.3};  // the guide lies below the centre of mass
  spec.hinges[0].law.bending_arm = {0.5};
  // Gravity on the guide, in line with it, makes no moment; the inertia force at 0.3 does: N = m (g + 0.3 a / 0.5).
  const double a = 0.2 * kG / (1 - 0.2 * 0.3 / 0.5);
  const MemorySink sink = run_kept(spec);
  EXPECT_NEAR(get_last(sink, "/hinges/hinge/q"), 1 / (2 * a), 1e-10);
  // Aside of it: about the axis.
  auto aside = make_block(0);
  aside.hinges[0].rate = {1};
  aside.hinges[0].child_position = {0, -0.3, 0};
  aside.hinges[0].law.reaction_arm = {0.5};
  // m g 0.3 about x loads it; the inertia force acts about z, across the axis, without an arm.
  EXPECT_NEAR(get_last(run_kept(aside), "/hinges/hinge/q"), 1 / (2 * 0.2 * kG * (1 + 0.3 / 0.5)), 1e-10);
}

TEST(LoadFriction, APinTakesTheAccelerationThatItCauses) {
  const PinPendulum p;
  for (const double theta : {-2.5, -0.4, 0.0, 0.7, 1.6, 3.0}) {
    for (const double omega : {-3.0, -0.2, 0.1, 4.0}) {
      EXPECT_NEAR(calc_pin_acceleration(p.make(), theta, omega), p.calc_acceleration(theta, omega, omega > 0 ? 1 : -1),
                  1e-12)
          << theta << " " << omega;
    }
  }
}

// Swings of the pendulum by fine steps of the closed form, from one turn of the rate to the next.
TEST(LoadFriction, APinBrakesAPendulum) {
  const PinPendulum p;
  auto spec = p.make();
  spec.hinges[0].position = {1.2};
  spec.simulation.duration = 1;
  const MemorySink sink = run_kept(spec);
  double theta = 1.2, omega = 0, side = -1;
  const int n = 20000;
  const double h = 1.0 / n;
  for (int i = 0; i < n; ++i) {
    const auto f = [&](double q, double u) { return p.calc_acceleration(q, u, side); };
    const double k1 = f(theta, omega), k2 = f(theta + h / 2 * omega, omega + h / 2 * k1),
                 k3 = f(theta + h / 2 * (omega + h / 2 * k1), omega + h / 2 * k2),
                 k4 = f(theta + h * (omega + h / 2 * k2), omega + h * k3);
    theta += h * omega + h * h / 6 * (k1 + k2 + k3);
    omega += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    if (omega * side < 0) side = -side;  // passes 0 to order h
  }
  EXPECT_NEAR(get_last(sink, "/hinges/hinge/q"), theta, 2e-5);
  EXPECT_GT(get_last(sink, "/energy/dissipated"), 0.1);
}

// A thrust bearing: the weight on its friction arm and a constant preload, against J α.
TEST(LoadFriction, AThrustBearingTurnsOnItsArm) {
  auto spec = make_one_body(HingeType::Revolute);
  spec.simulation.gravity = {0, 0, -kG};
  spec.simulation.integrator = "rk";
  spec.simulation.duration = 0.5;
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-12;
  spec.hinges[0].rate = {2};
  spec.hinges[0].law.has_friction = true;
  spec.hinges[0].law.coulomb = {0.3};
  spec.hinges[0].law.mu = {0.1};
  spec.hinges[0].law.friction_arm = {0.25};
  const double a = (0.3 + 0.1 * 0.25 * 2 * kG) / 3;
  EXPECT_NEAR(get_last(run_kept(spec), "/hinges/hinge/q"), 2 * 0.5 - 0.5 * a * 0.25, 1e-10);
}

// Static friction holds up to μ_s; the rate then falls to μ over stribeck_velocity.
TEST(LoadFriction, StaticFrictionFollowsTheLoad) {
  auto spec = make_block(0.25);
  spec.hinges[0].law.mu_static = {0.3};
  EXPECT_EQ(get_last(run(spec).sink, "/hinges/hinge/q"), 0);
  spec.simulation.gravity = {kG * std::sin(0.32), 0, -kG * std::cos(0.32)};
  EXPECT_NEAR(get_last(run_kept(spec), "/hinges/hinge/q"), 0.5 * kG * (std::sin(0.32) - 0.2 * std::cos(0.32)), 1e-10);
}

// Smooth friction has a linear model: -μ N / v_0 at rest.
TEST(LoadFriction, SmoothFrictionIsADamperAtRest) {
  auto spec = make_block(0);
  spec.hinges[0].law.smoothing = {0.05};
  const System system = build(spec);
  Plant plant(system);
  Diagnostics diagnostics;
  const auto model = linearize(plant, plant.make_initial_point(), {}, {}, diagnostics);
  EXPECT_NEAR(model.A(1, 1), -0.2 * kG / 0.05, 1e-9);
}

/// Crank, rod and slider; the loop is closed at one end of the rod or at the other.
records::SystemSpec make_slider_crank(bool is_cut_at_slider) {
  records::SystemSpec spec;
  for (const auto& [name, mass] : {std::pair{"crank", 0.7}, {"rod", 0.9}, {"slider", 1.4}}) {
    records::BodyRecord b;
    b.name = name;
    b.mass = mass;
    b.inertia = 0.02 * mass * Matrix3d::Identity();
    spec.bodies.push_back(b);
  }
  spec.bodies[0].cg = {0.1, 0, 0};
  spec.bodies[1].cg = {0.25, 0, 0};
  spec.hinges = {make_hinge_record("pin", HingeType::Revolute, "ground", "crank"),
                 make_hinge_record("guide", HingeType::Prismatic, "ground", "slider")};
  for (auto& h : spec.hinges) {
    h.parent_position = h.child_position = {0, 0, 0};
    h.parent_rotation = h.child_rotation = Matrix3d::Identity();
    h.stiffness = h.damping = {};
  }
  spec.hinges[0].axis = {0, 0, 1};
  spec.hinges[1].axis = {1, 0, 0};
  const double phi = 0.7, x = 0.2 * std::cos(phi) + std::sqrt(0.25 - std::pow(0.2 * std::sin(phi), 2));
  spec.hinges[0].position = {phi};
  spec.hinges[0].rate = {3};
  spec.hinges[1].position = {x};
  records::HingeRecord rod;
  records::ConstraintRecord loop;
  rod.name = "rod";
  loop.name = "loop";
  rod.child = "rod";
  if (is_cut_at_slider) {
    rod.type = HingeType::Universal;
    rod.parent = "crank";
    rod.parent_position = {0.2, 0, 0};
    rod.axis = {0, 0, 1};
    rod.axis2 = {0, 1, 0};
    rod.position = {-phi - std::asin(0.2 * std::sin(phi) / 0.5), 0};
    loop.hinge = HingeType::Spherical;
    loop.parent = "slider";
    loop.child = "rod";
    loop.child_position = {0.5, 0, 0};
  } else {
    rod.type = HingeType::Spherical;
    rod.parent = "slider";
    rod.child_position = {0.5, 0, 0};
    const double psi = -std::asin(0.2 * std::sin(phi) / 0.5);
    rod.position = {std::cos(psi / 2), 0, 0, std::sin(psi / 2)};
    loop.hinge = HingeType::Universal;
    loop.parent = "crank";
    loop.parent_position = {0.2, 0, 0};
    loop.child = "rod";
    loop.axis = {0, 0, 1};
    loop.axis2 = {0, 1, 0};
  }
  rod.is_guess = true;
  spec.hinges.push_back(rod);
  spec.constraints = {loop};
  for (const int i : {0, 1}) {
    auto& law = spec.hinges[static_cast<size_t>(i)].law;
    law.has_friction = true;
    law.mu = {0.25};
    law.bending_arm = {0.1};
    if (i == 0) law.pin_radius = {0.03};
  }
  spec.simulation.gravity = {0, -kG, 0};
  spec.simulation.integrator = "rk";
  spec.simulation.duration = 0.15;
  spec.simulation.output_step = 0.01;
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-11;
  return spec;
}

TEST(LoadFriction, ClosedLoopsFromEitherEndOfTheRod) {
  const MemorySink a = run_kept(make_slider_crank(true)), b = run_kept(make_slider_crank(false));
  auto smooth = make_slider_crank(true);
  for (auto& h : smooth.hinges) h.law = {};
  const MemorySink free = run_kept(smooth);
  for (const char* path : {"/hinges/pin/q", "/hinges/pin/qdot", "/hinges/guide/q"}) {
    EXPECT_NEAR(get_last(a, path), get_last(b, path), 1e-9) << path;
    EXPECT_GT(std::abs(get_last(a, path) - get_last(free, path)), 1e-3) << path;
  }
  EXPECT_NEAR(get_last(a, "/energy/dissipated"), get_last(b, "/energy/dissipated"), 1e-9);
  // The friction reported is μ times the load of the reaction reported; the guide sticks before the end.
  const MatrixXd rate = a.get("/hinges/guide/qdot"), q = a.get("/hinges/guide/force"),
                 f = a.get("/hinges/guide/reaction_force"), m = a.get("/hinges/guide/reaction_moment");
  int num_sticking = 0;
  for (int i = 0; i < a.num_samples(); ++i) {
    const double limit = 0.25 * (std::hypot(f(i, 1), f(i, 2)) + std::hypot(m(i, 1), m(i, 2)) / 0.1);
    if (rate(i, 0) != 0)
      EXPECT_NEAR(std::abs(q(i, 0)), limit, 1e-9) << i;
    else
      EXPECT_LE(std::abs(q(i, 0)), limit) << i;
    num_sticking += rate(i, 0) == 0 ? 1 : 0;
  }
  EXPECT_EQ(num_sticking, 1);
}

TEST(LoadFriction, NoAllocationInAnEvaluation) {
  if (get_malloc_count() < 0) GTEST_SKIP() << "malloc cannot be counted in this build";
  const System system = build(make_slider_crank(true));
  const auto data = system.make_data();
  VectorXd q(system.num_q()), u(system.num_u()), u_dot(system.num_u());
  system.calc_initial_state(q, u);
  for (const LoadFriction& f : system.load_frictions) data->tree.slide[f.u_row] = u[f.u_row] > 0 ? 1 : -1;
  const VectorXd z;
  const long before = get_malloc_count();
  for (int k = 0; k < 10; ++k) calc_motion(system, *data, 0, q, u, z, u_dot, [] {});
  EXPECT_EQ(get_malloc_count() - before, 0);
  EXPECT_GT(data->friction.load.minCoeff(), 0);
}

TEST(LoadFriction, AJointThatLocksItselfIsAnError) {
  PinPendulum p;
  p.mu = 3;
  p.r = 0.4;
  try {
    calc_pin_acceleration(p.make(), 1.2, 0.1);
    FAIL() << "expected solver.friction-jams";
  } catch (const ComputationError& e) {
    EXPECT_EQ(e.items()[0].id, "solver.friction-jams");
  }
}

TEST(LoadFriction, WrongArmsAreNamed) {
  const auto expect_error = [](const records::SystemSpec& spec, const std::string& part) {
    Diagnostics diagnostics;
    draft_system(spec, {}, diagnostics);
    EXPECT_EQ(diagnostics.num_errors(), 1) << part;
    bool is_found = false;
    for (const auto& item : diagnostics.items()) is_found = is_found || item.what.find(part) != std::string::npos;
    EXPECT_TRUE(is_found) << part;
  };
  auto pin = make_one_body(HingeType::Revolute);
  pin.hinges[0].law.has_friction = true;
  pin.hinges[0].law.mu = {0.1};
  expect_error(pin, "without an arm");
  pin.hinges[0].law.pin_radius = {0.1};
  pin.hinges[0].law.reaction_arm = {0.1};
  expect_error(pin, "reaction_arm, which is for travels");
  auto guide = make_block(0);
  guide.hinges[0].law.pin_radius = {0.1};
  expect_error(guide, "which are for angles");
  guide.hinges[0].law.pin_radius = {};
  guide.hinges[0].law.mu_static = {0.1};
  expect_error(guide, "mu_static below mu");
  auto screw = make_one_body(HingeType::Screw);
  screw.hinges[0].pitch = 0.1;
  screw.hinges[0].law.has_friction = true;
  screw.hinges[0].law.mu = {0.1};
  expect_error(screw, "one bearing per coordinate");
}

}  // namespace
}  // namespace bough::solver::testing
