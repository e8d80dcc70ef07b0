// Linear models against hand equations, finite differences along true motions and the flow of the full equations.
#include <gtest/gtest.h>

#include "solver/linear/linearize.hpp"
#include "solver/state/difference.hpp"
#include "tests/solver/support/records.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;

Plant make_plant(const System& system) {
  Diagnostics diagnostics;
  Plant plant(system);
  diagnostics.throw_if_errors();
  return plant;
}

records::LinearModel linearize_initial(const records::SystemSpec& spec, const LinearizeOptions& options = {},
                                       const std::map<std::string, records::FlexBody>& flex = {}) {
  const System system = build(spec, flex);
  Plant plant = make_plant(system);
  Diagnostics diagnostics;
  return linearize(plant, plant.make_initial_point(), options, {}, diagnostics);
}

records::SystemSpec make_pendulum() {
  records::SystemSpec spec;
  spec.simulation.gravity = {0, -9.81, 0};
  spec.bodies = {make_body_record("bob", 2, Vector3d::Zero(), {0, -0.7, 0})};
  spec.hinges = {make_hinge_record("pin", HingeType::Revolute, "ground", "bob")};
  spec.hinges[0].damping = {0.05};
  spec.sensors = {make_sensor("angle", records::SensorType::HingeAngle, "", "pin")};
  return spec;
}

TEST(Difference, ExtrapolatesAndTellsItsError) {
  const auto f = [](double h) {
    if (std::abs(h) > 0.3) throw ComputationError("test.far", {}, "too far");
    return VectorXd(Eigen::Vector4d(std::sin(1 + h), 3 * h * h + 2 * h - 1, std::cos(h), 1e6 * std::exp(-20 * h)));
  };
  const Difference d = differentiate(f, 1);
  EXPECT_NEAR(d.value[0], std::cos(1), 1e-12);
  EXPECT_NEAR(d.value[1], 2, 1e-13);
  EXPECT_LE(std::abs(d.value[2]), d.error[2]);
  EXPECT_NEAR(d.value[3], -2e7, 1e-2);
  EXPECT_LE(std::abs(d.value[3] + 2e7), d.error[3] * 10);
  EXPECT_THROW(differentiate([](double) -> VectorXd { throw ComputationError("test.far", {}, "no"); }, 1),
               ComputationError);
  try {
    differentiate([](double h) { return VectorXd(VectorXd::Constant(1, std::sqrt(-1 - h * h))); }, 1);
    FAIL();
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.items()[0].id, "linear.no-derivative");
  }
}

TEST(Difference, ShrinksToTheDetailsOfTheFunction) {
  // Far finer than the step: saturation, a soft kink, a detail that large steps do not see at all, a limit.
  const auto f = [](double h) {
    return VectorXd(Eigen::Vector4d(std::tanh(h / 1e-8), std::sqrt(h * h + 1e-14) + 3 * h,
                                    std::abs(h) < 1e-7 ? 5 * h : h, std::clamp(2 * h, -1e-9, 1e-6)));
  };
  const Difference d = differentiate(f, 0.1);
  EXPECT_NEAR(d.value[0], 1e8, 1e-4 * 1e8);
  EXPECT_NEAR(d.value[1], 3, 1e-5);
  EXPECT_NEAR(d.value[2], 5, 1e-5);
  EXPECT_NEAR(d.value[3], 2, 1e-5);
  for (int e = 0; e < 4; ++e) {
    EXPECT_LT(d.error[e], 1e-3 * std::abs(d.value[e])) << e;
    EXPECT_EQ(d.is_roundoff[static_cast<size_t>(e)], 0) << e;
  }
}

