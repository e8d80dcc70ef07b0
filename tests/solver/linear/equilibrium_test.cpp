// States of rest and of steady spin against statics by hand.
#include "solver/linear/equilibrium.hpp"

#include <gtest/gtest.h>

#include "tests/solver/support/records.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;

records::BodyRecord make_point(const std::string& name, double mass, const Vector3d& cg) {
  return make_body_record(name, mass, Vector3d::Zero(), cg);
}

Equilibrium find(const records::SystemSpec& spec, const std::map<std::string, records::FlexBody>& flex = {}) {
  const System system = build(spec, flex);
  Diagnostics diagnostics;
  Plant plant(system);
  return find_equilibrium(plant, plant.make_initial_point(), {"system.toml"});
}

TEST(Equilibrium, TwoLinksHangAgainstASpring) {
  records::SystemSpec spec;
  spec.simulation.gravity = {0, -9.81, 0};
  spec.bodies = {make_point("a", 2, {0, -1, 0}), make_point("b", 1, {0, -1, 0})};
  spec.hinges = {make_hinge_record("p", HingeType::Revolute, "ground", "a"),
                 make_hinge_record("r", HingeType::Revolute, "a", "b")};
  spec.hinges[1].parent_position = {0, -1, 0};
  spec.hinges[0].stiffness = {10};
  spec.hinges[0].null_position = {0.8};
  const auto found = find(spec);
  const double q1 = found.point.q[0], q2 = found.point.q[1];
  EXPECT_NEAR(q1 + q2, 0, 1e-9);  // the outer link hangs straight
  EXPECT_NEAR(10 * (0.8 - q1), 3 * 9.81 * std::sin(q1), 1e-8);
  EXPECT_LT(found.residual, 1e-8);
  EXPECT_TRUE(found.neutral.empty());
}

TEST(Equilibrium, AStartThatDivergesGoesDownhill) {
  // Torque x - x³, x = angle / 0.3 rad. Newton's method takes one whole step from x = 0.5 to the stable state x = -1,
  // against the torque; the way downhill ends at x = 1.
  records::SystemSpec spec;
  spec.bodies = {make_point("beam", 1, {0, 0, 0})};
  spec.bodies[0].inertia = Matrix3d::Identity();
  spec.hinges = {make_hinge_record("snap", HingeType::Revolute, "ground", "beam")};
  spec.hinges[0].position = {0.15};
  spec.hinges[0].law.spring_table = {"wells"};
  records::FunctionRecord wells;
  wells.name = "wells";
  wells.type = "table";
  wells.interpolation = "cubic";
  for (int i = -60; i <= 60; ++i) {
    const double angle = 0.01 * i, x = angle / 0.3;
    wells.x.push_back(angle);
    wells.y.push_back(x * x * x - x);
  }
  spec.functions = {wells};
  const auto found = find(spec);
  EXPECT_NEAR(found.point.q[0], 0.3, 1e-4);
  EXPECT_TRUE(found.unstable.empty());
}

TEST(Equilibrium, AGovernorSpins) {
  // A mass on a hinge that a turning hub carries: w² l cos(angle) = g.
  records::SystemSpec spec;
  const double g = 9.81, l = 0.5, w = 6;
  spec.simulation.gravity = {0, 0, -g};
  spec.bodies = {make_point("hub", 1, {0, 0, 0}), make_point("ball", 2, {0, 0, -l})};
  spec.bodies[0].inertia = Matrix3d::Identity();
  spec.hinges = {make_hinge_record("spin", HingeType::Revolute, "ground", "hub"),
                 make_hinge_record("arm", HingeType::Revolute, "hub", "ball")};
  spec.hinges[1].axis = Vector3d::UnitY();
  spec.hinges[0].rate = {w};
  spec.hinges[1].position = {0.9};
  const auto found = find(spec);
  EXPECT_NEAR(std::cos(found.point.q[1]), g / (w * w * l), 1e-9);
  EXPECT_EQ(found.spinning, std::vector<std::string>{"spin:1"});
  EXPECT_LT(found.residual, 1e-8);
}

