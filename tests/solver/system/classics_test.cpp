// Textbook motions against hand equations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "solver/simulate/memory_sink.hpp"
#include "solver/simulate/simulate.hpp"
#include "tests/solver/support/records.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;

records::BodyRecord make_rod(const std::string& name, double length, double mass) {
  records::BodyRecord r;
  r.name = name;
  r.mass = mass;
  r.cg = {length / 2, 0, 0};
  const double J = mass * length * length / 12;
  r.inertia = Vector3d(1e-3 * J, J, J).asDiagonal();
  return r;
}

TEST(Classics, Pendulum) {
  records::SystemSpec spec;
  spec.simulation.gravity = {0, -9.81, 0};
  spec.bodies = {make_rod("rod", 2, 3)};
  spec.hinges = {make_hinge_record("pin", HingeType::Revolute, "ground", "rod")};
  const System system = build(spec);
  auto data = system.make_data();
  const double angle = 0.4;
  const VectorXd u_dot = calc_u_dot(system, *data, 0, VectorXd::Constant(1, angle), VectorXd::Constant(1, 5.0));
  EXPECT_NEAR(u_dot[0], -1.5 * 9.81 / 2 * std::cos(angle), 1e-13);  // -m g L/2 cos θ / (m L²/3)
}

/// Point masses of 2 and 1.5 that hang 1.2 and 0.7 below their pins.
records::SystemSpec make_double_pendulum() {
  records::SystemSpec spec;
  spec.simulation.gravity = {0, -9.81, 0};
  spec.bodies = {make_body_record("a", 2, Vector3d::Zero(), {0, -1.2, 0}),
                 make_body_record("b", 1.5, Vector3d::Zero(), {0, -0.7, 0})};
  spec.hinges = {make_hinge_record("p", HingeType::Revolute, "ground", "a"),
                 make_hinge_record("r", HingeType::Revolute, "a", "b")};
  spec.hinges[1].parent_position = {0, -1.2, 0};
  return spec;
}

TEST(Classics, DoublePendulumOfPointMasses) {
  const double l1 = 1.2, l2 = 0.7, m1 = 2, m2 = 1.5, g = 9.81, th1 = 0.5, th2 = 1.1, w1 = 0.8, w2 = -1.4;
  const auto spec = make_double_pendulum();
  const System system = build(spec);
  auto data = system.make_data();
  const VectorXd u_dot = calc_u_dot(system, *data, 0, Eigen::Vector2d(th1, th2 - th1), Eigen::Vector2d(w1, w2 - w1));
  // Lagrange's equations in the absolute angles (any textbook).
  const double c = std::cos(th1 - th2), s = std::sin(th1 - th2);
  Eigen::Matrix2d M;
  M << (m1 + m2) * l1 * l1, m2 * l1 * l2 * c, m2 * l1 * l2 * c, m2 * l2 * l2;
  const Eigen::Vector2d f(-m2 * l1 * l2 * w2 * w2 * s - (m1 + m2) * g * l1 * std::sin(th1),
                          m2 * l1 * l2 * w1 * w1 * s - m2 * g * l2 * std::sin(th2));
  const Eigen::Vector2d expected = M.inverse() * f;
  EXPECT_NEAR(u_dot[0], expected[0], 1e-12);
  EXPECT_NEAR(u_dot[0] + u_dot[1], expected[1], 1e-12);
}

