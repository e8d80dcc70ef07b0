// Jumps of given rates: impulses by M⁻¹, momentum kept, what they did booked as work.
#include <gtest/gtest.h>

#include "solver/simulate/memory_sink.hpp"
#include "solver/simulate/simulate.hpp"
#include "tests/solver/support/records.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;

/// A slide of given motion, whose rate jumps from 0 to 10 at t = 1, with a pendulum of mass 1 and length 1 on it.
/// \param J  inertia of the pendulum about its centre of mass.
records::SystemSpec make_cart_with_pendulum(double J) {
  records::SystemSpec spec;
  spec.bodies = {make_body_record("cart", 1, {1, 1, 1}), make_body_record("bob", 1, {J, J, J}, {0, -1, 0})};
  spec.functions = {make_function("go", "ramp", {{"value", 10}, {"from", 1}, {"to", 2}})};
  spec.hinges = {make_hinge_record("slide", HingeType::Prismatic, "ground", "cart"),
                 make_hinge_record("pin", HingeType::Revolute, "cart", "bob")};
  spec.hinges[0].axis = {1, 0, 0};
  spec.hinges[0].motion = {"go"};
  spec.simulation.output_step = 0.25;
  spec.simulation.relative_tolerance = 1e-11;
  spec.simulation.absolute_tolerance = 1e-14;
  return spec;
}

// A slide that starts at 10 carries a pendulum of length 1 (mass 1, inertia J about its centre) that hangs: the pin
// gives it the impulse p with p = m (10 + ω), J ω = -p, so ω = -10 m / (m + J).
TEST(Jump, OfASlideSwingsThePendulumOnIt) {
  const double J = 0.001, expected = -10 / (1 + J);
  auto spec = make_cart_with_pendulum(J);
  spec.simulation.duration = 1.5;
  for (const char* integrator : {"adams", "rk", "rk4"}) {
    spec.simulation.integrator = integrator;
    spec.simulation.step = std::string(integrator) == "rk4" ? 0.01 : 0;
    const System system = build(spec);
    MemorySink sink;
    Diagnostics diagnostics;
    const auto outcome = simulate(system, spec, sink, {}, diagnostics);
    const VectorXd t = sink.time(), rate = sink.get("/hinges/pin/qdot"), work = sink.get("/energy/work");
    ASSERT_EQ(t[4], 1);
    EXPECT_EQ(rate[3], 0);
    EXPECT_NEAR(rate[4], expected, 1e-9) << integrator;  // the sample at the jump is that after it
    const VectorXd kinetic = sink.get("/energy/kinetic");
    EXPECT_NEAR(kinetic[4], 50 + 0.5 * (10 + expected) * (10 + expected) + 0.5 * J * expected * expected, 1e-6);
    EXPECT_NEAR(work[4], kinetic[4], 1e-9 * kinetic[4]);
    EXPECT_LT(std::abs(outcome.last.energy_error), 1e-6) << integrator;
    ASSERT_EQ(sink.events().size(), 1u);
    EXPECT_EQ(sink.events()[0].time, 1);
    EXPECT_NE(sink.events()[0].what.find("coordinate 1 of hinge 'slide' jumps from 0 to 10 by an impulse of 10.0"),
              std::string::npos)
        << sink.events()[0].what;
  }
}

// The last sample of a run that ends where the rate jumps is that after the jump, and its work is booked.
TEST(Jump, AtTheEndOfTheRun) {
  auto spec = make_cart_with_pendulum(0.1);
  spec.simulation.gravity = {0, -9.81, 0};
  for (const double duration : {2.0, 2.5}) {
    spec.simulation.duration = duration;
    const System system = build(spec);
    MemorySink sink;
    Diagnostics diagnostics;
    const auto outcome = simulate(system, spec, sink, {}, diagnostics);
    EXPECT_LT(outcome.energy_error, 1e-6) << duration;
    EXPECT_EQ(sink.events().size(), 2u) << duration;
    EXPECT_EQ(sink.get("/hinges/slide/qdot")(8), 0) << duration;
  }
}

// Two free bodies on a hinge that turns: locking it takes their relative rate, linear and angular momentum stay.
TEST(Jump, ByLockingKeepsTheMomenta) {
  RandomTreeOptions options;
  options.to_ground = options.forces = options.prescribed = false;
  for (unsigned seed = 1; seed < 9; ++seed) {
    const RandomTree tree = make_random_tree(seed, options);
    const System system = build(tree.spec, tree.flex);
    VectorXd q, u;
    make_random_state(system, seed, q, u);
    auto data = system.make_data();
    calc_kinematics(system, *data, 0, q, u);
    Vector3d p, l, p_after, l_after;
    calc_momentum(system, *data, p, l);
    const double before = calc_energies(system, *data).kinetic;
    DiscreteState locked = system.make_initial_state().discrete;
    const Tree& t = system.tree;
    for (int b = 1; b < t.size(); ++b)
      for (int i = 0; i < t[b].num_hinge_u(); ++i)
        locked.mode[static_cast<size_t>(t[b].u_offset + i)] = HingeMode::Locked;
    double work = 0;
    std::vector<std::string> events;
    EXPECT_TRUE(cross_jump(system, *data, 0, 0, &locked, q, u, work, events));
    calc_momentum(system, *data, p_after, l_after);
    EXPECT_LT((p_after - p).norm() + (l_after - l).norm(), 1e-12 * (1 + p.norm() + l.norm())) << seed;
    EXPECT_LE(work, 1e-12 * before);  // a capture only loses
    EXPECT_NEAR(calc_energies(system, *data).kinetic, before + work, 1e-12 * before);
    EXPECT_FALSE(events.empty());
    // Released again, nothing moves.
    const VectorXd u_locked = u;
    const DiscreteState free = system.make_initial_state().discrete;
    EXPECT_FALSE(cross_jump(system, *data, 0, 0, &free, q, u, work, events));
    EXPECT_EQ(u, u_locked);
  }
}