TEST(Equilibrium, AFlexibleBodySagsByItsStaticDeflection) {
  PointBody points = make_point_body(3, 4, 0);
  records::SystemSpec spec;
  spec.simulation.gravity = {0, 0, -0.4};
  records::BodyRecord body;
  body.name = "arm";
  body.file = "arm";
  body.stiffening = false;
  body.eta_dot = {0.3, 0, 1};
  spec.bodies = {body};
  spec.hinges = {make_hinge_record("clamp", HingeType::Fixed, "ground", "arm")};
  const auto flex = points.make_record("arm");
  const auto found = find(spec, {{"arm", flex}});
  VectorXd load = VectorXd::Zero(3);
  for (size_t k = 0; k < points.p.size(); ++k)
    load += points.mass[k] * points.phi[k].transpose() * spec.simulation.gravity;
  EXPECT_LT((found.point.q - points.K.ldlt().solve(load)).norm(), 1e-9);
  EXPECT_EQ(found.point.u.norm(), 0);
}

TEST(Equilibrium, IndifferentFreedomsStay) {
  records::SystemSpec spec;
  spec.simulation.gravity.setZero();
  spec.bodies = {make_point("cart", 2, {0, 0, 0}), make_point("bob", 1, {0.2, 0, 0})};
  spec.hinges = {make_hinge_record("rail", HingeType::Prismatic, "ground", "cart"),
                 make_hinge_record("pin", HingeType::Revolute, "cart", "bob")};
  spec.hinges[0].axis = Vector3d::UnitX();
  spec.hinges[0].position = {3};
  spec.hinges[1].stiffness = {5};
  spec.hinges[1].position = {1.3};
  const auto found = find(spec);
  EXPECT_EQ(found.neutral, std::vector<std::string>{"rail:1"});
  EXPECT_NEAR(found.point.q[0], 3, 1e-12);
  EXPECT_NEAR(found.point.q[1], 0, 1e-10);
}

/// A pendulum that is released level.
records::SystemSpec make_level_arm() {
  records::SystemSpec spec;
  spec.simulation.gravity = {0, 0, -9.81};
  spec.bodies = {make_point("arm", 2, {0.5, 0, 0})};
  spec.hinges = {make_hinge_record("pivot", HingeType::Revolute, "ground", "arm")};
  spec.hinges[0].axis = Vector3d::UnitY();
  return spec;
}

/// The error of a search without a result.
Diagnostic fail_to_find(const records::SystemSpec& spec) {
  try {
    find(spec);
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.items()[0].id, "equilibrium.not-converged");
    return error.items()[0];
  }
  ADD_FAILURE() << "no failure";
  return {};
}

TEST(Equilibrium, APendulumReleasedLevelIsFoundHanging) {
  // The torque has no slope there: Newton's method has no direction.
  auto spec = make_level_arm();
  const auto found = find(spec);
  EXPECT_NEAR(found.point.q[0], M_PI / 2, 1e-9);
  EXPECT_TRUE(found.unstable.empty());
  spec.hinges[0].position = {-M_PI / 2 + 0.05};  // upright is what was meant
  const auto upright = find(spec);
  EXPECT_NEAR(upright.point.q[0], -M_PI / 2, 1e-9);
  ASSERT_EQ(upright.unstable.size(), 1U);
  EXPECT_EQ(upright.unstable[0].mode, "pivot:1");
  EXPECT_NEAR(upright.unstable[0].rate, std::sqrt(9.81 / 0.5), 1e-6);
  spec.hinges[0].position = {-1.2};  // far from upright: it falls
  EXPECT_NEAR(find(spec).point.q[0], M_PI / 2, 1e-9);
}

TEST(Equilibrium, TwoLinksReleasedLevelHang) {
  records::SystemSpec spec;
  spec.simulation.gravity = {0, 0, -9.81};
  spec.bodies = {make_point("a", 2, {1, 0, 0}), make_point("b", 1, {1, 0, 0})};
  spec.hinges = {make_hinge_record("p", HingeType::Revolute, "ground", "a"),
                 make_hinge_record("r", HingeType::Revolute, "a", "b")};
  for (auto& hinge : spec.hinges) hinge.axis = Vector3d::UnitY();
  spec.hinges[1].parent_position = {1, 0, 0};
  const auto found = find(spec);
  EXPECT_NEAR(std::remainder(found.point.q[0] - M_PI / 2, 2 * M_PI), 0, 1e-8);
  EXPECT_NEAR(std::remainder(found.point.q[1], 2 * M_PI), 0, 1e-8);
  EXPECT_TRUE(found.unstable.empty());
}

