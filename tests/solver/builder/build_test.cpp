// Every error that build_system reports, by its id, and what a built system looks like.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/builder/build_system.hpp"
#include "tests/solver/support/models.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;

// A rigid hub on a pin, a flexible arm fixed to it at a node of both; errors are put in one by one.
class BuildTest : public ::testing::Test {
 protected:
  BuildTest() {
    Random random(1);
    spec_.bodies = {make_rigid_record("hub", random)};
    records::BodyRecord arm;
    arm.name = "arm";
    arm.file = "arm.h5";
    spec_.bodies.push_back(arm);
    flex_["arm.h5"] = make_point_body(3, 5).make_record("arm");
    spec_.hinges = {make_hinge_record("pin", HingeType::Revolute, "ground", "hub"),
                    make_hinge_record("root", HingeType::Fixed, "hub", "arm")};
    spec_.hinges[1].parent_node = 101;
    spec_.hinges[1].child_node = 101;
    spec_.hinges[1].at = {"sys.toml", 12, 0};
    records::FunctionRecord level;
    level.name = "level";
    level.type = "constant";
    level.values = {{"value", 2}};
    spec_.functions = {level};
    records::ForceRecord push;
    push.name = "push";
    push.body = "arm";
    push.node = 102;
    push.direction = {0, 0, 1};
    push.function = "level";
    spec_.forces = {push};
  }

  // Builds; returns the messages, one per line.
  std::string try_build() {
    diagnostics_ = Diagnostics();
    try {
      build_system(spec_, flex_, diagnostics_);
    } catch (const InputError& error) {
      EXPECT_EQ(error.exit_code(), 1);
      return error.what();
    }
    std::string text;
    for (const auto& d : diagnostics_.items()) text += format(d) + "\n";
    return text;
  }
  void expect_error(const std::string& id, const std::string& text) {
    const std::string said = try_build();
    EXPECT_TRUE(diagnostics_.has(id)) << said;
    EXPECT_EQ(diagnostics_.num_errors(), 1) << said;
    EXPECT_THAT(said, ::testing::HasSubstr(text));
  }
  void expect_warning(const std::string& id, const std::string& text) {
    const std::string said = try_build();
    EXPECT_TRUE(diagnostics_.has(id)) << said;
    EXPECT_EQ(diagnostics_.num_errors(), 0) << said;
    EXPECT_THAT(said, ::testing::HasSubstr(text));
  }

  records::SystemSpec spec_;
  std::map<std::string, records::FlexBody> flex_;
  Diagnostics diagnostics_;
};

TEST_F(BuildTest, TheUnspoiledSystemHasNothingToReport) {
  EXPECT_EQ(try_build(), "");
  const System system = build(spec_, flex_);
  EXPECT_EQ(system.num_bodies(), 2);
  EXPECT_EQ(system.find_body("arm"), 1);
  EXPECT_EQ(system.find_body("leg"), -1);
  EXPECT_EQ(system.find_hinge("root"), 1);
  EXPECT_EQ(system.find_hinge("arm"), -1);
  EXPECT_EQ(system.body_name(1), "arm");
  EXPECT_EQ(system.hinge_name(0), "pin");
  EXPECT_EQ(system.num_q(), 4);
  EXPECT_EQ(system.num_u(), 4);
  EXPECT_EQ(system.num_modes(1), 3);
  EXPECT_EQ(system.q_offset(1), 1);
  EXPECT_EQ(system.eta_offset(1), 1);
  EXPECT_EQ(system.num_hinge_q(0), 1);
  EXPECT_EQ(system.find_node(1, 0), 0);
  EXPECT_EQ(system.find_node(1, 102), 2);
  EXPECT_EQ(system.find_node(1, 9), -1);
}

TEST_F(BuildTest, ChildrenMayBeListedBeforeParents) {
  std::swap(spec_.bodies[0], spec_.bodies[1]);
  const System system = build(spec_, flex_);
  EXPECT_EQ(system.body_name(0), "hub");
  EXPECT_EQ(system.body_name(1), "arm");
}

TEST_F(BuildTest, InitialStateFollowsTheRecords) {
  spec_.hinges[0].position = {0.3};
  spec_.hinges[0].rate = {-0.2};
  spec_.bodies[1].eta = {1, 2, 3};
  spec_.bodies[1].eta_dot = {4, 5, 6};
  const System system = build(spec_, flex_);
  VectorXd q(4), u(4);
  system.calc_initial_state(q, u);
  EXPECT_EQ(q, Eigen::Vector4d(0.3, 1, 2, 3));
  EXPECT_EQ(u, Eigen::Vector4d(-0.2, 4, 5, 6));
}

