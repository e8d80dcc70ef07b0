// Sensors against the analytic motion of a rigid body that spins and flies, in every frame, and against finite
// differences.
#include "solver/builder/build_system.hpp"
#include "solver/builder/sensors.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/solver/support/records.hpp"

namespace bough::solver::testing {
namespace {

/// Measurements of all sensors, one after the other.
VectorXd measure_all(const std::vector<Sensor>& sensors, const Motion& motion) {
  std::vector<double> all;
  for (const Sensor& sensor : sensors) {
    all.resize(all.size() + static_cast<size_t>(sensor.size));
    measure(motion, sensor, all.data() + all.size() - sensor.size);
  }
  return Eigen::Map<const VectorXd>(all.data(), std::ssize(all));
}

using records::HingeType;
using records::SensorType;

records::SensorRecord make_node_sensor(const std::string& name, SensorType type, const std::string& body, int node,
                                       const std::string& frame, const std::string& relative_to = "") {
  auto s = make_sensor(name, type, body);
  s.node = node;
  s.frame = frame;
  s.relative_to = relative_to;
  s.at.line = 3;
  return s;
}

records::SensorRecord make_hinge_sensor(SensorType type, const std::string& hinge, int coordinate) {
  auto s = make_sensor("h", type, "", hinge);
  s.coordinate = coordinate;
  return s;
}

/// A table turns about z by α(t), prescribed; on it an arm, 2 m from the axis, turns by β(t). Node 5 of the arm is 1 m
/// out.
struct Carousel {
  static constexpr double kWa = 0.7, kA = 1.3, kWb = 2.1, kB = 0.8;
  records::SystemSpec spec;

  Carousel() {
    for (const std::string name : {"table", "arm"}) {
      records::BodyRecord b;
      b.name = name;
      b.mass = 1;
      b.inertia.setIdentity();
      spec.bodies.push_back(b);
    }
    spec.bodies[1].nodes = {{5, {1, 0, 0}}};
    spec.hinges = {make_hinge_record("ha", HingeType::Revolute, "ground", "table"),
                   make_hinge_record("hb", HingeType::Revolute, "table", "arm")};
    spec.hinges[1].parent_position = {2, 0, 0};
    for (const auto& [name, amplitude, omega] : {std::tuple{"alpha", kA, kWa}, std::tuple{"beta", kB, kWb}}) {
      records::FunctionRecord f;
      f.name = name;
      f.type = "sine";
      f.values = {{"amplitude", amplitude}, {"omega", omega}};
      spec.functions.push_back(f);
    }
    spec.hinges[0].motion = {"alpha"};
    spec.hinges[1].motion = {"beta"};
  }