TEST(Equilibrium, AChainOfBallJointsHangsFromSprings) {
  // Against the least potential energy: both mass centres below the attachments, springs stretched by the weights.
  records::SystemSpec spec;
  spec.simulation.gravity = {0, 0, -9.81};
  spec.bodies = {make_point("stone", 2, {0.3, 0, 0}), make_point("arm", 1, {0.5, 0, 0})};
  spec.bodies[0].inertia = Vector3d(0.1, 0.2, 0.25).asDiagonal();
  spec.bodies[1].inertia = Vector3d(0.01, 0.1, 0.1).asDiagonal();
  spec.hinges = {make_hinge_record("fly", HingeType::Free, "ground", "stone"),
                 make_hinge_record("j", HingeType::Spherical, "stone", "arm")};
  spec.hinges[0].stiffness = {0, 0, 0, 100, 200, 300};
  spec.hinges[1].parent_position = {0.5, 0, 0};
  const auto found = find(spec);
  EXPECT_TRUE(found.unstable.empty());
  EXPECT_NEAR(found.point.q[6], -3 * 9.81 / 300, 1e-9);
  // x of the stone points down, so does that of the arm.
  const Eigen::Quaterniond stone(found.point.q[3], found.point.q[0], found.point.q[1], found.point.q[2]);
  const Eigen::Quaterniond arm(found.point.q[10], found.point.q[7], found.point.q[8], found.point.q[9]);
  EXPECT_NEAR((stone.normalized() * Vector3d::UnitX()).z(), -1, 1e-9);
  EXPECT_NEAR((stone.normalized() * (arm.normalized() * Vector3d::UnitX())).z(), -1, 1e-9);
}

TEST(Equilibrium, AnAngleThatSpinsIsNotChosen) {
  auto spec = make_level_arm();
  spec.hinges[0].rate = {1};
  EXPECT_NE(fail_to_find(spec).advice.find("prescribe its motion"), std::string::npos);
  spec.simulation.gravity.setZero();
  EXPECT_EQ(find(spec).spinning.size(), 1U);
  // Nothing to find where all is given.
  spec.hinges[0].rate.clear();
  spec.hinges[0].motion = {"f"};
  spec.functions = {make_function("f", "constant", {{"value", 0.3}})};
  const auto given = find(spec);
  EXPECT_EQ(given.residual, 0);
  EXPECT_TRUE(given.unstable.empty());
}

// A rigid body that floats and spins about a principal axis through its mass centre is in a steady spin wherever its
// origin is and however its mass centre drifts; about another axis it tumbles.
TEST(Equilibrium, AFloatingBodySpinsAboutItsMassCentre) {
  for (const auto type : {records::HingeType::Free, records::HingeType::Planar}) {
    records::SystemSpec spec;
    records::BodyRecord sat;
    sat.name = "sat";
    sat.mass = 100;
    sat.cg = {0.1, 0.03, 0.5};
    sat.inertia = Vector3d(30, 40, 50).asDiagonal();
    spec.bodies = {sat};
    spec.hinges = {make_hinge_record("f", type, "ground", "sat")};
    const bool is_free = type == records::HingeType::Free;
    const auto set_rates = [&](const Vector3d& w, const Vector3d& drift) {
      const Vector3d v = drift - w.cross(sat.cg);
      spec.hinges[0].rate = is_free ? std::vector<double>{w.x(), w.y(), w.z(), v.x(), v.y(), v.z()}
                                    : std::vector<double>{v.x(), v.y(), w.z()};
    };
    for (const Vector3d& drift : {Vector3d(0, 0, 0), Vector3d(7, -3, 2)}) {
      set_rates({0, 0, 1.3}, drift);
      const auto found = find(spec);
      EXPECT_LT(found.residual, 1e-12);
      EXPECT_TRUE(found.unstable.empty());
    }
    spec.hinges[0].axis = Vector3d::UnitZ();
    if (!is_free) continue;
    set_rates({0.5, 0, 1.3}, {0, 0, 0});
    EXPECT_THROW(find(spec), ComputationError);
    // A force on its centre of mass leaves it no steady spin.
    set_rates({0, 0, 1.3}, {0, 0, 0});
    spec.simulation.gravity = {0, 0, -1e-6};
    EXPECT_THROW(find(spec), ComputationError);
    spec.simulation.gravity = {1e-6, 0, 0};
    EXPECT_THROW(find(spec), ComputationError);
  }
}

TEST(Equilibrium, NoneForAFallingBody) {
  records::SystemSpec spec;
  spec.simulation.gravity = {0, 0, -9.81};
  spec.bodies = {make_point("stone", 2, {0, 0, 0})};
  spec.bodies[0].inertia = Matrix3d::Identity();
  const Diagnostic failure = fail_to_find(spec);
  EXPECT_NE(failure.what.find("9.81"), std::string::npos);
  EXPECT_NE(failure.what.find("stone:z"), std::string::npos);
}

}  // namespace
}  // namespace bough::solver::testing