TEST(Difference, FindsAKinkAndNoneBesideIt) {
  const auto f = [](double h) {
    return VectorXd(Eigen::Vector4d(std::abs(h), 2 * h + 3 * std::max(0.0, h), std::abs(h - 1e-3), h * h));
  };
  const Difference d = differentiate(f, 0.1);
  EXPECT_NEAR(d.kink[0], 1, 1e-12);
  EXPECT_NEAR(d.kink[1], 1.5, 1e-12);
  EXPECT_EQ(d.kink[2], 0);
  EXPECT_EQ(d.kink[3], 0);
  EXPECT_NEAR(d.value[1], 3.5, 1e-12);
  EXPECT_NEAR(d.value[2], -1, 1e-9);
}

TEST(Difference, AJumpIsNoZero) {
  const Difference d = differentiate([](double h) { return VectorXd(VectorXd::Constant(1, h >= 0 ? 1 : 0)); }, 0.1);
  EXPECT_GT(d.error[0], 0.1);
  EXPECT_EQ(d.is_roundoff[0], 0);
}

TEST(Linearize, Pendulum) {
  const auto model = linearize_initial(make_pendulum(), {{"pin"}, {}, true});
  const double I = 2 * 0.7 * 0.7;
  MatrixXd A(2, 2);
  A << 0, 1, -9.81 / 0.7, -0.05 / I;
  EXPECT_LT((model.A - A).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_NEAR(model.B(1, 0), 1 / I, 1e-14);
  EXPECT_EQ(model.B(0, 0), 0);
  EXPECT_EQ(model.C, Eigen::RowVector2d(1, 0));
  EXPECT_EQ(model.D(0, 0), 0);
  EXPECT_EQ(model.states.name, (std::vector<std::string>{"pin:1", "pin:1_dot"}));
  EXPECT_EQ(model.inputs.name, std::vector<std::string>{"pin:1"});
  EXPECT_EQ(model.outputs.name, std::vector<std::string>{"angle"});
  EXPECT_NEAR(model.poles.frequency_hz[0], std::sqrt(9.81 / 0.7) / (2 * M_PI), 1e-11);
  EXPECT_NEAR(model.poles.damping[0], 0.05 / I / (2 * std::sqrt(9.81 / 0.7)), 1e-11);
  EXPECT_EQ(model.poles.mode[0], "pin:1");
  EXPECT_EQ(model.residual, 0);
  EXPECT_LT(model.error, 1e-10);
  EXPECT_LT(model.difference, 1e-10);
  EXPECT_TRUE(model.has_zeros);
  EXPECT_EQ(model.zeros_real.size(), 0);
}

TEST(Linearize, InvertedPendulumIsUnstable) {
  auto spec = make_pendulum();
  spec.hinges[0].position = {M_PI};
  spec.hinges[0].damping.clear();
  const auto model = linearize_initial(spec, {{"pin"}, {}, true});
  EXPECT_NEAR(model.poles.real.maxCoeff(), std::sqrt(9.81 / 0.7), 1e-9);
}

TEST(Linearize, NamesThatAreNotThere) {
  const auto spec = make_pendulum();
  const System system = build(spec);
  Plant plant = make_plant(system);
  Diagnostics diagnostics;
  try {
    linearize(plant, plant.make_initial_point(), {{"pun"}, {"engle"}, true}, {}, diagnostics);
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.items().size(), 2u);
    EXPECT_EQ(error.items()[0].id, "linear.unknown-input");
    EXPECT_EQ(error.items()[1].id, "linear.unknown-output");
    EXPECT_NE(error.items()[1].advice.find("angle"), std::string::npos);
  }
}

TEST(Linearize, APointOffBalanceIsTold) {
  auto spec = make_pendulum();
  spec.hinges[0].position = {0.5};
  spec.hinges[0].rate = {2};
  const System system = build(spec);
  Plant plant = make_plant(system);
  Diagnostics diagnostics;
  const auto model = linearize(plant, plant.make_initial_point(), {{"pin"}, {}, true}, {}, diagnostics);
  EXPECT_TRUE(diagnostics.has("linear.not-steady"));
  EXPECT_TRUE(diagnostics.has("linear.time-varying"));
  EXPECT_NEAR(model.A(1, 0), -9.81 / 0.7 * std::cos(0.5), 1e-10);
}