// Motion of 5 s, against its equations in long double by the classical Runge-Kutta method.
TEST(Classics, DoublePendulumSwingsTo1em10) {
  using Real = long double;
  using State = Eigen::Matrix<Real, 4, 1>;  // angles, rates
  const Real l1 = 1.2L, l2 = 0.7L, m1 = 2, m2 = 1.5L, g = 9.81L;
  auto spec = make_double_pendulum();
  spec.hinges[0].position = {1.1};
  spec.hinges[1].position = {0.5};
  spec.simulation.duration = 5;
  spec.simulation.output_step = 0.5;
  spec.simulation.integrator = "rk";
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-13;
  MemorySink sink;
  Diagnostics diagnostics;
  simulate(build(spec), spec, sink, {}, diagnostics);
  const auto rate = [&](const State& y) {
    const Real c = std::cos(y[0] - y[1]), s = std::sin(y[0] - y[1]);
    const Real a = (m1 + m2) * l1 * l1, b = m2 * l1 * l2 * c, d = m2 * l2 * l2;
    const Real f = -m2 * l1 * l2 * y[3] * y[3] * s - (m1 + m2) * g * l1 * std::sin(y[0]),
               h = m2 * l1 * l2 * y[2] * y[2] * s - m2 * g * l2 * std::sin(y[1]);
    const Real det = a * d - b * b;
    return State(y[2], y[3], (d * f - b * h) / det, (a * h - b * f) / det);
  };
  State y(1.1L, 1.6L, 0, 0);
  const int steps = 5000;  // a sample
  const Real h = 0.5L / steps;
  double worst = 0;
  for (int i = 0; i <= 10; ++i) {
    worst = std::max({worst, std::abs(sink.get("/hinges/p/q")(i, 0) - static_cast<double>(y[0])),
                      std::abs(sink.get("/hinges/r/q")(i, 0) - static_cast<double>(y[1] - y[0]))});
    for (int k = 0; k < steps; ++k) {
      const State k1 = rate(y), k2 = rate(y + h / 2 * k1), k3 = rate(y + h / 2 * k2), k4 = rate(y + h * k3);
      y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
  }
  EXPECT_LT(worst, 1e-10);
}

TEST(Classics, TorqueFreeSymmetricTopPrecesses) {
  records::SystemSpec spec;
  spec.bodies = {make_body_record("top", 1, {2, 2, 3})};
  const System system = build(spec);
  auto data = system.make_data();
  VectorXd q(7), u(6);
  system.calc_initial_state(q, u);
  u << 0.3, 0, 2, 0.1, 0.2, 0.3;  // w in the body, then the velocity
  const double rate = (3.0 - 2.0) / 2.0 * 2.0, duration = 3;
  const int steps = 3000;
  for (int k = 0; k < steps; ++k) step_rk4(system, *data, 0, duration / steps, q, u);
  EXPECT_NEAR(u[0], 0.3 * std::cos(rate * duration), 1e-11);
  EXPECT_NEAR(u[1], 0.3 * std::sin(rate * duration), 1e-11);
  EXPECT_NEAR(u[2], 2, 1e-13);
  EXPECT_LT((q.tail<3>() - duration * Vector3d(0.1, 0.2, 0.3)).norm(), 1e-12);
  // The symmetry axis circles the momentum at h / J.
  const Vector3d momentum(0.6, 0, 6);
  const Vector3d axis = calc_rotation_exp(duration / 2 * momentum) * Vector3d::UnitZ();
  calc_kinematics(system, *data, 0, q, u);
  EXPECT_LT((get_body_state(*data, 0).R_WB.col(2) - axis).norm(), 1e-10);
}

TEST(Classics, PrescribedSpinNeedsTheTorqueOfInverseDynamics) {
  records::SystemSpec spec;
  spec.simulation.gravity = {0, -9.81, 0};
  spec.bodies = {make_rod("rod", 2, 3)};
  spec.functions = {make_function("swing", "sine", {{"amplitude", 0.6}, {"omega", 2}, {"phase", 0}, {"offset", 0}})};
  spec.hinges = {make_hinge_record("pin", HingeType::Revolute, "ground", "rod")};
  spec.hinges[0].motion = {"swing"};
  const System system = build(spec);
  ASSERT_EQ(system.num_q(), 1);
  ASSERT_EQ(system.num_u(), 1);
  EXPECT_EQ(system.num_hinge_u(0), 0);
  EXPECT_EQ(system.num_hinge_rates(0), 1);
  auto data = system.make_data();
  const double t = 0.35, angle = 0.6 * std::sin(2 * t), acceleration = -2.4 * std::sin(2 * t);
  calc_u_dot(system, *data, t, VectorXd::Constant(1, 99.0), VectorXd::Constant(1, 99.0));  // rows that are not read
  VectorXd q(1), rate(1), torque(1);
  get_hinge(get_motion(system, *data), 0, q, rate, torque);
  EXPECT_NEAR(q[0], angle, 1e-15);
  EXPECT_NEAR(rate[0], 1.2 * std::cos(2 * t), 1e-15);
  EXPECT_NEAR(torque[0], 4 * acceleration + 3 * 9.81 * std::cos(angle), 1e-12);  // J = m L²/3 = 4
  VectorXd q_dot(1);
  calc_q_dot(system, *data, t, q, VectorXd::Zero(1), q_dot);
  EXPECT_EQ(q_dot[0], rate[0]);
}

TEST(Classics, SpringAndDamperOnASlider) {
  records::SystemSpec spec;
  spec.bodies = {make_rod("cart", 1, 2)};
  spec.hinges = {make_hinge_record("rail", HingeType::Prismatic, "ground", "cart")};
  auto& h = spec.hinges[0];
  h.stiffness = {50};
  h.damping = {3};
  h.null_position = {0.1};
  h.position = {0.4};
  h.rate = {-0.7};
  const System system = build(spec);
  auto data = system.make_data();
  VectorXd q(1), u(1);
  system.calc_initial_state(q, u);
  EXPECT_EQ(q[0], 0.4);
  EXPECT_EQ(u[0], -0.7);
  const double force = -50 * 0.3 + 3 * 0.7;
  EXPECT_NEAR(calc_u_dot(system, *data, 0, q, u)[0], force / 2, 1e-14);
  EXPECT_NEAR(calc_energies(system, *data).strain, 0.5 * 50 * 0.09, 1e-14);
  EXPECT_NEAR(calc_power(system, *data), -3 * 0.49, 1e-14);
  VectorXd shown(1), rate(1), shown_force(1);
  get_hinge(get_motion(system, *data), 0, shown, rate, shown_force);
  EXPECT_NEAR(shown_force[0], force, 1e-14);
}

// The chain that other multibody programs were run on: 50 links, hinge axes alternately z and -y.
TEST(Classics, ChainOfFiftyLinksEndsWhereOtherProgramsPutIt) {
  const int n = 50;
  records::SystemSpec spec;
  spec.simulation.gravity = {0, -9.81, 0};
  for (int i = 0; i < n; ++i) {
    const std::string name = "link" + std::to_string(i);
    auto body = make_rod(name, 1, 1);
    body.inertia = Vector3d(0.02, 1.01, 1.01).asDiagonal();
    body.inertia /= 12;
    body.nodes = {{1, Vector3d(1, 0, 0)}};
    spec.bodies.push_back(body);
    auto hinge = make_hinge_record("h" + std::to_string(i), HingeType::Revolute,
                                   i == 0 ? "ground" : "link" + std::to_string(i - 1), name);
    hinge.parent_node = i == 0 ? 0 : 1;
    hinge.axis = i % 2 == 0 ? Vector3d(0, 0, 1) : Vector3d(0, -1, 0);
    hinge.position = {0.01 * (i % 3)};
    spec.hinges.push_back(hinge);
  }
  const System system = build(spec);
  auto data = system.make_data();
  VectorXd q(n), u(n);
  system.calc_initial_state(q, u);
  for (int k = 0; k < 10000; ++k) step_rk4(system, *data, 1e-3 * k, 1e-3, q, u);
  calc_kinematics(system, *data, 10, q, u);
  const Vector3d end = calc_node_motion(system, *data, n - 1, system.find_node(n - 1, 1)).p_WK;
  EXPECT_LT((end - Vector3d(-1.245237, -42.443197, -1.853425)).cwiseAbs().maxCoeff(), 2e-6);
}

}  // namespace
}  // namespace bough::solver::testing
