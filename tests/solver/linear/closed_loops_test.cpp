// Linear models and equilibria of closed loops: minimal coordinates.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/linear/equilibrium.hpp"
#include "solver/linear/linearize.hpp"
#include "tests/solver/support/models.hpp"
#include "tests/solver/support/motions.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;

constexpr double kLength = 0.8, kSpan = 1.3, kRod = 0.6, kCoupler = 2.5, kG = 9.81;

records::BodyRecord make_rod(const std::string& name, const Vector3d& end, double mass) {
  records::BodyRecord rod;
  rod.name = name;
  rod.mass = mass;
  rod.cg = end / 2;
  rod.inertia = mass / 12 * (end.squaredNorm() * Matrix3d::Identity() - end * end.transpose());
  rod.nodes = {{1, end}};
  return rod;
}

/// Two cranks that hang side by side and a coupler between them, which stays level: it goes round as a point does.
records::SystemSpec make_parallelogram(double angle) {
  records::SystemSpec spec;
  spec.simulation.gravity = {0, -kG, 0};
  spec.bodies = {make_rod("left", {0, -kLength, 0}, kRod), make_rod("right", {0, -kLength, 0}, kRod),
                 make_rod("coupler", {kSpan, 0, 0}, kCoupler)};
  spec.hinges = {make_hinge_record("a", HingeType::Revolute, "ground", "left"),
                 make_hinge_record("b", HingeType::Revolute, "ground", "right"),
                 make_hinge_record("c", HingeType::Revolute, "left", "coupler")};
  spec.hinges[1].parent_position = {kSpan, 0, 0};
  spec.hinges[2].parent_node = 1;
  spec.hinges[0].position = spec.hinges[1].position = {angle};
  spec.hinges[2].position = {-angle};
  records::ConstraintRecord state;
  state.name = "d";
  state.hinge = HingeType::Revolute;
  state.parent = "right";
  state.child = "coupler";
  state.parent_node = state.child_node = 1;
  spec.constraints = {state};
  return spec;
}

double calc_omega() {
  const double moment = kCoupler * kLength + 2 * kRod * kLength / 2;
  const double inertia = kCoupler * kLength * kLength + 2 * kRod * kLength * kLength / 3;
  return std::sqrt(kG * moment / inertia);
}

TEST(ClosedLoops, SwingAtTheirFrequency) {
  const System system = build(make_parallelogram(0));
  Plant plant(system);
  EXPECT_EQ(plant.num_dofs(), 1);
  const auto model = linearize_start(plant);
  ASSERT_EQ(model.poles.size(), 2);
  EXPECT_NEAR(model.poles.real.cwiseAbs().maxCoeff(), 0, 1e-8);
  EXPECT_NEAR(model.poles.imag.maxCoeff(), calc_omega(), 1e-8);
  EXPECT_LT(model.error, 1e-7);
}

TEST(ClosedLoops, AccelerateAsTheMultipliersSayAndRestWhereTheyHang) {
  const System system = build(make_parallelogram(0.7));
  Plant plant(system);
  const auto start = plant.make_initial_point();
  // The angle of whatever was chosen goes as that of the pendulum, or against it.
  EXPECT_NEAR(std::abs(plant.evaluate(start)[0]), std::pow(calc_omega(), 2) * std::sin(0.7), 1e-9);
  const auto found = find_equilibrium(plant, start, {"loop.toml"});
  EXPECT_TRUE(found.unstable.empty());
  EXPECT_NEAR(std::remainder(found.point.q[0], 2 * M_PI), 0, 1e-8);
  EXPECT_NEAR(std::remainder(found.point.q[2], 2 * M_PI), 0, 1e-8);
}

// At a rate the neighbours of a motion keep to the loop: the difference quotient of the whole in both directions.
TEST(ClosedLoops, AreExactInMotion) {
  auto spec = make_parallelogram(0.7);
  spec.hinges[0].rate = spec.hinges[1].rate = {1.1};
  spec.hinges[2].rate = {-1.1};
  spec.hinges[0].damping = {0.4};
  const System system = build(spec);
  Plant plant(system);
  const auto model = linearize_start(plant);
  // φ̈ = -ω² sin φ - c/I φ̇
  const double inertia = kCoupler * kLength * kLength + 2 * kRod * kLength * kLength / 3;
  EXPECT_NEAR(model.A(1, 0), -std::pow(calc_omega(), 2) * std::cos(0.7), 1e-7);
  EXPECT_NEAR(model.A(1, 1), -0.4 / inertia, 1e-8);
}

// A rocker goes no further than the rods reach.
TEST(ClosedLoops, CannotFollowPastADeadPoint) {
  auto spec = make_parallelogram(0);
  spec.bodies[2] = make_rod("coupler", {0.5, 0, 0}, kCoupler);
  for (auto& hinge : spec.hinges) hinge.position.clear();
  const System system = build(spec);
  Plant plant(system);
  const auto start = plant.make_initial_point();
  bool is_told = false;
  for (double delta = 0.2; delta < 3.2 && !is_told; delta += 0.2) {
    for (const double sign : {-1, 1}) {
      try {
        plant.displace(start.q, VectorXd::Constant(1, sign * delta));
      } catch (const ComputationError& error) {
        is_told = error.items()[0].id == "linear.dead-point";
      }
    }
  }
  EXPECT_TRUE(is_told);
}

}  // namespace
}  // namespace bough::solver::testing