TEST_F(BuildTest, QuaternionsOfTheFileAreScalarFirst) {
  spec_.hinges[0].type = HingeType::Spherical;
  spec_.hinges[0].position = {2, 0, 0, 2};  // w, x, y, z; a quarter turn about z
  const System system = build(spec_, flex_);
  VectorXd q(system.num_q()), u(system.num_u());
  system.calc_initial_state(q, u);
  auto data = system.make_data();
  calc_kinematics(system, *data, 0, q, u);
  EXPECT_LT((get_body_state(*data, 0).R_WB * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 1e-15);
}

TEST_F(BuildTest, BreakpointsOfUsedFunctionsAreCollected) {
  records::FunctionRecord step;
  step.name = "late";
  step.type = "step";
  step.values = {{"value", 1}, {"at", 3}, {"before", 0}};
  spec_.functions.push_back(step);
  EXPECT_TRUE(build(spec_, flex_).jump_times.empty());
  spec_.forces[0].function = "late";
  EXPECT_EQ(build(spec_, flex_).jump_times, std::vector<double>{3});
}

TEST_F(BuildTest, BodyWithoutHingeMovesFreely) {
  spec_.hinges.erase(spec_.hinges.begin());
  expect_warning("system.free-body", "'hub' has no hinge");
  const System system = build(spec_, flex_);
  EXPECT_EQ(system.num_hinge_u(0), 6);
  EXPECT_EQ(system.hinge_name(0), "hub");
}

TEST_F(BuildTest, UnknownBody) {
  spec_.hinges[1].parent = "hup";
  expect_error("system.unknown-body",
               "sys.toml:12: error: hinge 'root' names body 'hup', which does not exist; did you mean 'hub'?");
}

TEST_F(BuildTest, UnknownBodyOfAForce) {
  spec_.forces[0].body = "am";
  expect_error("system.unknown-body", "did you mean 'arm'?");
}

TEST_F(BuildTest, UnknownNode) {
  spec_.hinges[1].parent_node = 7;
  expect_error("system.unknown-node", "node 7 of body 'hub', which has nodes 0 101 102 103");
}

TEST_F(BuildTest, GroundHasOneNode) {
  spec_.hinges[0].parent_node = 7;
  expect_error("system.unknown-node", "node 7 of ground");
}

TEST_F(BuildTest, UnknownNodeOfAForce) {
  spec_.forces[0].node = 77;
  expect_error("system.unknown-node", "force 'push' names node 77");
}

TEST_F(BuildTest, SecondInboardHingeClosesALoop) {
  spec_.hinges.push_back(make_hinge_record("strut", HingeType::Revolute, "ground", "arm"));
  expect_error("system.loop", "'arm' is already attached to hinge 'root' (hub - arm - ground)");
}

TEST_F(BuildTest, RingWithoutGroundIsALoop) {
  spec_.hinges[0].parent = "arm";
  expect_error("system.loop", "hub - arm - hub");
}

TEST_F(BuildTest, GroundIsNobodysChild) {
  spec_.hinges[0].parent = "hub";
  spec_.hinges[0].child = "ground";
  expect_error("system.ground-child", "exchange parent and child");
}

TEST_F(BuildTest, DuplicateNames) {
  spec_.forces.push_back(spec_.forces[0]);
  expect_error("system.duplicate-name", "two forces have the name 'push'");
}

TEST_F(BuildTest, DuplicateBodyNames) {
  Random random(2);
  spec_.bodies.push_back(make_rigid_record("hub", random));
  try_build();
  EXPECT_TRUE(diagnostics_.has("system.duplicate-name"));
}

TEST_F(BuildTest, MissingLocators) {
  auto& locators = flex_["arm.h5"].locators;
  auto& kg = flex_["arm.h5"].kg_external;
  locators.erase(locators.begin() + 3, locators.begin() + 6);  // those of node 102
  kg.erase(kg.begin() + 3, kg.begin() + 6);
  expect_error("system.missing-locators", "node 102 of body 'arm'");
  spec_.forces[0].kind = records::ForceKind::Moment;
  EXPECT_EQ(try_build(), "");
  spec_.forces[0].kind = records::ForceKind::Force;
  spec_.bodies[1].stiffening = false;
  EXPECT_EQ(try_build(), "");
}

TEST_F(BuildTest, MissingLocatorsAtAnAttachment) {
  auto& locators = flex_["arm.h5"].locators;
  locators.erase(locators.begin());
  flex_["arm.h5"].kg_external.erase(flex_["arm.h5"].kg_external.begin());
  expect_error("system.missing-locators", "hinge 'root' loads node 101");
  flex_["arm.h5"].phi[0].setZero();  // a clamped node needs none
  EXPECT_EQ(try_build(), "");
}

// A file without the rotations of node 102: that of a grid of solids.
TEST_F(BuildTest, NodeWithoutRotation) {
  auto& flex = flex_["arm.h5"];
  for (size_t e = flex.locators.size(); e-- > 0;) {
    if (flex.locators[e].direction <= 3) continue;
    flex.locators.erase(flex.locators.begin() + static_cast<long>(e));
    flex.kg_external.erase(flex.kg_external.begin() + static_cast<long>(e));
  }
  EXPECT_EQ(try_build(), "");  // no locators of moments: first order, as version 1.0
  flex.phi[1].bottomRows<3>().setZero();
  EXPECT_EQ(try_build(), "");  // a force needs no rotation
  spec_.forces[0].kind = records::ForceKind::Moment;
  expect_error("system.node-without-rotation", "force 'push' needs the rotation of node 102 of body 'arm'");
  EXPECT_THAT(try_build(), ::testing::HasSubstr("RBE2 or RBE3"));
  spec_.forces.clear();
  spec_.hinges[1].child_node = 102;
  expect_error("system.node-without-rotation", "hinge 'root'");
  spec_.hinges[1].type = HingeType::Spherical;
  EXPECT_EQ(try_build(), "");  // a ball joint passes on no moment
  spec_.hinges[1].child_position = {0.1, 0, 0};
  expect_error("system.node-without-rotation", "hinge 'root'");
  spec_.hinges[1].child_position.setZero();
  spec_.hinges[1].stiffness = {1, 1, 1};
  expect_error("system.node-without-rotation", "hinge 'root'");
}

TEST_F(BuildTest, IntegralsOfNoMassDistribution) {
  EXPECT_FALSE(diagnostics_.has("system.inconsistent-integrals"));
  flex_["arm.h5"].modal_mass *= 0.5;  // less than the shapes' own turning allows
  EXPECT_THAT(try_build(), ::testing::HasSubstr("system.inconsistent-integrals"));
  EXPECT_EQ(diagnostics_.num_errors(), 0);
}

TEST_F(BuildTest, MissingBodyFile) {
  flex_.clear();
  expect_error("system.missing-body-file", "needs the file 'arm.h5'");
}

TEST_F(BuildTest, MissingIntegrals) {
  flex_["arm.h5"].integrals_method = "exact";
  expect_error("system.missing-integrals", "no 'exact' mass integrals");
}

TEST_F(BuildTest, TooManyModes) {
  spec_.bodies[1].num_modes = 4;
  expect_error("system.too-many-modes", "asks for 4 modes, its file 'arm.h5' has 3");
}

TEST_F(BuildTest, CountsOfBodies) {
  spec_.bodies[1].eta = {1};
  expect_error("system.bad-count", "eta has 1 values, expected 3");
  spec_.bodies[1].eta.clear();
  spec_.bodies[1].damping_ratios = {0.1, 0.2};
  expect_error("system.bad-count", "damping has 2 values, expected 3");
  spec_.bodies[1].damping_ratios.clear();
  spec_.bodies[0].eta = {1};
  expect_error("system.bad-count", "'hub' is rigid");
}

TEST_F(BuildTest, CountsOfHinges) {
  auto& hinge = spec_.hinges[0];
  const auto good = hinge;
  hinge.position = {1, 2};
  expect_error("system.bad-count", "position has 2 values, expected 1");
  hinge = good;
  hinge.stiffness = {1, 2};
  expect_error("system.bad-count", "stiffness has 2 values, expected 1");
  hinge = good;
  hinge.rate = {1, 2};
  expect_error("system.bad-count", "rate has 2 values, expected 1");
  hinge = good;
  hinge.motion = {"level", "level"};
  expect_error("system.bad-count", "motion names 2 functions, expected 1");
}

TEST_F(BuildTest, NodesOfAFlexibleBody) {
  spec_.bodies[1].nodes = {{1, Vector3d::Zero()}};
  expect_error("system.nodes-of-flexible-body", "'arm' is flexible");
}

TEST_F(BuildTest, DuplicateNode) {
  spec_.bodies[0].nodes.push_back({101, Vector3d::Zero()});
  expect_error("system.duplicate-node", "declares node 101 twice");
  spec_.bodies[0].nodes.back().id = 0;
  expect_error("system.duplicate-node", "node 0, which is its origin");
}

TEST_F(BuildTest, BadMass) {
  spec_.bodies[0].mass = -1;
  expect_error("system.bad-mass", "mass -1");
}

TEST_F(BuildTest, BadInertia) {
  spec_.bodies[0].inertia = Vector3d(1, 1, -0.5).asDiagonal();
  expect_error("system.bad-inertia", "negative principal value -0.5");
  spec_.bodies[0].inertia = Matrix3d::Identity();
  spec_.bodies[0].inertia(0, 1) = 0.1;
  expect_error("system.bad-inertia", "not symmetric");
  spec_.bodies[0].inertia(0, 1) = std::nan("");
  expect_error("system.bad-inertia", "not a number");
}

TEST_F(BuildTest, InertiaOfNoMassDistribution) {
  spec_.bodies[0].inertia = Vector3d(1, 1, 2.5).asDiagonal();
  expect_warning("system.inertia-triangle", "exceeds the sum of the other two");
}

TEST_F(BuildTest, Massless) {
  spec_.bodies.resize(1);
  spec_.hinges.resize(1);
  spec_.forces.clear();
  spec_.bodies[0].mass = 0;
  spec_.bodies[0].inertia.setZero();
  expect_error("system.massless", "hinge 'pin' is free to move");
}

TEST_F(BuildTest, FreedomWithoutInertiaIsFoundWhenItMoves) {
  spec_.bodies.resize(1);
  spec_.hinges.resize(1);
  spec_.forces.clear();
  spec_.bodies[0].cg.setZero();
  spec_.bodies[0].inertia.setZero();  // a point mass on the axis
  const System system = build(spec_);
  auto data = system.make_data();
  EXPECT_THROW(calc_u_dot(system, *data, 0, VectorXd::Zero(1), VectorXd::Zero(1)), ComputationError);
}

TEST_F(BuildTest, NoStiffeningInTheFile) {
  flex_["arm.h5"].kg_inertial_computed.fill(false);
  expect_warning("system.no-stiffening", "holds no K_G1");
}

TEST_F(BuildTest, UnknownFunction) {
  spec_.forces[0].function = "leval";
  expect_error("system.unknown-function", "did you mean 'level'?");
  spec_.forces[0].function = "";
  spec_.hinges[0].motion = {"levels"};
  expect_error("system.unknown-function", "hinge 'pin' names function 'levels'");
}

// Node 0 of a free frame is no point of the body: nothing can hold or push it.
TEST_F(BuildTest, OriginOfAFreeFrame) {
  flex_["arm.h5"].is_free_free = true;
  spec_.hinges[1].child_node = 0;
  expect_error("system.frame-node", "hinge 'root' acts at node 0 of body 'arm'");
  spec_.hinges[1].child_node = 102;
  EXPECT_EQ(try_build(), "");
  spec_.forces[0].body = "arm";
  spec_.forces[0].node = 0;
  expect_error("system.frame-node", "force 'push' acts at node 0 of body 'arm'");
  spec_.forces.clear();
  spec_.hinges[1].type = HingeType::Free;  // passes on nothing
  spec_.hinges[1].child_node = 0;
  EXPECT_EQ(try_build(), "");
}

TEST_F(BuildTest, UnknownLocator) {
  spec_.forces[0].locator = "arm102w";
  expect_error("system.unknown-locator", "names load pattern 'arm102w'");
}

TEST_F(BuildTest, ForceWithoutDirection) {
  spec_.forces[0].direction.setZero();
  expect_error("system.zero-direction", "force 'push' has no direction");
}

TEST_F(BuildTest, PrescribedRotation) {
  spec_.hinges[0].type = HingeType::Spherical;
  spec_.hinges[0].motion = {"level", "level", "level"};
  expect_error("system.prescribed-rotation", "spherical or free");
}

TEST_F(BuildTest, PrescribedHingeIgnoresSpringAndPosition) {
  spec_.hinges[0].motion = {"level"};
  spec_.hinges[0].damping = {1};
  expect_warning("system.ignored-spring", "no effect");
  spec_.hinges[0].damping.clear();
  spec_.hinges[0].position = {1};
  expect_warning("system.ignored-position", "remove position and rate");
}

TEST_F(BuildTest, ZeroQuaternion) {
  spec_.hinges[0].type = HingeType::Spherical;
  spec_.hinges[0].position = {0, 0, 0, 0};
  expect_error("system.zero-quaternion", "no length");
}

TEST_F(BuildTest, BadRotation) {
  spec_.hinges[0].child_rotation = -Matrix3d::Identity();
  expect_error("system.bad-rotation", "on the child");
}

TEST_F(BuildTest, BadGravity) {
  spec_.simulation.gravity.x() = std::nan("");
  expect_error("system.bad-gravity", "not three finite numbers");
}

TEST_F(BuildTest, AllErrorsAreReported) {
  spec_.bodies[0].mass = -1;
  spec_.bodies[1].num_modes = 9;
  spec_.hinges[0].axis.setZero();
  spec_.forces[0].body = "nobody";
  spec_.hinges.push_back(make_hinge_record("strut", HingeType::Revolute, "ground", "arm"));
  try_build();
  for (const char* id :
       {"system.bad-mass", "system.too-many-modes", "system.zero-axis", "system.unknown-body", "system.loop"}) {
    EXPECT_TRUE(diagnostics_.has(id)) << id;
  }
  EXPECT_EQ(diagnostics_.num_errors(), 5);
}

}  // namespace
}  // namespace bough::solver::testing
