// Closed loops against their own closed forms.
#include "solver/linear/equilibrium.hpp"
#include "solver/linear/linearize.hpp"
#include "tests/solver/control/support.hpp"

namespace bough::solver::testing {
namespace {

// J θ̈ = -kp θ - kd θ̇.
TEST(Loop, ProportionalDerivativeAxisHasItsPolesAndItsHistory) {
  auto spec = make_axis();
  spec.hinges[0].position = {0.3};
  spec.controllers = {make_law("law", "pid", {"angle"}, {{"kp", {8}}, {"kd", {1.6}}})};
  spec.controllers[0].rate = "rate";
  const RunResult r = run(spec);
  const double sigma = 0.4, wd = std::sqrt(4 - 0.16);
  const VectorXd t = r.sink.time(), angle = r.sink.get("/sensors/angle"), torque = r.sink.get("/actuators/drive");
  for (int i = 0; i < t.size(); ++i) {
    const double exact = 0.3 * std::exp(-sigma * t[i]) * (std::cos(wd * t[i]) + sigma / wd * std::sin(wd * t[i]));
    EXPECT_NEAR(angle[i], exact, 1e-10);
    EXPECT_NEAR(torque[i], -8 * exact - 1.6 * r.sink.get("/sensors/rate")(i, 0), 1e-8);
  }
  EXPECT_EQ(r.sink.get("/controllers/law"), r.sink.get("/actuators/drive"));
  EXPECT_LT(r.outcome.energy_error, 1e-9);

  const System system = build(spec);
  Plant closed(system);
  Diagnostics diagnostics;
  const auto model = linearize(closed, closed.make_initial_point(), {}, {}, diagnostics);
  MatrixXd A(2, 2);  // without ki there is no integral
  A << 0, 1, -4, -0.8;
  EXPECT_LT((model.A - A).norm(), 1e-9) << model.A;
  EXPECT_LT((model.B - Eigen::Vector2d(0, 0.5)).norm(), 1e-9);
  EXPECT_EQ(model.inputs.name, std::vector<std::string>{"drive"});
  EXPECT_EQ(model.outputs.name, (std::vector<std::string>{"angle", "rate"}));

  Plant open(system, true);
  open.hold_commands(open.make_initial_point());
  const auto plant = linearize(open, open.make_initial_point(), {}, {}, diagnostics);
  EXPECT_LT((plant.A - (MatrixXd(2, 2) << 0, 1, 0, 0).finished()).norm(), 1e-9);
}

// States: θ, ω, I, F with Ḟ = (e - F)/τ and u = kp e + I + kd (e - F)/τ.
TEST(Loop, PidFollowsAStepAsItsLinearEquationsSay) {
  auto spec = make_axis();
  const double kp = 6, ki = 3, kd = 4, tau = 0.1, J = 2;
  spec.functions = {make_step("target", 0.5, 0.7)};
  spec.controllers = {make_law("law", "pid", {"angle"}, {{"kp", {kp}}, {"ki", {ki}}, {"kd", {kd}}, {"filter", {tau}}})};
  spec.controllers[0].reference = "target";
  const RunResult r = run(spec);
  MatrixXd A(4, 4);
  A << 0, 1, 0, 0,                                    //
      (-kp - kd / tau) / J, 0, 1 / J, -kd / tau / J,  //
      -ki, 0, 0, 0, -1 / tau, 0, 0, -1 / tau;
  const Eigen::Vector4d b = 0.5 * Eigen::Vector4d(0, (kp + kd / tau) / J, ki, 1 / tau);
  const VectorXd t = r.sink.time(), angle = r.sink.get("/sensors/angle");
  for (int i = 0; i < t.size(); ++i) {
    const double exact = t[i] > 0.7 ? propagate(A, b, Eigen::Vector4d::Zero(), t[i] - 0.7)[0] : 0;
    EXPECT_NEAR(angle[i], exact, 1e-9) << t[i];
  }
  EXPECT_DOUBLE_EQ(r.sink.get("/signals/target")(99, 0), 0.5);
}

// Back-calculation keeps the integral near the limit: the output leaves it soon after the error changes its sign.
// An actuator without an input has its command all the same.
TEST(Loop, AnActuatorThatNothingCommandsIsAnInputOfTheLinearModel) {
  auto spec = make_axis();
  spec.actuators[0].input.clear();
  const System system = build(spec);
  for (const bool is_open : {false, true}) {
    Plant plant(system, is_open);
    plant.hold_commands(plant.make_initial_point());
    Diagnostics diagnostics;
    const auto model = linearize(plant, plant.make_initial_point(), {}, {}, diagnostics);
    EXPECT_LT((model.B - Eigen::Vector2d(0, 0.5)).norm(), 1e-12) << is_open;
  }
}

// Limits without ki leave no bias behind.
TEST(Loop, WithoutKiNothingWindsUp) {
  auto spec = make_axis();
  spec.controllers = {make_law("law", "pid", {"angle"},
                               {{"kp", {8}}, {"kd", {6}}, {"lower", {-1}}, {"upper", {1}}, {"setpoint", {1}}})};
  spec.controllers[0].rate = "rate";
  spec.simulation.duration = 60;
  const RunResult r = run(spec);
  const VectorXd angle = r.sink.get("/sensors/angle");
  EXPECT_NEAR(angle[angle.size() - 1], 1, 1e-6);
}

TEST(Loop, AWoundUpIntegralIsLetGo) {
  auto spec = make_axis();
  spec.functions = {make_step("target", 3, 0)};
  spec.controllers = {make_law("law", "pid", {"angle"}, {{"kp", {2}}, {"ki", {0.4}}, {"kd", {4}}})};
  spec.controllers[0].settings.numbers["upper"] = {0.5};
  spec.controllers[0].settings.numbers["lower"] = {-0.5};
  spec.controllers[0].reference = "target";
  spec.controllers[0].rate = "rate";
  spec.simulation.duration = 40;
  spec.simulation.relative_tolerance = 1e-8;
  const RunResult kept = run(spec);
  EXPECT_LE(kept.sink.get("/controllers/law").maxCoeff(), 0.5);
  spec.controllers[0].settings.numbers["windup_time"] = {1e9};
  const RunResult wound = run(spec);
  const double over = kept.sink.get("/sensors/angle").maxCoeff() - 3;
  EXPECT_GT(wound.sink.get("/sensors/angle").maxCoeff() - 3, 2 * over);
  EXPECT_NEAR(kept.sink.get("/sensors/angle")(kept.sink.num_samples() - 1, 0), 3, 0.02);
}

// θ and ω go exactly through each stretch of constant torque; the law's outputs come a delay after its samples.
TEST(Loop, ASampledLawWithDelayIsItsRecursion) {
  for (const double delay : {0.0, 0.06, 0.1, 0.23}) {
    auto spec = make_axis();
    spec.hinges[0].position = {0.3};
    const double T = 0.1, kp = 4, kd = 3;
    spec.controllers = {make_law("law", "gain", {"angle", "rate"}, {{"sample_time", {T}}, {"delay", {delay}}})};
    spec.controllers[0].settings.matrices["gain"] = (MatrixXd(1, 2) << -kp, -kd).finished();
    const RunResult r = run(spec);
    const VectorXd t = r.sink.time(), angle = r.sink.get("/sensors/angle"), torque = r.sink.get("/actuators/drive");
    double theta = 0.3, omega = 0, now = 0, held = 0;
    std::vector<double> sent;
    size_t released = 0;
    const auto advance = [&](double to) {
      const double h = to - now;
      theta += h * omega + h * h / 2 * held / 2;
      omega += h * held / 2;
      now = to;
    };
    int k = 0;
    for (int i = 0; i < t.size(); ++i) {
      // All instants up to t[i]; at one time a release comes after the sample.
      for (;;) {
        const double sample = k * T, release = static_cast<double>(released) * T + delay;
        const double next = std::min(sample, release);
        if (next > t[i] + 1e-9) break;
        advance(next);
        if (sample <= release + 1e-12 && sample <= next + 1e-12) {
          sent.push_back(-kp * theta - kd * omega);
          ++k;
        } else {
          held = sent[released++];
        }
      }
      advance(t[i]);
      EXPECT_NEAR(angle[i], theta, 1e-11) << "delay " << delay << " t " << t[i];
      EXPECT_NEAR(torque[i], held, 1e-10) << "delay " << delay << " t " << t[i];
    }
    EXPECT_LT(r.outcome.energy_error, 1e-10);
  }
}

// Two links in a plane under two laws: the small motion follows the linear model of the closed loop.
TEST(Loop, TwoLinksMoveAsTheirLinearModelSays) {
  auto spec = make_axis();
  auto& first = spec.bodies[0];
  first.mass = 3;
  first.cg = {0.5, 0, 0};
  records::BodyRecord second = first;
  second.name = "fore";
  second.mass = 1;
  spec.bodies.push_back(second);
  spec.hinges.push_back(make_hinge_record("elbow", records::HingeType::Revolute, "rotor", "fore"));
  spec.hinges[1].axis = {0, 0, 1};
  spec.hinges[1].parent_position = {1, 0, 0};
  spec.hinges[0].position = {1e-4};
  spec.hinges[1].position = {-2e-4};
  spec.sensors.push_back(make_sensor("angle2", records::SensorType::HingeAngle, "", "elbow"));
  spec.sensors.push_back(make_sensor("rate2", records::SensorType::HingeRate, "", "elbow"));
  spec.controllers = {make_law("law", "pid", {"angle"}, {{"kp", {30}}, {"kd", {6}}}),
                      make_law("law2", "pid", {"angle2"}, {{"kp", {9}}, {"kd", {1.5}}})};
  spec.controllers[0].rate = "rate";
  spec.controllers[1].rate = "rate2";
  spec.actuators.push_back(make_drive("drive2", "elbow", "law2"));
  const RunResult r = run(spec);
  auto level = spec;
  level.hinges[0].position = level.hinges[1].position = {0};
  const System system = build(level);
  Plant plant(system);
  Diagnostics diagnostics;
  const auto model = linearize(plant, plant.make_initial_point(), {}, {}, diagnostics);
  ASSERT_EQ(model.A.rows(), 4);
  VectorXd x = VectorXd::Zero(4);
  x[0] = 1e-4;
  x[1] = -2e-4;
  const VectorXd t = r.sink.time(), elbow = r.sink.get("/sensors/angle2");
  for (int i = 0; i < t.size(); i += 10)
    EXPECT_NEAR(elbow[i], propagate(model.A, VectorXd::Zero(4), x, t[i])[1], 2e-4 * 1e-6) << t[i];
}

TEST(Loop, TheAxisStandsWhereItsLawAndItsLoadBalance) {
  auto spec = make_axis();
  spec.functions = {make_step("target", 0.5, -1)};
  spec.controllers = {make_law("law", "pid", {"angle"}, {{"kp", {6}}, {"ki", {3}}, {"kd", {4}}})};
  spec.controllers[0].reference = "target";
  spec.controllers[0].rate = "rate";
  spec.hinges[0].stiffness = {1.5};
  const System system = build(spec);
  Plant plant(system);
  const auto found = find_equilibrium(plant, plant.make_initial_point(), {});
  EXPECT_NEAR(found.point.q[0], 0.5, 1e-10);
  EXPECT_NEAR(found.point.z[0], 0.75, 1e-9);  // the integral holds the spring
}

}  // namespace
}  // namespace bough::solver::testing