class MotionTest : public ::testing::Test {
 protected:
  MotionTest() {
    Random random(3);
    spec_.bodies = {make_rigid_record("arm", random)};
    spec_.hinges = {make_hinge_record("pin", HingeType::Universal, "ground", "arm")};
    spec_.hinges[0].axis2 = {0, 1, 0};
    spec_.hinges[0].at = {"sys.toml", 4};
    spec_.functions = {make_function("hop", "step", {{"value", 1}, {"at", 0.5}, {"before", 0}}),
                       make_function("wave", "sine", {{"amplitude", 0.7}, {"omega", 2}, {"phase", 0}, {"offset", 0}})};
    spec_.simulation.duration = 1;
  }
  std::string try_build() {
    try {
      build(spec_);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }
  records::SystemSpec spec_;
};

// "system.motion-jumps"
TEST_F(MotionTest, ATeleportIsAnError) {
  spec_.hinges[0].motion = {"hop", "wave"};
  EXPECT_NE(try_build().find("sys.toml:4: error: hinge 'pin': the prescribed motion of coordinate 1 jumps from 0 to 1 "
                             "at t = 0.5"),
            std::string::npos)
      << try_build();
  spec_.simulation.duration = 0.4;  // after the run
  EXPECT_EQ(try_build(), "");
}

TEST_F(MotionTest, OneCoordinateMayBePrescribedAndOneFree) {
  spec_.hinges[0].motion = {"", "wave"};
  const System system = build(spec_);
  EXPECT_EQ(system.num_u(), 2);
  EXPECT_EQ(system.num_dofs(), 1);
  auto data = system.make_data();
  const VectorXd q = Eigen::Vector2d(0.3, 9), u = Eigen::Vector2d(0.8, 9);
  const VectorXd u_dot = calc_u_dot(system, *data, 0.3, q, u);
  VectorXd dense(2);
  calc_accelerations_dense(system, *data, 0.3, dense);
  EXPECT_LT((u_dot - dense).norm(), 1e-12);
  EXPECT_NEAR(u_dot[1], -4 * 0.7 * std::sin(0.6), 1e-14);
}

TEST_F(MotionTest, LocksAreChecked) {
  auto& hinge = spec_.hinges[0];
  hinge.locked = {true};
  EXPECT_NE(try_build().find("locked has 1 values, expected 2"), std::string::npos);
  hinge.locked = {true, false};
  hinge.rate = {1, 0};
  EXPECT_NE(try_build().find("system.locked-motion"), std::string::npos) << try_build();
  hinge.rate = {0, 1};
  const System system = build(spec_);
  EXPECT_EQ(system.num_dofs(), 1);
  EXPECT_EQ(system.make_initial_state().discrete.mode[0], HingeMode::Locked);
  hinge = make_hinge_record("pin", HingeType::Spherical, "ground", "arm");
  hinge.locked = {true, false, true};
  EXPECT_NE(try_build().find("system.partial-lock"), std::string::npos) << try_build();
}

// The torque follows the body through half a turn, and near a whole one the run ends with a reason.
TEST(SphericalSpring, GoesOnPastHalfATurn) {
  records::SystemSpec spec;
  Random random(3);
  spec.bodies = {make_rigid_record("arm", random)};
  spec.hinges = {make_hinge_record("ball", HingeType::Spherical, "ground", "arm")};
  spec.hinges[0].stiffness = {2, 2, 2};
  spec.hinges[0].position = {-1, 0, 0, 0};  // as good as 1, 0, 0, 0
  const System system = build(spec);
  auto data = system.make_data();
  EXPECT_EQ(system.make_initial_state().x[3], 1);
  const Vector3d axis = Vector3d(1, 2, 2) / 3;
  VectorXd torque(3), shown(4), rate(3);
  for (const double angle : {3.1, 3.14, 3.15, 3.2, 5.9}) {
    VectorXd q(4);
    q << std::sin(angle / 2) * axis, std::cos(angle / 2);
    calc_kinematics(system, *data, 0, q, VectorXd::Zero(3));
    add_forces(system, *data, 0);
    get_hinge(get_motion(system, *data), 0, shown, rate, torque);
    EXPECT_LT((torque + 2 * angle * axis).norm(), 1e-11) << angle;
  }
  VectorXd q(4);
  q << std::sin(3.05) * axis, std::cos(3.05);
  calc_kinematics(system, *data, 0.5, q, VectorXd::Zero(3));
  try {
    add_forces(system, *data, 0.5);
    ADD_FAILURE();
  } catch (const ComputationError& e) {
    EXPECT_EQ(e.items()[0].id, "solver.spring-past-turn");
    EXPECT_NE(std::string(e.what()).find("hinge 'ball' is turned by more than 343 degrees at t = 0.5"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace bough::solver::testing
