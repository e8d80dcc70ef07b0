// Reactions of each hinge: every body by itself obeys Newton and Euler with them.
#include <gtest/gtest.h>

#include "tests/solver/support/models.hpp"

namespace bough::solver::testing {
namespace {

class ReactionTest : public ::testing::TestWithParam<unsigned> {
 protected:
  void SetUp() override { make_random_state(system_, GetParam() + 1000, q_, u_); }

  const RandomTree tree_ = make_random_tree(GetParam(), {});
  const System system_ = build(tree_.spec, tree_.flex);
  std::unique_ptr<SystemData> data_ = system_.make_data();
  VectorXd q_, u_;
};

// Wrench about the inertial origin, in W, that the parent puts on body b.
Vector6d calc_world_reaction(const System& system, const SystemData& data, int b) {
  const TreeBody& tb = system.tree[b];
  const HingeReaction r = get_hinge_reaction(system, data, b);
  const MarkerMotion& p = data.tree.markers[static_cast<size_t>(tb.parent_marker)];
  const MarkerMotion& c = data.tree.markers[static_cast<size_t>(tb.child_marker)];
  const BodyState& parent = data.tree[tb.parent].state;
  const BodyState& child = data.tree[b].state;
  const Matrix3d R_WHp = parent.R_WB * p.R;
  const Vector3d f = R_WHp * r.force, at = child.p_WBo + child.R_WB * c.r;
  Vector6d wrench;
  wrench << f, R_WHp * r.moment + at.cross(f);
  return wrench;
}

TEST_P(ReactionTest, ClosesNewtonAndEulerOfEveryBody) {
  const VectorXd u_dot = calc_u_dot(system_, *data_, 0.3, q_, u_);
  const Matrix6Xd rate = calc_momentum_rates(system_, 0.3, q_, u_, u_dot);
  Matrix6Xd loads = Matrix6Xd::Zero(6, system_.num_bodies());
  for (int b = 0; b < system_.num_bodies(); ++b) {
    const TreeBody& tb = system_.tree[b];
    loads.col(b) += calc_applied_loads(system_, *data_, b);
    const Vector6d reaction = calc_world_reaction(system_, *data_, b);
    loads.col(b) += reaction;
    if (tb.parent >= 0) loads.col(tb.parent) -= reaction;
  }
  const double scale = 1 + loads.cwiseAbs().maxCoeff() + rate.cwiseAbs().maxCoeff();
  EXPECT_LT((rate - loads).cwiseAbs().maxCoeff(), 1e-10 * scale);
}

TEST_P(ReactionTest, AlongFreeCoordinatesIsTheHingeForce) {
  calc_u_dot(system_, *data_, 0.3, q_, u_);
  for (int b = 0; b < system_.num_bodies(); ++b) {
    const TreeBody& tb = system_.tree[b];
    const HingeReaction r = get_hinge_reaction(system_, *data_, b);
    Vector6d wrench;
    wrench << r.force, r.moment;
    for (int i = 0; i < tb.num_hinge_u(); ++i)
      EXPECT_NEAR(data_->tree[b].hinge.H.col(i).dot(wrench), data_->tree.get_hinge_force(tb.u_offset + i),
                  1e-11 * (1 + wrench.norm()));
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ReactionTest, ::testing::Range(1u, 17u));

// A rod of mass m and length L swings about z: along the rod the pin carries m (ω² L/2 + g cos), across it a quarter of
// the weight's share; a second rod welded to its end hangs on the weld.
TEST(Reaction, OfAPendulumAndOfAWeld) {
  const double m = 2, length = 3, g = 9.81, angle = 0.4, rate = 1.7;
  records::SystemSpec spec;
  spec.simulation.gravity = {0, -g, 0};
  records::BodyRecord rod;
  rod.name = "rod";
  rod.mass = m;
  rod.cg = {length / 2, 0, 0};
  rod.inertia = Vector3d(0, m * length * length / 12, m * length * length / 12).asDiagonal();
  rod.inertia(0, 0) = 1e-6;
  spec.bodies = {rod};
  spec.hinges = {make_hinge_record("pin", records::HingeType::Revolute, "ground", "rod")};
  const System system = build(spec);
  auto data = system.make_data();
  // From the vertical: θ = -π/2 + angle.
  const double theta = -std::acos(-1.0) / 2 + angle;
  calc_u_dot(system, *data, 0, VectorXd::Constant(1, theta), VectorXd::Constant(1, rate));
  const HingeReaction r = get_hinge_reaction(system, *data, 0);
  const Vector3d along(std::cos(theta), std::sin(theta), 0), across(-std::sin(theta), std::cos(theta), 0);
  EXPECT_NEAR(r.force.dot(along), -m * (rate * rate * length / 2 + g * std::cos(angle)), 1e-12);
  EXPECT_NEAR(r.force.dot(across), m * g * std::sin(angle) / 4, 1e-12);
  EXPECT_LT(r.moment.norm(), 1e-12);

  spec.bodies.push_back(rod);
  spec.bodies[1].name = "load";
  spec.bodies[0].nodes = {{1, Vector3d(length, 0, 0)}};
  spec.hinges[0].type = records::HingeType::Fixed;
  spec.hinges.push_back(make_hinge_record("weld", records::HingeType::Fixed, "rod", "load"));
  spec.hinges[1].parent_node = 1;
  const System held = build(spec);
  auto held_data = held.make_data();
  calc_u_dot(held, *held_data, 0, VectorXd(), VectorXd());
  const HingeReaction weld = get_hinge_reaction(held, *held_data, 1), root = get_hinge_reaction(held, *held_data, 0);
  EXPECT_LT((weld.force - Vector3d(0, m * g, 0)).norm(), 1e-12);
  EXPECT_LT((weld.moment - Vector3d(0, 0, m * g * length / 2)).norm(), 1e-12);
  EXPECT_LT((root.force - Vector3d(0, 2 * m * g, 0)).norm(), 1e-12);
  EXPECT_LT((root.moment - Vector3d(0, 0, 2 * m * g * length)).norm(), 1e-11);
  const SystemMass mass = calc_system_mass(held, *held_data);
  EXPECT_EQ(mass.mass, 2 * m);
  EXPECT_LT((mass.cg_W - Vector3d(length, 0, 0)).norm(), 1e-14);
  EXPECT_NEAR(mass.inertia_W(2, 2), 2 * m * 4 * length * length / 12, 1e-12);
}

}  // namespace
}  // namespace bough::solver::testing
