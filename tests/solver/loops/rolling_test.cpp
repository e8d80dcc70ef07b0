// Constraints of rates (rolling, knife edge, rate coupler) against closed forms, and linear models about rolling.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "solver/builder/build_system.hpp"
#include "solver/linear/linearize.hpp"
#include "solver/statespace/poles.hpp"
#include "tests/solver/support/motions.hpp"
#include "tests/solver/support/runs.hpp"

namespace bough::solver::testing {
namespace {

using records::ConstraintType;
using records::HingeType;
constexpr double kG = 9.81;

/// A thin uniform disc of radius r about its y on the plane z = 0, upright: heading, lean, spin, then its centre.
struct Disc {
  double m = 1.7, r = 0.4;
  double k1 = r * r / 4, k3 = r * r / 2;  ///< squares of the radii of gyration: about a diameter, about the axis

  records::SystemSpec make() const {
    auto spec = make_one_body(HingeType::General);
    spec.bodies[0].mass = m;
    spec.bodies[0].inertia = m * Vector3d(k1, k3, k1).asDiagonal();
    spec.hinges[0].rotations = "zxy";
    spec.hinges[0].translations = "xyz";
    spec.simulation.gravity = {0, 0, -kG};
    spec.simulation.integrator = "rk";
    spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-11;
    spec.constraints = {make_contact()};
    return spec;
  }
  records::ConstraintRecord make_contact() const {
    records::ConstraintRecord c;
    c.name = "road";
    c.type = ConstraintType::Rolling;
    c.child = "body";
    c.axis = {0, 0, 1};
    c.axis2 = {0, 1, 0};
    c.radius = r;
    return c;
  }
};

// Ω² = g r tan θ / [(r + k3²/r) ρ + k1² sin θ]: the disc keeps its lean and comes back after a turn.
TEST(Rolling, ADiscTurnsSteadily) {
  const Disc d;
  const double theta = 0.35, rho = 1.1;
  const double omega = std::sqrt(kG * d.r * std::tan(theta) / ((d.r + d.k3 / d.r) * rho + d.k1 * std::sin(theta)));
  auto spec = d.make();
  spec.hinges[0].position = {0, -theta, 0, 0.3, -rho, d.r * std::cos(theta)};
  spec.hinges[0].rate = {omega, 0, omega * (rho + d.r * std::sin(theta)) / d.r, omega * rho, 0, 0};
  spec.simulation.duration = 2 * std::numbers::pi / omega;
  spec.simulation.output_step = spec.simulation.duration / 50;
  const MemorySink sink = run_kept(spec);
  for (int i = 0; i < sink.num_samples(); ++i) EXPECT_NEAR(sink.get("/hinges/hinge/q")(i, 1), -theta, 1e-6);
  EXPECT_NEAR(get_last(sink, "/hinges/hinge/q", 0), 2 * std::numbers::pi, 1e-6);
  EXPECT_NEAR(get_last(sink, "/hinges/hinge/q", 3), 0.3, 1e-5);
  EXPECT_NEAR(get_last(sink, "/hinges/hinge/q", 4), -rho, 1e-5);
  // The road carries the weight and the centripetal force.
  EXPECT_NEAR(get_last(sink, "/constraints/road/reaction_force", 2), d.m * kG, 1e-5);
  EXPECT_NEAR(get_last(sink, "/constraints/road/reaction_force", 1), d.m * omega * omega * rho, 1e-5);
}

// A wobbling disc moves the same on a hinge with a quaternion, and conserves energy.
TEST(Rolling, TheHingeDoesNotMatter) {
  const Disc d;
  auto spec = d.make();
  spec.hinges[0].position = {0.2, -0.3, 0.1, 0, 0, d.r * std::cos(0.3)};
  spec.hinges[0].rate = {1.5, 0.4, 5, 0, 0, 0};
  spec.simulation.duration = 1.5;
  auto other = spec;
  auto& h = other.hinges[0];
  h.type = HingeType::Free;
  h.rotations = h.translations = "";
  const Eigen::Quaterniond q(Eigen::AngleAxisd(0.2, Vector3d::UnitZ()) * Eigen::AngleAxisd(-0.3, Vector3d::UnitX()) *
                             Eigen::AngleAxisd(0.1, Vector3d::UnitY()));
  h.position = {q.w(), q.x(), q.y(), q.z(), 0, 0, d.r * std::cos(0.3)};
  const MemorySink first = run_kept(spec);
  const MatrixXd w = first.get("/bodies/body/angular_velocity"), v = first.get("/bodies/body/velocity");
  h.rate = {w(0, 0), w(0, 1), w(0, 2), v(0, 0), v(0, 1), v(0, 2)};
  const MemorySink second = run_kept(other);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(get_last(first, "/bodies/body/position", i), get_last(second, "/bodies/body/position", i), 1e-7);
  const double energy = get_last(first, "/energy/kinetic") + get_last(first, "/energy/potential");
  EXPECT_NEAR(energy, first.get("/energy/kinetic")(0, 0) + first.get("/energy/potential")(0, 0), 1e-8);
}

// A uniform ball on a turntable: its velocity turns at 2/7 of the rate of the table (Routh 1905).
TEST(Rolling, ABallCirclesOnATurntable) {
  const double r = 0.2, rate = 3.1;
  records::SystemSpec spec = make_one_body(HingeType::Revolute);
  spec.bodies[0].name = "table";
  spec.hinges[0].child = "table";
  spec.functions = {make_ramp("turn", rate)};
  spec.hinges[0].motion = {"turn"};
  records::BodyRecord ball;
  ball.name = "ball";
  ball.mass = 0.9;
  ball.inertia = 0.4 * ball.mass * r * r * Matrix3d::Identity();
  spec.bodies.push_back(ball);
  spec.hinges.push_back(make_hinge_record("flight", HingeType::Free, "ground", "ball"));
  auto& h = spec.hinges[1];
  h.parent_position = h.child_position = {0, 0, 0};
  h.parent_rotation = h.child_rotation = Matrix3d::Identity();
  h.stiffness = h.damping = {};
  h.position = {1, 0, 0, 0, 0.5, 0, r};
  h.rate = {};
  spec.constraints = {make_constraint("contact", ConstraintType::Rolling, "table", "ball")};
  spec.constraints[0].crown = r;
  spec.simulation.gravity = {0, 0, -kG};
  spec.simulation.duration = 3;
  spec.simulation.integrator = "rk";
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-11;
  const MemorySink sink = run_kept(spec, 1e-6);
  const Vector3d v0 = sink.get("/bodies/ball/velocity").row(0), p0 = sink.get("/bodies/ball/position").row(0);
  ASSERT_GT(v0.norm(), 0.1);
  const double w = 2.0 / 7 * rate, t = 3;
  const Vector3d p = p0 + std::sin(w * t) / w * v0 + (1 - std::cos(w * t)) / w * Vector3d::UnitZ().cross(v0);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(get_last(sink, "/bodies/ball/position", i), p[i], 1e-7);
}

// Chaplygin's sleigh: u = E tanh(a E t / D), D = k² + a², E² = u² + D ω².
TEST(KnifeEdge, ASleighTurnsIntoItsOwnLine) {
  auto spec = make_one_body(HingeType::Planar);
  const double a = 0.3, k2 = 0.05, m = 2, D = k2 + a * a, w0 = 1.7, E = std::sqrt(D) * w0;
  spec.bodies[0].mass = m;
  spec.bodies[0].cg = {a, 0, 0};
  spec.bodies[0].inertia = m * k2 * Matrix3d::Identity();
  spec.hinges[0].rate = {0, 0, w0};
  records::ConstraintRecord c;
  c.name = "blade";
  c.type = ConstraintType::KnifeEdge;
  c.child = "body";
  c.axis = {0, 1, 0};
  spec.constraints = {c};
  spec.simulation.duration = 2;
  spec.simulation.integrator = "rk";
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-11;
  const MemorySink sink = run_kept(spec);
  const double vx = get_last(sink, "/bodies/body/velocity", 0), vy = get_last(sink, "/bodies/body/velocity", 1);
  EXPECT_NEAR(std::hypot(vx, vy), E * std::tanh(a * E * 2 / D), 1e-8);
  EXPECT_NEAR(get_last(sink, "/hinges/hinge/qdot", 2), w0 / std::cosh(a * E * 2 / D), 1e-8);
}

// A coupler of rates of plain coordinates is a coupler of these; angular velocities have no coordinates.
TEST(RateCoupler, HoldsRates) {
  auto spec = make_one_body(HingeType::Universal);
  spec.hinges[0].axis = {1, 0, 0};
  spec.hinges[0].axis2 = {0, 1, 0};
  spec.hinges[0].position = {0.3, -0.2};
  spec.hinges[0].rate = {2, 0};
  spec.simulation.gravity = {0, 0, -kG};
  spec.bodies[0].cg = {0.1, 0.2, -0.3};
  spec.simulation.integrator = "rk";
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-11;
  records::ConstraintRecord c;
  c.name = "gear";
  c.type = ConstraintType::RateCoupler;
  c.terms = {{"hinge", 1, 1}, {"hinge", 2, 2.5}};
  spec.constraints = {c};
  auto other = spec;
  other.constraints[0].type = ConstraintType::Coupler;
  other.constraints[0].offset = 0.3 - 0.2 * 2.5;
  const MemorySink rates = run_kept(spec), positions = run_kept(other);
  for (int i = 0; i < 2; ++i)
    EXPECT_NEAR(get_last(rates, "/hinges/hinge/q", i), get_last(positions, "/hinges/hinge/q", i), 1e-9);

  auto ball = make_one_body(HingeType::Spherical);
  ball.bodies[0].cg = {0.1, 0.2, -0.3};
  ball.simulation = spec.simulation;
  ball.hinges[0].rate = {1, 2, 0};
  c.terms = {{"hinge", 3, 1}};
  ball.constraints = {c};
  const MemorySink sink = run_kept(ball);
  for (int i = 0; i < sink.num_samples(); ++i) EXPECT_NEAR(sink.get("/hinges/hinge/qdot")(i, 2), 0, 1e-12);
}

// Upright disc at speed v: λ² = [g - (1 + k3²/r²) k3² v²/(r k1²)]/((1 + k1²/r²) r); all other poles are 0.
TEST(RollingLinear, AnUprightDiscHasItsPoles) {
  const Disc d;
  for (const double v : {0.4, 1.0, 1.3, 3.0}) {
    auto spec = d.make();
    spec.hinges[0].position = {0.4, 0, 0, 0, 0, d.r};
    spec.hinges[0].rate = {0, 0, v / d.r, v * std::cos(0.4), v * std::sin(0.4), 0};
    const System system = build(spec);
    Plant plant(system);
    EXPECT_EQ(plant.num_dofs(), 3);
    EXPECT_EQ(plant.num_paths(), 2);
    Diagnostics diagnostics;
    const auto model = linearize(plant, plant.make_initial_point(), {}, {}, diagnostics);
    EXPECT_FALSE(diagnostics.has("linear.time-varying")) << v;
    const double square =
        (kG - (1 + d.k3 / (d.r * d.r)) * d.k3 * v * v / (d.r * d.k1)) / ((1 + d.k1 / (d.r * d.r)) * d.r);
    EXPECT_EQ(square<0, v * v> kG * d.r / 3) << v;
    std::vector<double> expected(8, 0.0), found;
    expected[0] = expected[1] = std::sqrt(std::abs(square));
    for (int i = 0; i < model.poles.size(); ++i) found.push_back(std::hypot(model.poles.real[i], model.poles.imag[i]));
    std::sort(found.rbegin(), found.rend());
    ASSERT_EQ(found.size(), expected.size());
    for (size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-7) << v << " " << i;
    double largest_imag = 0;
    for (int i = 0; i < model.poles.size(); ++i) largest_imag = std::max(largest_imag, model.poles.imag[i]);
    EXPECT_NEAR(largest_imag, square < 0 ? expected[0] : 0, 1e-7) << v;
  }
}

/// Whipple's bicycle of Meijaard et al. 2007: x forwards, y to the right, z down; frame, fork, two wheels.
records::SystemSpec make_bicycle(double speed) {
  records::SystemSpec spec;
  const auto add_body = [&](const char* name, double mass, const Vector3d& cg, const Matrix3d& inertia) {
    spec.bodies.push_back(make_body_record(name, mass, Vector3d::Zero(), cg));
    spec.bodies.back().inertia = inertia;
  };
  const auto add_hinge = [&](const char* name, HingeType type, const char* parent, const char* child) -> auto& {
    auto h = make_hinge_record(name, type, parent, child);
    h.parent_position = h.child_position = {0, 0, 0};
    h.parent_rotation = h.child_rotation = Matrix3d::Identity();
    h.stiffness = h.damping = h.position = h.rate = {};
    spec.hinges.push_back(h);
    return spec.hinges.back();
  };
  Matrix3d frame, fork;
  frame << 9.2, 0, 2.4, 0, 11, 0, 2.4, 0, 2.8;
  fork << 0.05892, 0, -0.00756, 0, 0.06, 0, -0.00756, 0, 0.00708;
  add_body("frame", 85, {0.3, 0, -0.9}, frame);
  add_body("rear", 2, {0, 0, 0}, Vector3d(0.0603, 0.12, 0.0603).asDiagonal());
  add_body("fork", 4, {0.9, 0, -0.7}, fork);
  add_body("front", 3, {0, 0, 0}, Vector3d(0.1405, 0.28, 0.1405).asDiagonal());
  auto& base = add_hinge("base", HingeType::General, "ground", "frame");
  base.rotations = "zxy";
  base.translations = "xyz";
  base.rate = {0, 0, 0, speed, 0, 0};
  auto& rear = add_hinge("rear_axle", HingeType::Revolute, "frame", "rear");
  rear.parent_position = {0, 0, -0.3};
  rear.axis = {0, 1, 0};
  auto& steer = add_hinge("steer", HingeType::Revolute, "frame", "fork");
  steer.parent_position = steer.child_position = {1.1, 0, 0};
  steer.axis = {std::sin(std::numbers::pi / 10), 0, std::cos(std::numbers::pi / 10)};
  auto& front = add_hinge("front_axle", HingeType::Revolute, "fork", "front");
  front.parent_position = {1.02, 0, -0.35};
  front.axis = {0, 1, 0};
  for (const auto& [name, radius] : {std::pair{"rear", 0.3}, {"front", 0.35}}) {
    records::ConstraintRecord c;
    c.name = std::string(name) + "_contact";
    c.type = ConstraintType::Rolling;
    c.child = name;
    c.axis = {0, 0, -1};
    c.axis2 = {0, 1, 0};
    c.radius = radius;
    spec.constraints.push_back(c);
  }
  spec.simulation.gravity = {0, 0, kG};
  spec.simulation.duration = 1;
  return spec;
}

// Table 2 of the benchmark, to its digits.
TEST(RollingLinear, AWhippleBicycleHasTheBenchmarkEigenvalues) {
  const System system = build(make_bicycle(5));
  Plant plant(system);
  EXPECT_EQ(plant.num_dofs(), 3);
  const auto model = linearize_start(plant);
  const std::vector<std::complex<double>> benchmark{{-14.078389692798, 0},
                                                    {-0.775341882195845, 4.464867713788},
                                                    {-0.775341882195845, -4.464867713788},
                                                    {-0.322866429004087, 0}};
  for (const auto& expected : benchmark) {
    double nearest = 1e9;
    for (int i = 0; i < model.poles.size(); ++i)
      nearest = std::min(nearest, std::abs(std::complex(model.poles.real[i], model.poles.imag[i]) - expected));
    EXPECT_LT(nearest, 1e-7) << expected;
  }
  int num_zero = 0;
  for (int i = 0; i < model.poles.size(); ++i)
    num_zero += std::hypot(model.poles.real[i], model.poles.imag[i]) < 1e-5 ? 1 : 0;
  EXPECT_EQ(num_zero, model.poles.size() - 4);
}

TEST(Rolling, WrongRadiiAreNamed) {
  auto spec = Disc().make();
  spec.constraints[0].radius = 0;
  Diagnostics diagnostics;
  draft_system(spec, {}, diagnostics);
  EXPECT_TRUE(diagnostics.has("system.bad-constraint"));
  spec.constraints[0].radius = 0.4;
  spec.constraints[0].axis2 = {0, 0, 0};
  Diagnostics others;
  draft_system(spec, {}, others);
  EXPECT_TRUE(others.has("system.zero-axis"));
}

}  // namespace
}  // namespace bough::solver::testing
