// Rigid stops that are met at one moment: the impulses against every choice of what is struck, a blow along a row of
// balls, what falls flat.
#include "solver/system/impact.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/solver/support/runs.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;

TEST(Impact, ImpulsesAreThoseOfTheOneChoiceThatFits) {
  Random random(23);
  for (int n = 1; n <= 6; ++n) {
    for (int trial = 0; trial < 40; ++trial) {
      const MatrixXd root = MatrixXd::NullaryExpr(n, n, [&] { return random(); });
      const MatrixXd A = root * root.transpose() + 0.05 * MatrixXd::Identity(n, n);
      VectorXd v = random.vector_n(n), e = random.vector_n(n).cwiseAbs();
      v[0] = -std::abs(v[0]);
      const VectorXd found = solve_impact_lcp(A, v, e);
      VectorXd expected;
      for (int choice = 0; choice < 1 << n; ++choice) {
        std::vector<int> struck;
        for (int i = 0; i < n; ++i) {
          if (choice >> i & 1) struck.push_back(i);
        }
        VectorXd p = VectorXd::Zero(n);
        const VectorXd wanted = -(1 + e.array()) * v.array();
        if (!struck.empty()) p(struck) = VectorXd(MatrixXd(A(struck, struck)).ldlt().solve(VectorXd(wanted(struck))));
        if (p.minCoeff() >= 0 && (A * p - wanted).minCoeff() >= -1e-10) expected = p;
      }
      ASSERT_EQ(expected.size(), n);
      EXPECT_LT((found - expected).norm(), 1e-9 * (1 + expected.norm()));
    }
  }
}

TEST(Impact, WhatIsHeldTwiceSharesTheImpulse) {
  const VectorXd p =
      solve_impact_lcp(MatrixXd::Constant(4, 4, 0.5), VectorXd::Constant(4, -2), VectorXd::Constant(4, 0.5));
  EXPECT_LT((p - VectorXd::Constant(4, 1.5)).norm(), 1e-12);
}

/// Balls on a line, each on a slide on the one before it that they cannot pass; all but the first touch, it comes with
/// speed 2 from 0.5 away.
records::SystemSpec make_cradle(const std::vector<double>& masses, double restitution) {
  records::SystemSpec spec;
  for (size_t i = 0; i < masses.size(); ++i) {
    records::BodyRecord ball;
    ball.name = "b" + std::to_string(i);
    ball.mass = masses[i];
    ball.inertia = Matrix3d::Identity();
    spec.bodies.push_back(ball);
    auto slide =
        make_hinge_record(ball.name, HingeType::Prismatic, i == 0 ? "ground" : spec.bodies[i - 1].name, ball.name);
    slide.axis = {1, 0, 0};
    slide.position = {i == 1 ? 0.5 : 0.0};
    slide.rate = {i == 0 ? 2.0 : i == 1 ? -2.0 : 0.0};
    if (i > 0) {
      slide.law.has_stops = true;
      slide.law.stop_lower = {0};
      slide.law.stop_restitution = {restitution};
    }
    spec.hinges.push_back(slide);
  }
  spec.simulation.duration = 0.5;
  spec.simulation.output_step = 0.1;
  spec.simulation.integrator = "rk";
  spec.simulation.at = {"system.toml", 1, 1};
  return spec;
}

std::vector<double> get_speeds(const MemorySink& sink, size_t n) {
  std::vector<double> speeds;
  for (size_t i = 0; i < n; ++i) speeds.push_back(get_last(sink, "/bodies/b" + std::to_string(i) + "/velocity"));
  return speeds;
}

TEST(Impact, NewtonsCradle) {
  const std::vector<double> masses(5, 1.5);
  const RunResult r = run(make_cradle(masses, 1));
  const auto speeds = get_speeds(r.sink, 5);
  for (size_t i = 0; i < 5; ++i) EXPECT_NEAR(speeds[i], i == 4 ? 2 : 0, 1e-12) << i;
  EXPECT_LT(r.sink.energy_error(), 1e-12);
  EXPECT_EQ(std::count_if(r.sink.events().begin(), r.sink.events().end(),
                          [](const auto& e) { return e.what.find("meets its stop") != std::string::npos; }),
            4);
}

// Unequal balls: impacts between two at a time, until they part.
TEST(Impact, ABlowTravelsAlongUnequalBalls) {
  const std::vector<double> masses = {3, 1, 2, 0.7};
  const double e = 0.8;
  const RunResult r = run(make_cradle(masses, e));
  std::vector<double> v = {2, 0, 0, 0};
  for (bool has_met = true; has_met;) {
    has_met = false;
    for (size_t i = 0; i + 1 < v.size(); ++i) {
      const double into = v[i] - v[i + 1];
      if (into <= 1e-12) continue;
      const double impulse = (1 + e) * into * masses[i] * masses[i + 1] / (masses[i] + masses[i + 1]);
      v[i] -= impulse / masses[i];
      v[i + 1] += impulse / masses[i + 1];
      has_met = true;
    }
  }
  const auto speeds = get_speeds(r.sink, 4);
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(speeds[i], v[i], 1e-12) << i;
  EXPECT_LT((r.sink.get("/momentum/linear").col(0).array() - 6).abs().maxCoeff(), 1e-12);
}