TEST(Linearize, AFreeBodyHasSixPairsOfPolesAtZero) {
  records::SystemSpec spec;
  spec.simulation.gravity.setZero();
  Random random(3);
  spec.bodies = {make_rigid_record("rock", random)};
  const auto model = linearize_initial(spec);
  ASSERT_EQ(model.poles.size(), 12);
  EXPECT_EQ(model.poles.real.cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(model.poles.imag.cwiseAbs().maxCoeff(), 0);
}

TEST(Linearize, NutationOfASpinningFreeBody) {
  // About the spin axis z: body-fixed rates turn at (I3 - I1)/I1 · Ω for I1 = I2, whatever the attitude.
  records::SystemSpec spec;
  spec.simulation.gravity.setZero();
  spec.bodies = {make_body_record("top", 4, {2, 2, 3})};
  spec.hinges = {make_hinge_record("float", HingeType::Free, "ground", "top")};
  spec.hinges[0].position = {std::cos(0.3), std::sin(0.3), 0, 0, 1, 2, 3};
  spec.hinges[0].rate = {0, 0, 5, 0, 0, 0};
  const System system = build(spec);
  Plant plant = make_plant(system);
  Diagnostics diagnostics;
  const auto model = linearize(plant, plant.make_initial_point(), {}, {}, diagnostics);
  EXPECT_FALSE(diagnostics.has("linear.time-varying"));
  EXPECT_FALSE(diagnostics.has("linear.not-steady"));
  // In body axes: nutation at Ω/2, attitude error seen from the turning frame at Ω, the rest at zero.
  std::vector<double> expected{0, 0, 0, 0, 0, 0, 0, 0, 2.5, 2.5, 5, 5};
  for (int i = 0; i < 12; ++i) {
    EXPECT_NEAR(std::abs(model.poles.imag[i]), expected[static_cast<size_t>(i)], 1e-9) << i;
    EXPECT_NEAR(model.poles.real[i], 0, 1e-9);
  }
}

/// x = [δ; δu] of a state seen from a reference.
VectorXd calc_departure(const System& system, const Plant& plant, const VectorXd& q0_all, const VectorXd& u0,
                        const VectorXd& q, const VectorXd& u) {
  VectorXd x(system.num_u());
  for (int b = 0; b < system.num_bodies(); ++b) {
    int q_row = system.q_offset(b), u_row = system.u_offset(b), left = system.num_hinge_rates(b);
    if (left > 0 && system.num_hinge_q(b) > left) {
      const Eigen::Quaterniond q0(Eigen::Vector4d(q0_all.segment<4>(q_row))), q1(Eigen::Vector4d(q.segment<4>(q_row)));
      const Eigen::AngleAxisd turn((q0.conjugate() * q1).normalized());
      x.segment<3>(u_row) = turn.angle() * turn.axis();
      q_row += 4, u_row += 3, left -= 3;
    }
    x.segment(u_row, left) = q.segment(q_row, left) - q0_all.segment(q_row, left);
    x.segment(system.eta_dot_offset(b), system.num_modes(b)) =
        q.segment(system.eta_offset(b), system.num_modes(b)) -
        q0_all.segment(system.eta_offset(b), system.num_modes(b));
  }
  VectorXd all(2 * plant.num_dofs());
  all << plant.restrict(x), plant.restrict(u - u0);
  return all;
}

// Neighbours of a motion, by the nonlinear equations, against ẋ = A x: holds at any state, steady or not.
TEST(Linearize, NeighboursOfAMotionDepartAsASays) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    RandomTreeOptions o;
    o.num_bodies = 5;
    o.prescribed = seed % 2 == 0;
    o.to_ground = seed % 3 != 0;
    const RandomTree tree = make_random_tree(seed, o);
    const System system = build(tree.spec, tree.flex);
    auto data = system.make_data();
    Plant plant = make_plant(system);
    OperatingPoint point = plant.make_initial_point();
    VectorXd rates;
    make_random_state(system, seed + 10, point.q, rates);
    point.u = plant.restrict(rates);
    Diagnostics diagnostics;
    const auto model = linearize(plant, point, {}, {}, diagnostics);
    EXPECT_LT(model.error, 1e-8);
    EXPECT_LT(model.difference, 1e-8);
    const int n = plant.num_dofs();
    Random random(seed);
    const VectorXd x0 = random.vector_n(2 * n, 1);
    // Central in the size of the departure, one-sided in time and extrapolated: d/dt x at t = 0.
    const double h = 1e-4, dt = 1e-4;
    const auto depart = [&](double size, double time) {
      VectorXd q0 = point.q, u0 = plant.expand(point.u);
      VectorXd q = plant.displace(point.q, size * x0.head(n)), u = plant.expand(point.u + size * x0.tail(n));
      if (time != 0) {
        step_rk4(system, *data, 0, time, q0, u0);
        step_rk4(system, *data, 0, time, q, u);
      }
      return calc_departure(system, plant, q0, u0, q, u);
    };
    const auto slope = [&](double time) {
      const VectorXd ahead = (depart(h, time) - depart(-h, time)) / (2 * h);
      const VectorXd behind = (depart(h, -time) - depart(-h, -time)) / (2 * h);
      return VectorXd((ahead - behind) / (2 * time));
    };
    const VectorXd x_dot = (4 * slope(dt) - slope(2 * dt)) / 3;
    const VectorXd expected = model.A * x0;
    EXPECT_LT((x_dot - expected).cwiseAbs().maxCoeff(), 2e-6 * expected.cwiseAbs().maxCoeff()) << seed;
  }
}