  /// Every component of every sensor of `sensors` at t.
  VectorXd calc(double t, const std::vector<records::SensorRecord>& sensors) {
    spec.sensors = sensors;
    const System system = build(spec);
    auto data = system.make_data();
    VectorXd q(system.num_q()), u(system.num_u()), u_dot(system.num_u());
    system.calc_initial_state(q, u);
    calc_kinematics(system, *data, t, q, u);
    add_forces(system, *data, t);
    calc_accelerations(system, *data, t, u_dot);
    Diagnostics diagnostics;
    const auto made = build_sensors(system, spec, diagnostics);
    EXPECT_EQ(diagnostics.num_errors(), 0);
    return measure_all(made, get_motion(system, *data));
  }
};

// Angles and rates of the two hinges, in closed form.
struct Angles {
  double a, ad, add, b, bd, bdd;
  explicit Angles(double t)
      : a(Carousel::kA * std::sin(Carousel::kWa * t)),
        ad(Carousel::kA * Carousel::kWa * std::cos(Carousel::kWa * t)),
        add(-Carousel::kWa * Carousel::kWa * a),
        b(Carousel::kB * std::sin(Carousel::kWb * t)),
        bd(Carousel::kB * Carousel::kWb * std::cos(Carousel::kWb * t)),
        bdd(-Carousel::kWb * Carousel::kWb * b) {}
};

Vector3d radial(double angle) { return {std::cos(angle), std::sin(angle), 0}; }
Vector3d tangent(double angle) { return {-std::sin(angle), std::cos(angle), 0}; }

TEST(Sensors, InertialMotionOfANode) {
  const double t = 0.9;
  const Angles x(t);
  const double c = x.a + x.b, cd = x.ad + x.bd, cdd = x.add + x.bdd;
  const VectorXd out =
      Carousel().calc(t, {make_node_sensor("p", SensorType::Position, "arm", 5, "inertial"),
                          make_node_sensor("v", SensorType::Velocity, "arm", 5, "inertial"),
                          make_node_sensor("a", SensorType::Acceleration, "arm", 5, "inertial"),
                          make_node_sensor("w", SensorType::AngularVelocity, "arm", 5, "inertial"),
                          make_node_sensor("d", SensorType::AngularAcceleration, "arm", 5, "inertial")});
  EXPECT_LT((out.segment<3>(0) - (2 * radial(x.a) + radial(c))).norm(), 1e-14);
  EXPECT_LT((out.segment<3>(3) - (2 * x.ad * tangent(x.a) + cd * tangent(c))).norm(), 1e-14);
  const Vector3d a = 2 * (x.add * tangent(x.a) - x.ad * x.ad * radial(x.a)) + cdd * tangent(c) - cd * cd * radial(c);
  EXPECT_LT((out.segment<3>(6) - a).norm(), 1e-13);
  EXPECT_LT((out.segment<3>(9) - Vector3d(0, 0, cd)).norm(), 1e-14);
  EXPECT_LT((out.segment<3>(12) - Vector3d(0, 0, cdd)).norm(), 1e-13);
}

TEST(Sensors, SeenFromTheTable) {
  const double t = 1.7;
  const Angles x(t);
  std::vector<records::SensorRecord> sensors;
  for (SensorType type : {SensorType::Position, SensorType::Velocity, SensorType::Acceleration,
                          SensorType::AngularVelocity, SensorType::AngularAcceleration})
    sensors.push_back(make_node_sensor("s", type, "arm", 5, "table", "table"));
  const VectorXd out = Carousel().calc(t, sensors);
  // An observer on the table sees the arm turn about (2, 0, 0) by β alone.
  EXPECT_LT((out.segment<3>(0) - (Vector3d(2, 0, 0) + radial(x.b))).norm(), 1e-14);
  EXPECT_LT((out.segment<3>(3) - x.bd * tangent(x.b)).norm(), 1e-14);
  EXPECT_LT((out.segment<3>(6) - (x.bdd * tangent(x.b) - x.bd * x.bd * radial(x.b))).norm(), 1e-13);
  EXPECT_LT((out.segment<3>(9) - Vector3d(0, 0, x.bd)).norm(), 1e-14);
  EXPECT_LT((out.segment<3>(12) - Vector3d(0, 0, x.bdd)).norm(), 1e-13);
}

TEST(Sensors, FramesOnlyTurnTheComponents) {
  const double t = 0.4;
  const Angles x(t);
  const VectorXd out = Carousel().calc(t, {make_node_sensor("w", SensorType::Velocity, "arm", 5, "inertial"),
                                           make_node_sensor("b", SensorType::Velocity, "arm", 5, "body"),
                                           make_node_sensor("n", SensorType::Velocity, "arm", 5, "table"),
                                           make_node_sensor("r", SensorType::Velocity, "arm", 5, "inertial", "table")});
  const auto turn = [](double angle) -> Matrix3d {
    return Eigen::AngleAxisd(-angle, Vector3d::UnitZ()).toRotationMatrix();
  };
  EXPECT_LT((out.segment<3>(3) - turn(x.a + x.b) * out.segment<3>(0)).norm(), 1e-14);
  EXPECT_LT((out.segment<3>(6) - turn(x.a) * out.segment<3>(0)).norm(), 1e-14);
  EXPECT_LT((out.segment<3>(9) - x.bd * tangent(x.a + x.b)).norm(), 1e-14);
}

TEST(Sensors, HingeCoordinates) {
  const double t = 0.4;
  const Angles x(t);
  const VectorXd out = Carousel().calc(
      t, {make_hinge_sensor(SensorType::HingeAngle, "hb", 1), make_hinge_sensor(SensorType::HingeRate, "ha", 0)});
  ASSERT_EQ(out.size(), 2);
  EXPECT_NEAR(out[0], x.b, 1e-15);
  EXPECT_NEAR(out[1], x.ad, 1e-15);
}

VectorXd measure_at_start(const records::SystemSpec& spec, const System& system) {
  auto data = system.make_data();
  VectorXd q(system.num_q()), u(system.num_u()), u_dot(system.num_u());
  system.calc_initial_state(q, u);
  calc_kinematics(system, *data, 0, q, u);
  add_forces(system, *data, 0);
  calc_accelerations(system, *data, 0, u_dot);
  Diagnostics diagnostics;
  const auto sensors = build_sensors(system, spec, diagnostics);
  return measure_all(sensors, get_motion(system, *data));
}

// A resolver brings angles into a turn and leaves lengths as they are, whatever the hinge.
TEST(Sensors, AResolverDoesNotWrapLengths) {
  records::SystemSpec spec;
  records::BodyRecord b;
  b.name = "b";
  b.mass = 1;
  b.inertia.setIdentity();
  spec.bodies = {b};
  const auto run = [&](HingeType type, const std::vector<double>& position) {
    spec.hinges = {make_hinge_record("h", type, "ground", "b")};
    spec.hinges[0].position = position;
    spec.sensors = {make_hinge_sensor(SensorType::Resolver, "h", 0)};
    return measure_at_start(spec, build(spec));
  };
  const double wrapped = 4 - 2 * EIGEN_PI;
  const VectorXd cylindrical = run(HingeType::Cylindrical, {4, 10});
  EXPECT_NEAR(cylindrical[0], wrapped, 1e-15);
  EXPECT_EQ(cylindrical[1], 10);
  EXPECT_EQ(run(HingeType::Prismatic, {-20})[0], -20);
  const VectorXd planar = run(HingeType::Planar, {5, -7, 4});
  EXPECT_EQ(planar[0], 5);
  EXPECT_EQ(planar[1], -7);
  EXPECT_NEAR(planar[2], wrapped, 1e-15);
  EXPECT_EQ(run(HingeType::Free, {1, 0, 0, 0, 8, 9, 10}).tail<3>(), Vector3d(8, 9, 10));
}

// a - g(p) with g of all sources at the place of the instrument: nothing at the mass centre of a body in free fall.
TEST(Sensors, AnAccelerometerInFreeFallReadsTheTideAlone) {
  records::SystemSpec spec;
  records::BodyRecord b;
  b.name = "sat";
  b.mass = 100;
  b.inertia = 10 * Matrix3d::Identity();
  b.nodes = {{1, {1, 0.5, -2}}};
  spec.bodies = {b, b};
  spec.bodies[1].name = "free";  // which the centre does not attract
  const double distance = 1000, mu = 1e5, spin = 0.02;
  for (const std::string name : {"sat", "free"}) {
    spec.hinges.push_back(make_hinge_record("orbit_" + name, HingeType::Free, "ground", name));
    spec.hinges.back().position = {1, 0, 0, 0, distance, 20, 30};
    spec.hinges.back().rate = {0, 0, spin, 0, 10, 0};
    for (const int node : {0, 1})
      spec.sensors.push_back(make_node_sensor(name + std::to_string(node), SensorType::Accelerometer, name, node, ""));
  }
  spec.simulation.gravity = {0.1, 0.2, -9.81};
  records::ForceElementRecord earth;
  earth.name = "earth";
  earth.type = records::ElementType::CentralGravity;
  earth.mu = mu;
  earth.bodies = {"sat"};
  spec.force_elements = {earth};
  const VectorXd out = measure_at_start(spec, build(spec));
  const Vector3d R(distance, 20, 30), r(1, 0.5, -2), w(0, 0, spin);
  const auto calc_field = [&](const Vector3d& p) -> Vector3d { return -mu / std::pow(p.norm(), 3) * p; };
  EXPECT_LT(out.head<3>().norm(), 1e-14);
  EXPECT_LT((out.segment<3>(3) - (w.cross(w.cross(r)) + calc_field(R) - calc_field(R + r))).norm(), 1e-13);
  EXPECT_LT(out.segment<3>(6).norm(), 1e-14);
  EXPECT_LT((out.tail<3>() - w.cross(w.cross(r))).norm(), 1e-14);
}

// On flexible bodies in random trees: velocity and acceleration are the rates of position and velocity, in a moving
// frame.
TEST(Sensors, RatesOnFlexibleTrees) {
  RandomTreeOptions options;
  options.num_bodies = 6;
  options.prescribed = false;
  RandomTree tree = make_random_tree(11, options);
  const std::string a = tree.spec.bodies[1].name;
  std::string flexible;
  for (const auto& b : tree.spec.bodies)
    if (!b.file.empty()) flexible = b.name;
  ASSERT_FALSE(flexible.empty());
  tree.spec.sensors = {make_node_sensor("p", SensorType::Position, flexible, 103, a, a),
                       make_node_sensor("v", SensorType::Velocity, flexible, 103, a, a),
                       make_node_sensor("a", SensorType::Acceleration, flexible, 103, a, a),
                       make_node_sensor("d", SensorType::Deflection, flexible, 103, ""),
                       make_node_sensor("dw", SensorType::Deflection, flexible, 103, "inertial")};
  const System system = build(tree.spec, tree.flex);
  Diagnostics diagnostics;
  const auto sensors = build_sensors(system, tree.spec, diagnostics);
  ASSERT_EQ(diagnostics.num_errors(), 0);
  auto data = system.make_data();
  VectorXd q, u;
  make_random_state(system, 4, q, u);
  const VectorXd u_dot = calc_u_dot(system, *data, 0, q, u);
  const auto sense = [&](double dt) {
    const VectorXd qt = advance_q(system, *data, 0, dt, q, u, u_dot), ut = u + dt * u_dot;
    calc_u_dot(system, *data, 0, qt, ut);
    const VectorXd out = measure_all(sensors, get_motion(system, *data));
    return out;
  };
  const double h = 1e-4;
  const VectorXd plus = sense(h), minus = sense(-h), now = sense(0);
  const VectorXd rate = (plus - minus) / (2 * h);
  const double scale = 1 + now.norm() + rate.norm();
  EXPECT_LT((now.segment<3>(3) - rate.segment<3>(0)).norm(), 1e-5 * scale);
  EXPECT_LT((now.segment<3>(6) - rate.segment<3>(3)).norm(), 1e-5 * scale);
  EXPECT_NEAR(now.segment<3>(9).norm(), now.segment<3>(12).norm(), 1e-12);
  const Matrix3d R_WB = get_body_state(*data, system.find_body(flexible)).R_WB;
  EXPECT_LT((now.segment<3>(12) - R_WB * now.segment<3>(9)).norm(), 1e-12);
}

// Sensor minus the motion of the table's origin only: the difference of two inertial vectors.
TEST(Sensors, FixedObserverKeepsHisAxes) {
  const double t = 1.7;
  const Angles x(t);
  const double c = x.a + x.b, cd = x.ad + x.bd, cdd = x.add + x.bdd;
  std::vector<records::SensorRecord> sensors;
  for (SensorType type : {SensorType::Position, SensorType::Velocity, SensorType::Acceleration,
                          SensorType::AngularVelocity, SensorType::AngularAcceleration}) {
    sensors.push_back(make_node_sensor("s", type, "arm", 5, "inertial", "table"));
    sensors.back().from_turning = false;
  }
  const VectorXd out = Carousel().calc(t, sensors);
  // The table's origin rests: what is left is the inertial motion, the angular ones less the table's.
  EXPECT_LT((out.segment<3>(0) - (2 * radial(x.a) + radial(c))).norm(), 1e-14);
  EXPECT_LT((out.segment<3>(3) - (2 * x.ad * tangent(x.a) + cd * tangent(c))).norm(), 1e-14);
  const Vector3d a = 2 * (x.add * tangent(x.a) - x.ad * x.ad * radial(x.a)) + cdd * tangent(c) - cd * cd * radial(c);
  EXPECT_LT((out.segment<3>(6) - a).norm(), 1e-13);
  EXPECT_LT((out.segment<3>(9) - Vector3d(0, 0, x.bd)).norm(), 1e-14);
  EXPECT_LT((out.segment<3>(12) - Vector3d(0, 0, x.bdd)).norm(), 1e-13);
}

// Errors that follow from those of bodies are not reported for the sensors on them.
TEST(Sensors, BodiesThatFailedAreNotTheSensorsFault) {
  Carousel carousel;
  carousel.spec.bodies[1].inertia(0, 0) = -1;
  Diagnostics of_build, diagnostics;
  const System system = draft_system(carousel.spec, {}, of_build);
  EXPECT_EQ(of_build.num_errors(), 1);
  EXPECT_FALSE(system.is_valid(1));
  carousel.spec.sensors = {make_node_sensor("s1", SensorType::Position, "arm", 9, "inertial"),
                           make_node_sensor("s2", SensorType::Position, "table", 7, "arm")};
  build_sensors(system, carousel.spec, diagnostics);
  ASSERT_EQ(diagnostics.num_errors(), 1);
  EXPECT_THAT(format(diagnostics.items()[0]), ::testing::HasSubstr("sensor 's2' is on node 7"));
}

TEST(Sensors, FaultsAreReported) {
  Carousel carousel;
  const System system = build(carousel.spec);
  carousel.spec.sensors = {make_node_sensor("s1", SensorType::Position, "arn", 0, "inertial"),
                           make_node_sensor("s2", SensorType::Position, "arm", 9, "inertial"),
                           make_node_sensor("s3", SensorType::Position, "arm", 5, "tabel"),
                           make_node_sensor("s4", SensorType::Position, "arm", 5, "body", "nobody"),
                           make_hinge_sensor(SensorType::HingeAngle, "hc", 0),
                           make_hinge_sensor(SensorType::HingeRate, "hb", 2)};
  Diagnostics diagnostics;
  build_sensors(system, carousel.spec, diagnostics);
  ASSERT_EQ(diagnostics.num_errors(), 6);
  const auto& items = diagnostics.items();
  EXPECT_EQ(items[0].id, "sensor.unknown-body");
  EXPECT_THAT(format(items[0]), ::testing::HasSubstr("did you mean 'arm'?"));
  EXPECT_EQ(items[0].where.line, 3);
  EXPECT_EQ(items[1].id, "sensor.unknown-node");
  EXPECT_EQ(items[2].id, "sensor.bad-frame");
  EXPECT_EQ(items[3].id, "sensor.unknown-body");
  EXPECT_EQ(items[4].id, "sensor.unknown-hinge");
  EXPECT_EQ(items[5].id, "sensor.bad-coordinate");
  EXPECT_THAT(format(items[5]), ::testing::HasSubstr("which has 1"));
}

}  // namespace
}  // namespace bough::solver::testing
