// Factor and solve apart: M⁻¹ of wrenches and of jumps, coordinates that are locked, against the dense equations.
#include <gtest/gtest.h>

#include "tests/solver/support/models.hpp"

namespace bough::solver::testing {
namespace {

class ResponseTest : public ::testing::TestWithParam<unsigned> {
 protected:
  ResponseTest() : tree_(make_random_tree(GetParam(), {})), system_(build(tree_.spec, tree_.flex)) {
    make_random_state(system_, GetParam() + 1000, q_, u_);
  }
  const Tree& tree() const { return system_.tree; }
  VectorXd evaluate(TreeData& data) const {
    VectorXd u_dot(tree().num_u);
    calc_factor(tree(), data);
    solve(tree(), data, u_dot);
    return u_dot;
  }
  // Some coordinates of plain hinges locked, whatever they did before.
  DiscreteState lock_some() const {
    DiscreteState discrete = system_.make_initial_state().discrete;
    Random random(GetParam() + 500);
    for (const TreeBody& tb : tree().bodies) {
      for (int i = 0; i < tb.num_hinge_u(); ++i) {
        if (tb.hinge->has_independent_coordinates() && random.integer(0, 1))
          discrete.mode[static_cast<size_t>(tb.u_offset + i)] = HingeMode::Locked;
      }
    }
    return discrete;
  }