TEST(Linearize, InputsAndOutputsOfARandomTree) {
  RandomTree tree = make_random_tree(4, {});
  for (int b : {0, 2, 5}) {
    const std::string body = tree.spec.bodies[static_cast<size_t>(b)].name;
    for (const auto type : {records::SensorType::Position, records::SensorType::Acceleration,
                            records::SensorType::AngularAcceleration, records::SensorType::Velocity}) {
      auto sensor = make_sensor(body + std::to_string(static_cast<int>(type)), type, body);
      sensor.node = 101;
      if (type == records::SensorType::Acceleration) sensor.frame = "body";
      tree.spec.sensors.push_back(sensor);
    }
  }
  const System system = build(tree.spec, tree.flex);
  Plant plant = make_plant(system);
  OperatingPoint point = plant.make_initial_point();
  VectorXd rates;
  make_random_state(system, 8, point.q, rates);
  point.u = plant.restrict(rates);
  Diagnostics diagnostics;
  LinearizeOptions options;
  for (const auto& input : plant.inputs()) options.inputs.push_back(input.name);
  const auto model = linearize(plant, point, options, {}, diagnostics);
  EXPECT_EQ(model.inputs.size(), static_cast<int>(plant.inputs().size()));
  EXPECT_EQ(model.outputs.size(), 36);
  const int n = plant.num_dofs();
  // Any sum of inputs adds its columns: affine, not only linear for small ones.
  const VectorXd base = plant.evaluate(point);
  for (size_t k = 0; k < plant.inputs().size(); ++k) {
    const VectorXd more = plant.evaluate(point, &plant.inputs()[k], -37.5) - base;
    const auto column = static_cast<Eigen::Index>(k);
    EXPECT_LT((more.head(n) + 37.5 * model.B.col(column).tail(n)).cwiseAbs().maxCoeff(),
              1e-11 * (1 + more.cwiseAbs().maxCoeff()));
    EXPECT_LT((more.tail(36) + 37.5 * model.D.col(column)).cwiseAbs().maxCoeff(),
              1e-11 * (1 + more.cwiseAbs().maxCoeff()));
  }
  // Outputs along a random direction.
  Random random(5);
  const VectorXd x = random.vector_n(2 * n);
  const auto y = [&](double h) {
    OperatingPoint moved{point.t, plant.displace(point.q, h * x.head(n)), point.u + h * x.tail(n)};
    return VectorXd(plant.evaluate(moved).tail(36));
  };
  const VectorXd slope = (8 * (y(1e-4) - y(-1e-4)) - (y(2e-4) - y(-2e-4))) / 12e-4, expected = model.C * x;
  EXPECT_LT((slope - expected).cwiseAbs().maxCoeff(), 1e-8 * expected.cwiseAbs().maxCoeff());
}

