// Sensors and actuators against what they stand for.
#include "solver/builder/build_system.hpp"
#include "solver/sensors/noise.hpp"
#include "solver/sensors/sensor.hpp"
#include "tests/solver/control/support.hpp"

namespace bough::solver::testing {
namespace {

using records::SensorType;

/// A free body, turning, with an actuator of the given type on node 0.
records::SystemSpec make_flyer(const std::string& type) {
  auto spec = make_axis();
  spec.bodies[0].inertia << 3, 0.2, 0, 0.2, 4, 0.1, 0, 0.1, 5;
  spec.bodies[0].cg = {0.3, -0.1, 0.2};
  spec.hinges = {make_hinge_record("axis", records::HingeType::Free, "ground", "rotor")};
  spec.hinges[0].rate = {0.3, -0.2, 0.5, 0, 0, 0};
  spec.sensors.clear();
  spec.functions = {make_function("law", "sine", {{"amplitude", 0.4}, {"omega", 2}})};
  spec.actuators[0].type = type;
  spec.actuators[0].hinge.clear();
  spec.actuators[0].body = "rotor";
  return spec;
}

/// The body with two gimbals that turn at rates of one signal.
records::SystemSpec make_double_gimbal() {
  auto spec = make_flyer("double_gimbal_cmg");
  spec.controllers = {make_law("rates", "expression", {"law"})};
  spec.controllers[0].settings.words["expression"] = {"u1", "0.3 - 2*u1"};
  spec.actuators[0].input = "rates";
  spec.actuators[0].settings.numbers = {{"gimbal_axis", {0, 0, 1}},
                                        {"inner_axis", {1, 0, 0}},
                                        {"spin_axis", {0, 2, 0}},
                                        {"momentum", {1.5}},
                                        {"angle", {0.2, -0.4}}};
  return spec;
}

TEST(Wheel, ExchangesMomentumAndKeepsTheWhole) {
  auto spec = make_flyer("wheel");
  spec.actuators[0].settings.numbers = {{"axis", {1, 2, -1}}, {"inertia", {0.05}}, {"momentum", {0.7}}};
  const RunResult r = run(spec);
  const MatrixXd L = r.sink.get("/momentum/angular"), wheel = r.sink.get("/actuators/drive");
  EXPECT_LT((L.rowwise() - L.row(0)).cwiseAbs().maxCoeff(), 1e-11 * L.row(0).norm() + 1e-11);
  EXPECT_LT(r.outcome.energy_error, 1e-9);
  const VectorXd t = r.sink.time();
  for (int i = 0; i < t.size(); ++i)
    EXPECT_NEAR(wheel(i, 1), 0.7 + 0.2 * (1 - std::cos(2 * t[i])), 1e-9);  // ḣ is the motor's torque
}

TEST(Wheel, TakesNoTorqueBeyondItsLimit) {
  auto spec = make_flyer("wheel");
  spec.actuators[0].settings.numbers = {{"axis", {0, 0, 1}}, {"inertia", {0.05}}, {"momentum_limit", {0.15}}};
  const RunResult r = run(spec);
  const VectorXd h = r.sink.get("/actuators/drive").col(1), t = r.sink.time();
  EXPECT_LT(h.cwiseAbs().maxCoeff(), 0.15 + 1e-9);
  for (int i = 0; i < t.size(); ++i) {  // held from 0.2 (1 - cos 2t) = 0.15 to t = π/2, then driven back
    if (t[i] > 0.92 && t[i] < 1.57) {
      EXPECT_NEAR(h[i], 0.15, 1e-9) << t[i];
    }
    if (t[i] > 1.6 && t[i] < 2.6) {
      EXPECT_NEAR(h[i], 0.15 - 0.2 * (1 + std::cos(2 * t[i])), 1e-8) << t[i];
    }
  }
}

TEST(ControlMomentGyro, KeepsTheWholeMomentum) {
  auto spec = make_flyer("cmg");
  spec.actuators[0].settings.numbers = {{"gimbal_axis", {0, 0, 1}}, {"spin_axis", {0, 2, 0}}, {"momentum", {1.5}}};
  const RunResult r = run(spec);
  const MatrixXd L = r.sink.get("/momentum/angular"), cmg = r.sink.get("/actuators/drive");
  EXPECT_LT((L.rowwise() - L.row(0)).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT(r.outcome.energy_error, 1e-9);
  EXPECT_NEAR(cmg(100, 1), 0.2 * (1 - std::cos(10)), 1e-9);
}

/// Rate of the momentum of a rotor of momentum h, in the frame of a body that turns at `rate` while gimbals turn it at
/// `turn`.
Vector3d calc_momentum_rate(const Vector3d& rate, const Vector3d& turn, const Vector3d& h) {
  return (rate + turn).cross(h);
}

// The motor of the gimbal: its torque by the rate of the rotor's momentum, its work by the balance of the body.
TEST(ControlMomentGyro, TorqueOfTheGimbalMotorIsTheMomentumRateAboutItsAxis) {
  auto spec = make_flyer("cmg");
  spec.actuators[0].settings.numbers = {{"gimbal_axis", {0, 0, 1}}, {"spin_axis", {0, 2, 0}}, {"momentum", {1.5}}};
  spec.sensors = {make_sensor("gyro", SensorType::Gyro, "rotor")};
  const RunResult r = run(spec);
  const MatrixXd cmg = r.sink.get("/actuators/drive"), rate = r.sink.get("/sensors/gyro");
  ASSERT_EQ(cmg.cols(), 3);
  double largest = 0;
  for (int i = 0; i < cmg.rows(); ++i) {
    const Vector3d h = 1.5 * Vector3d(-std::sin(cmg(i, 1)), std::cos(cmg(i, 1)), 0), turn(0, 0, cmg(i, 0));
    EXPECT_NEAR(cmg(i, 2), calc_momentum_rate(rate.row(i), turn, h).z(), 1e-12);
    largest = std::max(largest, std::abs(cmg(i, 2)));
  }
  EXPECT_GT(largest, 0.1);
  // Work = ∫ torque · rate dt, by Simpson's rule.
  const VectorXd power = cmg.col(2).cwiseProduct(cmg.col(0)), t = r.sink.time();
  double work = 0;
  for (int i = 0; i + 2 < t.size(); i += 2)
    work += (t[i + 2] - t[i]) / 6 * (power[i] + 4 * power[i + 1] + power[i + 2]);
  const MatrixXd kinetic = r.sink.get("/energy/kinetic");
  EXPECT_NEAR(work, kinetic(kinetic.rows() - 1, 0) - kinetic(0, 0), 1e-5 * std::abs(work));
}

TEST(DoubleGimbal, TorquesOfTheMotorsAreTheMomentumRateAboutTheirAxes) {
  auto spec = make_double_gimbal();
  spec.sensors = {make_sensor("gyro", SensorType::Gyro, "rotor")};
  const RunResult r = run(spec);
  const MatrixXd cmg = r.sink.get("/actuators/drive"), rate = r.sink.get("/sensors/gyro");
  ASSERT_EQ(cmg.cols(), 6);
  for (int i = 0; i < cmg.rows(); ++i) {
    const double a = cmg(i, 2), b = cmg(i, 3);
    const Vector3d inner(std::cos(a), std::sin(a), 0), outer(0, 0, 1);
    const Vector3d h = 1.5 * Vector3d(-std::sin(a) * std::cos(b), std::cos(a) * std::cos(b), std::sin(b));
    const Vector3d h_dot = calc_momentum_rate(rate.row(i), cmg(i, 0) * outer + cmg(i, 1) * inner, h);
    EXPECT_NEAR(cmg(i, 4), h_dot.dot(outer), 1e-12);
    EXPECT_NEAR(cmg(i, 5), h_dot.dot(inner), 1e-12);
  }
}

// Rates of both gimbals from one signal of two numbers; the reaction on the body is that of turning momentum.
TEST(DoubleGimbal, KeepsTheWholeMomentum) {
  auto spec = make_double_gimbal();
  const RunResult r = run(spec);
  const MatrixXd L = r.sink.get("/momentum/angular"), cmg = r.sink.get("/actuators/drive");
  EXPECT_LT((L.rowwise() - L.row(0)).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT(r.outcome.energy_error, 1e-9);
  EXPECT_NEAR(cmg(100, 2), 0.2 + 0.2 * (1 - std::cos(10)), 1e-9);
  EXPECT_NEAR(cmg(100, 3), -0.4 + 1.5 - 0.4 * (1 - std::cos(10)), 1e-9);
}

// With one gimbal at rest it is the other device.
TEST(DoubleGimbal, IsASingleOneWhereOneStandsStill) {
  auto spec = make_flyer("cmg");
  spec.actuators[0].settings.numbers = {{"gimbal_axis", {0, 0, 1}}, {"spin_axis", {0, 2, 0}}, {"momentum", {1.5}}};
  const RunResult single = run(spec);
  spec.controllers = {make_law("rates", "expression", {"law"})};
  spec.controllers[0].settings.words["expression"] = {"u1", "0"};
  spec.actuators[0].type = "double_gimbal_cmg";
  spec.actuators[0].input = "rates";
  spec.actuators[0].settings.numbers["inner_axis"] = {1, 0, 0};
  const RunResult both = run(spec);
  const MatrixXd difference = single.sink.get("/bodies/rotor/quaternion") - both.sink.get("/bodies/rotor/quaternion");
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-9);
}

// One missing axis is one error: nothing is compared with it, and the size of its command is not known.
TEST(DoubleGimbal, OneMissingAxisIsOneError) {
  auto spec = make_flyer("double_gimbal_cmg");
  spec.controllers = {make_law("rates", "expression", {"law"})};
  spec.controllers[0].settings.words["expression"] = {"u1", "0"};
  spec.actuators[0].input = "rates";
  spec.actuators[0].settings.numbers = {{"gimbal_axis", {0, 0, 1}}, {"inner_axis", {1, 0, 0}}, {"momentum", {1.5}}};
  Diagnostics diagnostics;
  draft_system(spec, {}, diagnostics);
  EXPECT_EQ(diagnostics.num_errors(), 1);
}

TEST(Jet, IsOnForItsShortestPulseAtLeast) {
  auto spec = make_flyer("jet");
  spec.functions[0].type = "pulse";
  spec.functions[0].values = {{"value", 1}, {"at", 1}, {"width", 0.02}};
  spec.actuators[0].settings.numbers = {
      {"axis", {0, 0, 1}}, {"thrust", {3}}, {"shortest_pulse", {0.25}}, {"exhaust_velocity", {2}}};
  const RunResult r = run(spec);
  const MatrixXd jet = r.sink.get("/actuators/drive");
  EXPECT_NEAR(jet(100, 1), 3 * 0.25 / 2, 1e-8);
  const VectorXd p = r.sink.get("/momentum/linear").row(100) - r.sink.get("/momentum/linear").row(0);
  EXPECT_GT(p.norm(), 0.6);
  EXPECT_LT(p.norm(), 0.75 + 1e-9);  // of thrust x time, turning with the body
}

// The body keeps its mass; from a hundredth of it on a run says so. Two jets count together.
TEST(Jet, PropellantThatIsMuchOfTheBodyIsAnnounced) {
  auto spec = make_flyer("jet");
  spec.functions = {make_step("law", 1, -1)};
  const double mass = spec.bodies[0].mass, end = spec.simulation.duration, flow = 0.006 * mass / end;
  spec.actuators[0].settings.numbers = {{"axis", {0, 0, 1}}, {"thrust", {2 * flow}}, {"exhaust_velocity", {2}}};
  const RunResult one = run(spec);
  EXPECT_FALSE(one.diagnostics.has("run.propellant"));
  spec.actuators.push_back(spec.actuators[0]);
  spec.actuators[1].name = "other";
  const RunResult two = run(spec);
  ASSERT_TRUE(two.diagnostics.has("run.propellant"));
  for (const auto& d : two.diagnostics.items()) {
    if (d.id == "run.propellant") EXPECT_NE(d.what.find("1.2 % of its mass"), std::string::npos) << d.what;
  }
  EXPECT_EQ(get_last(two.sink, "/system_mass/mass"), mass);
}

// q̈ = (N kt (V - kb N q̇) / R) / J: a lag towards the no-load rate.
TEST(Motor, RunsUpToItsNoLoadRate) {
  auto spec = make_axis();
  spec.functions = {make_step("law", 12, -1)};
  spec.actuators[0].type = "motor";
  spec.actuators[0].settings.numbers = {
      {"torque_constant", {0.5}}, {"resistance", {1.5}}, {"ratio", {3}}, {"back_emf", {0.4}}};
  const RunResult r = run(spec);
  const double lag = 2 * 1.5 / (3 * 0.5 * 0.4 * 3), top = 12 / (0.4 * 3);
  const VectorXd t = r.sink.time(), rate = r.sink.get("/sensors/rate");
  for (int i = 0; i < t.size(); ++i) EXPECT_NEAR(rate[i], top * (1 - std::exp(-t[i] / lag)), 1e-8);
  EXPECT_LT(r.outcome.energy_error, 1e-9);
}

TEST(Brake, StopsTheAxisAndHoldsTheBalance) {
  auto spec = make_axis();
  spec.hinges[0].rate = {1};
  spec.functions = {make_step("law", 0.8, 0.5)};
  spec.actuators[0].type = "brake";
  spec.actuators[0].settings.numbers = {{"stick_rate", {1e-3}}};
  const RunResult r = run(spec);
  const VectorXd rate = r.sink.get("/sensors/rate");
  EXPECT_NEAR(rate[30], 1 - 0.4 * 1.0, 1e-6);  // at t = 1.5
  EXPECT_NEAR(rate[100], 0, 1e-3);
  EXPECT_LT(r.outcome.energy_error, 1e-8);
}

// ẏ = -relay(y): a triangle of period 4 h / v.
RunResult run_relay(double initial, std::map<std::string, std::vector<double>> settings) {
  auto spec = make_axis();
  records::ControllerRecord integral = make_law("sum", "state_space", {"switch"});
  integral.settings.numbers = {{"A", {0}}, {"B", {-1}}, {"C", {1}}, {"initial", {initial}}};
  records::ControllerRecord relay = make_law("switch", "relay", {"sum"}, std::move(settings));
  relay.settings.numbers["outputs"] = {1};
  spec.controllers = {integral, relay, make_law("law", "gain", {"switch"}, {{"gain", {1}}})};
  return run(spec);
}

TEST(Relay, GoesRoundItsHysteresis) {
  const RunResult r = run_relay(0.05, {{"on", {0.2}}, {"off", {-0.2}}, {"value", {0.5}}, {"low", {-0.5}}});
  const VectorXd t = r.sink.time(), y = r.sink.get("/controllers/sum");
  // From 0.05 up at 0.5, then a triangle between -0.2 and 0.2.
  for (int i = 0; i < t.size(); ++i) {
    const double way = std::fmod(0.5 * t[i] + 0.25, 0.8);  // from -0.2
    EXPECT_NEAR(y[i], way < 0.4 ? -0.2 + way : 0.6 - way, 1e-9) << t[i];
  }
  EXPECT_LT(r.outcome.energy_error, 1e-9);
}

// A negative off: from value to -value through rest at one moment.
TEST(Relay, IsATwoSidedTriggerWithANegativeOff) {
  const RunResult r = run_relay(0.25, {{"on", {0.2}}, {"off", {-0.2}}, {"value", {0.5}}});
  const VectorXd t = r.sink.time(), y = r.sink.get("/controllers/sum");
  // From 0.25 down at 0.5 until t = 0.9, then a triangle between -0.2 and 0.2.
  for (int i = 0; i < t.size(); ++i) {
    const double way = std::fmod(0.5 * t[i] + 0.35, 0.8);  // from -0.2
    EXPECT_NEAR(y[i], t[i] < 0.9 ? 0.25 - 0.5 * t[i] : way < 0.4 ? -0.2 + way : 0.6 - way, 1e-9) << t[i];
  }
  EXPECT_LT(r.outcome.energy_error, 1e-9);
}

// A constant input u to the modulator: x charges to K(u - y).
TEST(Pwpf, PulsesAsItsFilterCharges) {
  auto spec = make_axis();
  spec.functions = {make_step("u", 0.5, -1)};
  spec.controllers = {
      make_law("law", "pwpf", {"u"}, {{"value", {1}}, {"gain", {4}}, {"lag", {0.3}}, {"on", {0.9}}, {"off", {0.3}}})};
  spec.simulation.output_step = 0.01;
  const RunResult r = run(spec);
  // First pulse: off for τ ln(2 / (2 - 0.9)), on until -2 + 2.9 e^(-s/τ) = 0.3, off until 2 - 1.7 e^(-s/τ) = 0.9.
  const double first = 0.3 * std::log(2 / 1.1), on = 0.3 * std::log(2.9 / 2.3), off = 0.3 * std::log(1.7 / 1.1);
  const VectorXd t = r.sink.time(), y = r.sink.get("/controllers/law");
  for (int i = 0; i < t.size(); ++i) {
    const double phase = std::fmod(t[i] - first, on + off);
    if (std::abs(phase) < 1e-6 || std::abs(phase - on) < 1e-6) continue;
    EXPECT_EQ(y[i], t[i] > first && phase < on ? 1 : 0) << t[i];
  }
}

// On the tip of a flexible body the specific force is the second difference of its place, less gravity, in its axes.
TEST(Accelerometer, FeelsTheSpecificForceOfAFlexibleTip) {
  RandomTreeOptions options;
  options.num_bodies = 3;
  auto tree = make_random_tree(7, options);
  size_t flexible = 0;
  while (tree.spec.bodies[flexible].file.empty()) ++flexible;
  auto sensor = make_sensor("acc", SensorType::Accelerometer, tree.spec.bodies[flexible].name);
  sensor.node = 101;
  sensor.mount = calc_rotation_exp(Vector3d(0.2, -0.4, 0.9));
  auto place = make_sensor("place", SensorType::Position, sensor.body);
  place.node = 101;
  auto attitude = make_sensor("attitude", SensorType::DirectionCosines, sensor.body);
  attitude.node = 101;
  attitude.mount = sensor.mount;
  tree.spec.sensors = {sensor, place, attitude};
  auto& s = tree.spec.simulation;
  s.gravity = {0.3, -9.8, 1};
  s.duration = 0.04;
  s.output_step = 1e-3;
  s.integrator = "rk";
  s.relative_tolerance = 1e-12;
  s.absolute_tolerance = 1e-14;
  s.energy_error_limit = 1;
  const RunResult r = run(tree.spec, tree.flex);
  const MatrixXd p = r.sink.get("/sensors/place"), a = r.sink.get("/sensors/acc"), R = r.sink.get("/sensors/attitude");
  for (int i = 2; i + 2 < p.rows(); i += 7) {
    const Vector3d second =
        (-p.row(i - 2) + 16 * p.row(i - 1) - 30 * p.row(i) + 16 * p.row(i + 1) - p.row(i + 2)) / (12 * 1e-6);
    const Matrix3d R_WS = Eigen::Map<const Matrix3d>(VectorXd(R.row(i)).data()).transpose();
    const Vector3d expected = R_WS.transpose() * (second - s.gravity);
    EXPECT_LT((a.row(i).transpose() - expected).norm(), 2e-5 * (1 + expected.norm())) << i;
  }
}

TEST(Attitude, AnglesMakeTheirRotationAgain) {
  Random random(3);
  const Vector3d unit[] = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  for (const auto& axes : std::vector<std::array<int, 3>>{
           {2, 1, 0}, {0, 1, 2}, {1, 2, 0}, {2, 0, 2}, {0, 1, 0}, {1, 0, 2}, {1, 2, 1}, {2, 1, 2}}) {
    const Matrix3d R = random.rotation();
    const Vector3d angles = calc_euler_angles(R, axes);
    Matrix3d made = Matrix3d::Identity();
    for (size_t i = 0; i < 3; ++i)
      made = made * Eigen::AngleAxisd(angles[static_cast<int>(i)], unit[axes[i]]).toRotationMatrix();
    EXPECT_LT((made - R).norm(), 1e-12) << axes[0] << axes[1] << axes[2];
  }
}

TEST(Noise, IsNormalAndDependsOnItsIndexOnly) {
  double mean = 0, square = 0, product = 0, fourth = 0;
  const int n = 200000;
  for (int i = 0; i < n; ++i) {
    const double x = calc_normal(5, 77, static_cast<std::uint64_t>(i));
    mean += x / n;
    square += x * x / n;
    fourth += x * x * x * x / n;
    product += x * calc_normal(5, 78, static_cast<std::uint64_t>(i)) / n;
  }
  EXPECT_NEAR(mean, 0, 4 / std::sqrt(n));
  EXPECT_NEAR(square, 1, 4 * std::sqrt(2.0 / n));
  EXPECT_NEAR(fourth, 3, 4 * std::sqrt(96.0 / n));
  EXPECT_NEAR(product, 0, 4 / std::sqrt(n));
  EXPECT_NE(calc_normal(6, 77, 0), calc_normal(5, 77, 0));
}

records::SystemSpec make_noisy() {
  auto spec = make_axis();
  spec.simulation.integrator = "rk4";
  spec.simulation.step = spec.simulation.output_step = 0.01;
  spec.sensors[0].chain.numbers = {{"sample_time", {0.02}},  {"noise_density", {1e-3}}, {"random_walk", {2e-3}},
                                   {"quantization", {1e-5}}, {"delay", {0.03}},         {"bias", {0.01}}};
  spec.controllers = {make_law("law", "pid", {"angle"}, {{"kp", {8}}, {"kd", {1.6}}, {"sample_time", {0.04}}})};
  spec.controllers[0].rate = "rate";
  return spec;
}

TEST(Noise, AResumedRunDrawsWhatTheUnbrokenOneDraws) {
  auto spec = make_noisy();
  const RunResult whole = run(spec);
  spec.simulation.duration = 2.37;
  const RunResult first = run(spec);
  spec.simulation.duration = 5;
  SimulateOptions options;
  options.resume = first.sink.checkpoints().back();
  const RunResult second = run(spec, {}, options);
  const MatrixXd all = whole.sink.get("/sensors/angle"), rest = second.sink.get("/sensors/angle");
  ASSERT_GT(rest.rows(), 200);
  EXPECT_EQ(all.bottomRows(rest.rows()), rest);
  EXPECT_EQ(whole.sink.get("/sensors/rate").bottomRows(rest.rows()), second.sink.get("/sensors/rate"));
}

// A mission in parts, of which each starts its controllers and sensors again, at any multiple of the sample times:
// white noise of a sensor that nothing moves is that of one run, on its way through a delay too.
TEST(Noise, PartsOfAMissionDrawWhatOneRunDraws) {
  auto spec = make_axis();
  spec.actuators.clear();
  spec.controllers.clear();
  spec.simulation.integrator = "rk4";
  spec.simulation.step = spec.simulation.output_step = 0.05;
  spec.simulation.duration = 6;
  spec.sensors[0].chain.numbers = {{"sample_time", {0.1}}, {"noise_density", {1}}};
  spec.sensors[1].chain.numbers = {{"sample_time", {0.15}}, {"noise_density", {1}}, {"delay", {0.25}}};
  const MemorySink whole = run(spec).sink;
  const MatrixXd angle = whole.get("/sensors/angle"), rate = whole.get("/sensors/rate");
  ASSERT_EQ(angle.rows(), 121);
  for (const double from : {1.2, 3.0}) {
    spec.simulation.start = from;
    spec.simulation.duration = 6 - from;
    const MemorySink part = run(spec).sink;
    const MatrixXd own = part.get("/sensors/angle"), later = part.get("/sensors/rate");
    EXPECT_EQ(own, angle.bottomRows(own.rows())) << from;
    EXPECT_EQ(later(0, 0), 0);  // its first sample is on its way
    EXPECT_EQ(later.bottomRows(later.rows() - 5), rate.bottomRows(later.rows() - 5)) << from;
  }
  // Between two samples a part goes on with the number of the next one.
  spec.simulation.start = 1.23;
  spec.simulation.duration = 1;
  const MatrixXd shifted = run(spec).sink.get("/sensors/angle");
  EXPECT_EQ(shifted(0, 0), angle(26, 0));
  EXPECT_EQ(shifted(2, 0), angle(28, 0));
  // Before time zero too.
  spec.simulation.start = -0.3;
  const MatrixXd before = run(spec).sink.get("/sensors/angle");
  EXPECT_EQ(before(6, 0), angle(0, 0));
  EXPECT_NE(before(0, 0), angle(6, 0));
}

TEST(Sensor, ImperfectionsComeInTheirOrder) {
  auto spec = make_axis();
  spec.actuators.clear();
  spec.hinges[0].rate = {0.5};
  auto& angle = spec.sensors[0].chain.numbers;
  angle = {{"scale", {2}}, {"bias", {-0.3}}, {"range", {-0.2, 3}}, {"quantization", {0.25}}, {"sample_time", {0.2}}};
  spec.sensors[1].chain.numbers = {{"lag", {0.4}}};
  auto gyro = make_sensor("gyro", SensorType::IntegratingGyro, "rotor");
  gyro.chain.numbers = {{"misalignment", {EIGEN_PI / 2, 0, 0}}};
  spec.sensors.push_back(gyro);
  const RunResult r = run(spec);
  const VectorXd t = r.sink.time();
  const MatrixXd a = r.sink.get("/sensors/angle"), w = r.sink.get("/sensors/rate"), g = r.sink.get("/sensors/gyro");
  for (int i = 0; i < t.size(); ++i) {
    const double sampled = 0.2 * std::floor(t[i] / 0.2 + 1e-9);
    EXPECT_NEAR(a(i, 0), 0.25 * std::round(std::clamp(sampled - 0.3, -0.2, 3.0) / 0.25), 1e-12) << t[i];
    EXPECT_NEAR(w(i, 0), 0.5 * (1 - std::exp(-t[i] / 0.4)), 1e-9);
    EXPECT_NEAR(g(i, 1), 0.5 * t[i], 1e-9);  // z seen along the sensor's y
  }
}

}  // namespace
}  // namespace bough::solver::testing