  RandomTree tree_;
  System system_;
  VectorXd q_, u_;
};

TEST_P(ResponseTest, FactorThenSolveIsTheFusedWalk) {
  auto fused = system_.make_data(), apart = system_.make_data();
  const VectorXd expected = calc_u_dot(system_, *fused, 0.3, q_, u_);
  VectorXd q_dot(system_.num_q()), u_dot(system_.num_u()), expected_q_dot(system_.num_q());
  calc_kinematics(system_, *apart, 0.3, q_, u_);
  add_forces(system_, *apart, 0.3);
  calc_factor(tree(), apart->tree);
  solve(tree(), apart->tree, u_dot);
  EXPECT_EQ(u_dot, expected);
  get_q_dot(system_, *apart, q_dot);
  calc_q_dot(system_, *fused, 0.3, q_, u_, expected_q_dot);
  EXPECT_EQ(q_dot, expected_q_dot);
  // The factor stays when only the rates change.
  calc_velocity(tree(), u_, apart->tree);
  add_forces(system_, *apart, 0.3);
  solve(tree(), apart->tree, u_dot);
  EXPECT_EQ(u_dot, expected);
}

TEST_P(ResponseTest, ToAWrenchIsWhatTheWrenchAddsToTheAccelerations) {
  auto data = system_.make_data();
  Random random(GetParam());
  for (size_t m = 1; m < tree().markers.size(); ++m) {
    const Vector3d f = random.vector(), t = random.vector();
    const VectorXd before = calc_u_dot(system_, *data, 0.3, q_, u_);
    VectorXd du(tree().num_u);
    Vector6d wrench;
    wrench << f, t;
    solve_response(tree(), data->tree, static_cast<int>(m), wrench, {}, du);
    calc_velocity(tree(), u_, data->tree);
    add_forces(system_, *data, 0.3);
    add_marker_wrench(tree(), static_cast<int>(m), f, t, data->tree);
    EXPECT_LT((evaluate(data->tree) - before - du).norm(), 1e-11 * (1 + before.norm())) << m;

    const int body = tree().markers[m].body;
    if (body < 0) continue;
    std::vector<int> path;
    for (int b = body; b >= 0; b = tree()[b].parent) path.insert(path.begin(), b);
    VectorXd restricted(tree().num_u);
    solve_response(tree(), data->tree, static_cast<int>(m), wrench, path, restricted);
    for (const int b : path) {
      const int size = tree()[b].num_hinge_u() + tree()[b].num_modes();
      EXPECT_EQ(restricted.segment(tree()[b].u_offset, size), du.segment(tree()[b].u_offset, size));
    }
  }
}

TEST_P(ResponseTest, LockedCoordinatesAreTheDenseEquationsWithoutTheirRows) {
  auto data = system_.make_data();
  set_modes(system_, *data, lock_some());
  const VectorXd u_dot = calc_u_dot(system_, *data, 0.3, q_, u_);
  VectorXd dense(system_.num_u());
  calc_accelerations_dense(system_, *data, 0.3, dense);
  EXPECT_LT((u_dot - dense).norm(), 1e-10 * (1 + dense.norm()));
  for (int row = 0; row < tree().num_u; ++row) {
    if (data->tree.mode[static_cast<size_t>(row)] != HingeMode::Locked) continue;
    EXPECT_EQ(u_dot[row], 0);
    EXPECT_EQ(data->tree.u[row], 0);
  }
}

TEST_P(ResponseTest, ImbalancesOfAnyAccelerationsAreThoseOfTheDenseEquations) {
  auto data = system_.make_data();
  Random random(GetParam());
  for (const bool is_locked : {false, true}) {
    const DiscreteState discrete = lock_some();
    if (is_locked) set_modes(system_, *data, discrete);
    const VectorXd balanced = calc_u_dot(system_, *data, 0.3, q_, u_);
    MatrixXd mass;
    VectorXd force, u_dot = random.vector_n(tree().num_u);
    calc_dense_equations(tree(), data->tree, mass, force);
    const VectorXd imbalance = calc_imbalance(tree(), data->tree, u_dot).force;
    const VectorXd none = calc_imbalance(tree(), data->tree, balanced).force;
    const auto is_free = [&](int row) { return data->tree.mode[static_cast<size_t>(row)] == HingeMode::Free; };
    for (int row = 0; row < tree().num_u; ++row)
      if (!is_free(row)) u_dot[row] = 0;
    const VectorXd expected = force - mass * u_dot;
    const double size = 1 + force.norm() + (mass * u_dot).norm();
    for (int row = 0; row < tree().num_u; ++row) {
      EXPECT_NEAR(imbalance[row], is_free(row) ? expected[row] : 0, 1e-12 * size) << row;
      EXPECT_NEAR(none[row], 0, 1e-10 * size) << row;
    }
  }
}

TEST_P(ResponseTest, JumpsOfGivenRatesKeepTheMomentaAlongFreeCoordinates) {
  auto data = system_.make_data();
  const DiscreteState discrete = lock_some();
  set_modes(system_, *data, discrete);
  calc_u_dot(system_, *data, 0.3, q_, u_);
  MatrixXd mass;
  VectorXd force, du(tree().num_u);
  calc_dense_equations(tree(), data->tree, mass, force);
  Random random(GetParam());
  const VectorXd given = random.vector_n(tree().num_u);
  solve_jump(tree(), data->tree, given, du);
  const VectorXd impulse = mass * du;
  for (int row = 0; row < tree().num_u; ++row) {
    if (discrete.mode[static_cast<size_t>(row)] == HingeMode::Free) {
      EXPECT_LT(std::abs(impulse[row]), 1e-11 * (1 + impulse.norm())) << row;
    } else {
      EXPECT_EQ(du[row], given[row]) << row;
    }
  }
}

TEST_P(ResponseTest, ReleaseChangesNoRowAndNoMomentum) {
  auto data = system_.make_data();
  const DiscreteState locked = lock_some();
  set_modes(system_, *data, locked);
  calc_u_dot(system_, *data, 0.3, q_, u_);
  const VectorXd q = data->tree.q, u = data->tree.u;
  Vector3d p, l, p_after, l_after;
  calc_momentum(system_, *data, p, l);
  DiscreteState released = locked;
  for (auto& mode : released.mode)
    if (mode == HingeMode::Locked) mode = HingeMode::Free;
  set_modes(system_, *data, released);
  calc_u_dot(system_, *data, 0.3, q, u);
  EXPECT_EQ(data->tree.q, q);
  EXPECT_EQ(data->tree.u, u);
  calc_momentum(system_, *data, p_after, l_after);
  EXPECT_LT((p_after - p).norm() + (l_after - l).norm(), 1e-14 * (1 + p.norm() + l.norm()));
}

INSTANTIATE_TEST_SUITE_P(Seeds, ResponseTest, ::testing::Range(1u, 13u));

TEST(Stages, AreDemandedInTheirOrder) {
  const RandomTree tree = make_random_tree(2, {});
  const System system = build(tree.spec, tree.flex);
  VectorXd q, u;
  make_random_state(system, 3, q, u);
  VectorXd u_dot(system.num_u());
  const Tree& t = system.tree;
  auto data = system.make_data();
  EXPECT_DEATH(calc_velocity(t, u, data->tree), "");
  EXPECT_DEATH(calc_factor(t, data->tree), "");
  calc_position(t, 0, q, data->tree);
  EXPECT_DEATH(solve(t, data->tree, u_dot), "");
  EXPECT_DEATH(add_forces(system, *data, 0), "");
  calc_velocity(t, u, data->tree);
  EXPECT_DEATH(solve(t, data->tree, u_dot), "");
  calc_factor(t, data->tree);
  EXPECT_DEATH(calc_hinge_wrench(t, data->tree, 0), "");
  solve(t, data->tree, u_dot);
  calc_hinge_wrench(t, data->tree, 0);
  calc_position(t, 0, q, data->tree);
  EXPECT_DEATH(solve(t, data->tree, u_dot), "");
}

// An axis through the only point mass: what is left of the inertia about it is rounding, of either sign.
TEST(Pivots, FromRoundingAreNamed) {
  for (unsigned seed = 1; seed < 20; ++seed) {
    Random random(seed);
    records::SystemSpec spec;
    records::BodyRecord rod;
    rod.name = "rod";
    rod.mass = 3;
    rod.cg = random.vector();
    spec.bodies = {rod};
    spec.hinges = {make_hinge_record("ball", records::HingeType::Revolute, "ground", "rod")};
    spec.hinges[0].axis = rod.cg;
    spec.hinges[0].parent_rotation = random.rotation();
    spec.hinges[0].at = {"rod.toml", 7};
    const System system = build(spec);
    auto data = system.make_data();
    VectorXd q(1), u(1);
    system.calc_initial_state(q, u);
    try {
      calc_u_dot(system, *data, 0.25, q, u);
      ADD_FAILURE() << "seed " << seed;
    } catch (const ComputationError& e) {
      EXPECT_EQ(e.items()[0].id, "solver.indefinite-mass");
      EXPECT_NE(std::string(e.what()).find(
                    "rod.toml:7: error: the articulated mass matrix of body 'rod' is not positive definite at t = "
                    "0.25: almost no mass moves along coordinate 1 of its hinge 'ball'"),
                std::string::npos)
          << e.what();
    }
  }
}

// A fault after a joint further out, and of three coordinates the one at fault.
TEST(Pivots, FurtherOutAndOfSeveralCoordinates) {
  records::SystemSpec spec;
  records::BodyRecord frame, bob;
  frame.name = "frame";
  bob.name = "bob";
  bob.mass = 2;
  bob.cg = {0.3, 0.4, 0};
  spec.bodies = {frame, bob};
  spec.hinges = {make_hinge_record("outer", records::HingeType::Universal, "ground", "frame"),
                 make_hinge_record("inner", records::HingeType::Fixed, "frame", "bob")};
  spec.hinges[0].axis = {0, 0, 1};
  spec.hinges[0].axis2 = {0.3, 0.4, 0};
  const System system = build(spec);
  auto data = system.make_data();
  try {
    calc_u_dot(system, *data, 0, VectorXd::Zero(2), VectorXd::Zero(2));
    ADD_FAILURE();
  } catch (const ComputationError& e) {
    EXPECT_NE(std::string(e.what()).find("coordinate 2 of its hinge 'outer'"), std::string::npos) << e.what();
  }
}

// Inner and outer axis of a gimbal meet: there is mass enough, and the message does not ask for more.
TEST(Pivots, AGimbalLockIsNamed) {
  for (const auto& [axes, middle] : {std::pair{"zxz", 0.0}, {"xyz", 1.5707963267948966}}) {
    Random random(3);
    records::SystemSpec spec;
    spec.bodies = {make_rigid_record("b", random)};
    spec.hinges = {make_hinge_record("wrist", records::HingeType::General, "ground", "b")};
    spec.hinges[0].rotations = axes;
    const System system = build(spec);
    auto data = system.make_data();
    const Vector3d q(0.4, middle, 0.7);
    try {
      calc_u_dot(system, *data, 0.25, q, VectorXd::Zero(3));
      ADD_FAILURE() << axes;
    } catch (const ComputationError& e) {
      EXPECT_EQ(e.items()[0].id, "solver.gimbal-lock");
      EXPECT_NE(
          std::string(e.what()).find("gimbal lock: the axes of coordinates 1 and 3 of hinge 'wrist' have come within"),
          std::string::npos)
          << e.what();
    }
    const VectorXd next = calc_u_dot(system, *data, 0.25, q + Vector3d(0, 0.3, 0), VectorXd::Zero(3));
    EXPECT_TRUE(next.allFinite());
  }
}

}  // namespace
}  // namespace bough::solver::testing