TEST(Linearize, ExponentialOfAMovesAsTheFullEquationsForSmallMotions) {
  RandomTreeOptions o;
  o.num_bodies = 4;
  o.prescribed = o.forces = false;
  RandomTree tree = make_random_tree(11, o);
  tree.spec.simulation.gravity.setZero();
  const System system = build(tree.spec, tree.flex);
  auto data = system.make_data();
  Plant plant = make_plant(system);
  const OperatingPoint point = plant.make_initial_point();
  Diagnostics diagnostics;
  const auto model = linearize(plant, point, {}, {}, diagnostics);
  ASSERT_LT(model.residual, 1e-10);
  const int n = system.num_u(), steps = 400;
  const double size = 1e-7, dt = 2.5e-3;
  const VectorXd x0 = Random(2).vector_n(2 * n, size);
  VectorXd q = plant.displace(point.q, x0.head(n)), u = x0.tail(n);
  for (int i = 0; i < steps; ++i) step_rk4(system, *data, i * dt, dt, q, u);
  // The exponential of A over all steps: one step of 20 terms, again and again.
  VectorXd expected = x0;
  for (int i = 0; i < steps; ++i) {
    VectorXd term = expected;
    for (int k = 1; k <= 20; ++k) expected += (term = model.A * term * (dt / k));
  }
  const VectorXd found = calc_departure(system, plant, point.q, plant.expand(point.u), q, u);
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-6 * expected.cwiseAbs().maxCoeff());
}

TEST(Linearize, RowsOfRoundingAreNoErrors) {
  // The slider cannot turn against its rail: the relative rate is a difference of equal terms.
  records::SystemSpec spec;
  records::BodyRecord rail, slider;
  rail.name = "rail";
  slider.name = "slider";
  rail.mass = slider.mass = 1.3;
  rail.cg = {0.1, 0.2, -0.3};
  slider.cg = {0.3, -0.1, 0.2};
  rail.inertia = slider.inertia = Vector3d(0.3, 0.4, 0.5).asDiagonal();
  spec.bodies = {rail, slider};
  spec.hinges = {make_hinge_record("ball", HingeType::Spherical, "ground", "rail"),
                 make_hinge_record("slide", HingeType::Prismatic, "rail", "slider")};
  spec.hinges[0].rate = {0.3, -1.1, 0.7};
  spec.hinges[1].position = {0.37};
  spec.hinges[1].axis = Vector3d(1, 2, 3);
  spec.hinges[1].stiffness = {3};
  auto turn = make_sensor("turn", records::SensorType::AngularVelocity, "slider");
  turn.relative_to = turn.frame = "rail";
  spec.sensors = {turn, make_sensor("spin", records::SensorType::AngularVelocity, "slider")};
  const auto model = linearize_initial(spec);
  EXPECT_LT(model.error, 1e-8);
  EXPECT_LT(model.difference, 1e-8);
  EXPECT_LT(model.C.topRows(3).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT(model.C.bottomRows(3).cwiseAbs().maxCoeff(), 0.5);
}

}  // namespace
}  // namespace bough::solver::testing