// Nothing drives them together afterwards, and with little restitution the blows between them would be endless.
TEST(Impact, BallsThatDoNotBounceGoOnTogether) {
  for (const double e : {0.0, 0.05}) {
    const RunResult r = run(make_cradle({3, 1, 2, 1, 1}, e));
    ASSERT_TRUE(r.outcome.completed) << e;
    const auto speeds = get_speeds(r.sink, 5);
    if (e == 0) {
      for (const double speed : speeds) EXPECT_NEAR(speed, 6.0 / 8, 1e-9);
      EXPECT_EQ(get_last(r.sink, "/hinges/b4/qdot"), 0);
      EXPECT_NEAR(get_last(r.sink, "/energy/dissipated"), 6 - 0.5 * 8 * 0.75 * 0.75, 1e-9);
    }
    for (size_t i = 0; i + 1 < 5; ++i) EXPECT_LE(speeds[i], speeds[i + 1] + 1e-8) << e;
    EXPECT_LT((r.sink.get("/momentum/linear").col(0).array() - 6).abs().maxCoeff(), 1e-9);
    EXPECT_LT(r.sink.energy_error(), 1e-9);
  }
}

/// A box on four feet, sliders that a kink each lies on, falls flat from 0.4 above them; J as of no brick, so that
/// one kink's blow would throw the others about.
records::SystemSpec make_table(double restitution) {
  records::SystemSpec spec;
  records::BodyRecord box;
  box.name = "box";
  box.mass = 3;
  box.inertia = Vector3d(0.2, 0.5, 0.6).asDiagonal();
  int id = 0;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.3, 0.3}) box.nodes.push_back({++id, {x, y, 0}});
  spec.bodies = {box};
  auto free = make_hinge_record("box", HingeType::Free, "ground", "box");
  free.position = {1, 0, 0, 0, 0, 0, 0.4};
  spec.hinges = {free};
  for (int foot = 1; foot <= 4; ++foot) {
    records::BodyRecord b;
    b.name = "foot" + std::to_string(foot);
    b.mass = 0.01;
    spec.bodies.push_back(b);
    auto slide = make_hinge_record(b.name, HingeType::Prismatic, "ground", b.name);
    slide.position = {0.4};
    slide.law.has_stops = true;
    slide.law.stop_lower = {0};
    slide.law.stop_restitution = {restitution};
    spec.hinges.push_back(slide);
    records::ConstraintRecord on;
    on.name = "on" + std::to_string(foot);
    on.type = records::ConstraintType::PointOnPlane;
    on.parent = b.name;
    on.child = "box";
    on.child_node = foot;
    spec.constraints.push_back(on);
  }
  spec.simulation.gravity = {0, 0, -9.81};
  spec.simulation.duration = 1.5;
  spec.simulation.output_step = 0.01;
  spec.simulation.integrator = "rk";
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-11;
  spec.simulation.at = {"system.toml", 1, 1};
  return spec;
}

TEST(Impact, WhatFallsFlatBouncesFlatAndRestsOnAllFours) {
  const double h = 0.4, g = 9.81, e = 0.5, first = std::sqrt(2 * h / g), weight = 3.04 * g;
  const RunResult r = run(make_table(e));
  ASSERT_TRUE(r.outcome.completed);
  const MatrixXd w = r.sink.get("/bodies/box/angular_velocity"), p = r.sink.get("/bodies/box/position");
  EXPECT_LT(w.cwiseAbs().maxCoeff(), 1e-8);
  const VectorXd t = r.sink.time();
  for (int i = 0; i < t.size(); ++i) {  // as a ball
    double from = 0, speed = 0, z = h - 0.5 * g * t[i] * t[i];
    for (from = first, speed = e * g * first; from < t[i] && speed > 1e-9; from += 2 * speed / g, speed *= e)
      z = speed * (t[i] - from) - 0.5 * g * std::pow(t[i] - from, 2);
    EXPECT_NEAR(p(i, 2), speed > 1e-9 ? z : 0, 1e-6) << t[i];
  }
  double sum = 0;
  for (int foot = 1; foot <= 4; ++foot) {
    const double force = get_last(r.sink, "/hinges/foot" + std::to_string(foot) + "/force");
    EXPECT_NEAR(force, weight / 4, 1e-6 * weight);
    sum += force;
  }
  EXPECT_NEAR(sum, weight, 1e-9 * weight);
  EXPECT_LT(r.sink.energy_error(), 1e-8);
}

}  // namespace
}  // namespace bough::solver::testing
