#include "solver/tree/tree.hpp"

#include <gtest/gtest.h>

#include "tests/solver/support/models.hpp"

namespace bough::solver::testing {
namespace {

class RandomTreeTest : public ::testing::TestWithParam<unsigned> {
 protected:
  System make(const RandomTreeOptions& options) {
    tree_ = make_random_tree(GetParam(), options);
    System system = build(tree_.spec, tree_.flex);
    make_random_state(system, GetParam() + 1000, q_, u_);
    return system;
  }
  RandomTree tree_;
  VectorXd q_, u_;
};

TEST_P(RandomTreeTest, OrderNEqualsDense) {
  const System system = make({});
  auto data = system.make_data();
  const VectorXd fast = calc_u_dot(system, *data, 0.3, q_, u_);
  VectorXd dense(system.num_u());
  calc_accelerations_dense(system, *data, 0.3, dense);
  EXPECT_LT((fast - dense).norm(), 1e-10 * dense.norm());
}

TEST_P(RandomTreeTest, NodeMotionIsConsistentAlongATrajectory) {
  const System system = make({});
  auto data = system.make_data();
  const double t = 0.3, h = 2e-4;
  const VectorXd u_dot = calc_u_dot(system, *data, t, q_, u_);
  for (int b = 0; b < system.num_bodies(); ++b) {
    for (const int id : {0, 101, 102}) {
      const int node = system.find_node(b, id);
      ASSERT_GE(node, 0);
      auto at = [&](double dt) {
        auto other = system.make_data();
        calc_kinematics(system, *other, t + dt, advance_q(system, *other, t, dt, q_, u_, u_dot), u_ + dt * u_dot);
        return calc_node_motion(system, *other, b, node);
      };
      calc_u_dot(system, *data, t, q_, u_);
      const NodeMotion m = calc_node_motion(system, *data, b, node);
      const NodeMotion p1 = at(h), m1 = at(-h), p2 = at(2 * h), m2 = at(-2 * h);
      EXPECT_LT((m.v_WK - Vector3d((8 * (p1.p_WK - m1.p_WK) - (p2.p_WK - m2.p_WK)) / (12 * h))).norm(), 1e-8);
      EXPECT_LT((m.a_WK - Vector3d((8 * (p1.v_WK - m1.v_WK) - (p2.v_WK - m2.v_WK)) / (12 * h))).norm(),
                1e-8 * (1 + m.a_WK.norm()));
      EXPECT_LT((m.alpha_WK - Vector3d((8 * (p1.w_WK - m1.w_WK) - (p2.w_WK - m2.w_WK)) / (12 * h))).norm(),
                1e-8 * (1 + m.alpha_WK.norm()));
      const Matrix3d R_dot = (8 * (p1.R_WK - m1.R_WK) - (p2.R_WK - m2.R_WK)) / (12 * h);
      EXPECT_LT((skew(m.w_WK) * m.R_WK - R_dot).norm(), 1e-8);
    }
  }
}

TEST_P(RandomTreeTest, EnergyChangesByThePowerOfWhatActs) {
  const System system = make({});
  auto data = system.make_data();
  const double t = 0.3, h = 1e-4;
  const VectorXd u_dot = calc_u_dot(system, *data, t, q_, u_);
  const double power = calc_power(system, *data);
  auto energy = [&](double dt) {
    auto other = system.make_data();
    const VectorXd q = advance_q(system, *other, t, dt, q_, u_, u_dot);
    calc_kinematics(system, *other, t + dt, q, u_ + dt * u_dot);
    add_forces(system, *other, t + dt);
    const Energies e = calc_energies(system, *other);
    return e.kinetic + e.strain + e.potential;
  };
  const double rate = (8 * (energy(h) - energy(-h)) - (energy(2 * h) - energy(-2 * h))) / (12 * h);
  EXPECT_NEAR(power, rate, 1e-7 * (1 + std::abs(rate) + std::abs(energy(0))));
}

TEST_P(RandomTreeTest, NewtonAndEulerHoldForAFreeTree) {
  RandomTreeOptions options;
  options.forces = false;
  options.to_ground = false;  // internal springs, dampers, motions only
  const System system = make(options);
  auto data = system.make_data();
  const double t = 0.3, h = 1e-4;
  const VectorXd u_dot = calc_u_dot(system, *data, t, q_, u_);
  auto momentum = [&](double dt) {
    auto other = system.make_data();
    calc_kinematics(system, *other, t + dt, advance_q(system, *other, t, dt, q_, u_, u_dot), u_ + dt * u_dot);
    Vector3d linear, angular;
    calc_momentum(system, *other, linear, angular);
    Vector6d both;
    both << linear, angular;
    return both;
  };
  const Vector6d rate = (8 * (momentum(h) - momentum(-h)) - (momentum(2 * h) - momentum(-2 * h))) / (12 * h);
  EXPECT_LT(rate.norm(), 1e-7 * (1 + momentum(0).norm()));
}

TEST_P(RandomTreeTest, RepeatedCallsAgree) {
  const System system = make({});
  auto data = system.make_data(), fresh = system.make_data();
  const VectorXd first = calc_u_dot(system, *data, 0.3, q_, u_);
  calc_u_dot(system, *data, 0.9, q_ * 0.5 + q_, u_ * 2);
  EXPECT_EQ(calc_u_dot(system, *data, 0.3, q_, u_), first);
  EXPECT_EQ(calc_u_dot(system, *fresh, 0.3, q_, u_), first);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomTreeTest, ::testing::Range(1u, 17u));

}  // namespace
}  // namespace bough::solver::testing
