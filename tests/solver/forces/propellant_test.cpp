// Propellant that leaves rigid bodies: shapes against sums over points, motions against closed forms, momentum books.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/bodies/tank.hpp"
#include "solver/system/derivative.hpp"
#include "tests/solver/support/runs.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;
using records::TankType;
constexpr double kPi = std::numbers::pi;

/// Sums over a lattice of points of the solid inside(x, y, z) in axes along the tank's, z its axis.
template <class F>
TankContent sum_points(const TankAxis& place, double size, double density, F&& inside) {
  constexpr int n = 120;
  const double step = 2 * size / n;
  Matrix3d R;
  R.col(2) = place.axis;
  R.col(0) = place.axis.unitOrthogonal();
  R.col(1) = R.col(2).cross(R.col(0));
  // Sums of 1, s and s sᵀ over the points inside, in the axes of the tank.
  double count = 0, first[3] = {}, second[3][3] = {};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        const double v[] = {step * (i + 0.5) - size, step * (j + 0.5) - size, step * (k + 0.5) - size};
        if (!inside(v[0], v[1], v[2])) continue;
        ++count;
        for (int a = 0; a < 3; ++a) {
          first[a] += v[a];
          for (int b = 0; b <= a; ++b) second[a][b] += v[a] * v[b];
        }
      }
  const double m = density * step * step * step;
  const Vector3d sum_s = m * R * Vector3d(first[0], first[1], first[2]);
  Matrix3d sum_ss;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) sum_ss(a, b) = m * second[std::max(a, b)][std::min(a, b)];
  TankContent sum;
  sum.mass = m * count;
  sum.S = sum.mass * place.position + sum_s;
  const Matrix3d cross = place.position * sum_s.transpose();
  const Matrix3d rr =
      sum.mass * place.position * place.position.transpose() + cross + cross.transpose() + R * sum_ss * R.transpose();
  sum.J = rr.trace() * Matrix3d::Identity() - rr;
  return sum;
}

void expect_near(const TankContent& a, const TankContent& sum, double error) {
  EXPECT_NEAR(a.mass, sum.mass, error * a.mass);
  EXPECT_LT((a.S / a.mass - sum.S / sum.mass).norm(), error);
  EXPECT_LT((a.J / a.mass - sum.J / sum.mass).norm(), error);
}

void expect_derivatives(const TankShape& shape, double mass) {
  const double h = 1e-5 * mass;
  const TankContent c = shape.calc(mass), up = shape.calc(mass + h), down = shape.calc(mass - h);
  EXPECT_LT((c.S_m - (up.S - down.S) / (2 * h)).norm(), 1e-8);
  EXPECT_LT((c.J_m - (up.J - down.J) / (2 * h)).norm(), 1e-8);
}

TEST(Tanks, AreTheSumOfTheirPoints) {
  const TankAxis place{{0.3, -0.2, 0.5}, Vector3d(1, 2, -0.5).normalized()};
  const double density = 2;
  const auto cylinder = make_cylinder_tank(place, 0.8, 1, density);
  const double half = 0.5 * cylinder->capacity();
  EXPECT_NEAR(cylinder->capacity(), density * kPi * 0.64, 1e-12);
  expect_near(cylinder->calc(half),
              sum_points(place, 1, density,
                         [](double x, double y, double z) { return std::hypot(x, y) < 0.8 && z > 0 && z < 0.5; }),
              8e-3);
  const auto sphere = make_sphere_tank(place, 0.9, density);
  // Filled to a height above the centre between two layers of points.
  const double top = 14.0 / 60, u = top / 0.9, mass = sphere->capacity() * (2 + 3 * u - u * u * u) / 4;
  expect_near(
      sphere->calc(mass),
      sum_points(place, 1, density, [&](double x, double y, double z) { return std::hypot(x, y, z) < 0.9 && z < top; }),
      8e-3);
  const auto grain = make_grain(place, 0.9, 0.3, 1, density);
  EXPECT_NEAR(grain->capacity(), density * kPi * 0.72, 1e-12);
  expect_near(grain->calc(density * kPi * 0.45),
              sum_points(place, 1, density,
                         [](double x, double y, double z) {
                           return std::hypot(x, y) < 0.9 && std::hypot(x, y) > 0.6 && z > 0;
                         }),
              8e-3);
  for (const auto* shape : {cylinder.get(), sphere.get(), grain.get()})
    for (const double share : {0.05, 0.4, 0.9}) expect_derivatives(*shape, share * shape->capacity());
  for (const auto* shape : {cylinder.get(), sphere.get(), grain.get()}) {
    EXPECT_TRUE(shape->calc(0).S.allFinite());
    EXPECT_LT(shape->calc(0).J.norm(), 1e-12);
  }
}

TEST(Tanks, ATableOfTheWholeBodyGivesTheWholeBody) {
  TankTable table{{2, 3, 5}, {{0, 0, 1}, {0.1, 0, 1.2}, {0.1, 0.2, 1.3}}, {}};
  for (const double i : {1.0, 1.5, 3.0}) table.inertia.push_back(i * Vector3d(1, 1.2, 0.9).asDiagonal());
  TankContent dry;
  dry.mass = 2;
  dry.S = 2 * table.cg[0];
  dry.J = table.inertia[0] + 2 * (Matrix3d::Identity() - Vector3d::UnitZ() * Vector3d::UnitZ().transpose());
  const auto shape = make_tank_table(table, dry);
  EXPECT_DOUBLE_EQ(shape->capacity(), 3);
  EXPECT_LT(shape->calc(0).S.norm() + shape->calc(0).J.norm(), 1e-14);
  const TankContent c = shape->calc(2);  // of 4: half way between the last rows
  const Vector3d cg = 0.5 * (table.cg[1] + table.cg[2]);
  EXPECT_LT((c.S + dry.S - 4 * cg).norm(), 1e-14);
  const Matrix3d J =
      0.5 * (table.inertia[1] + table.inertia[2]) + 4 * (cg.squaredNorm() * Matrix3d::Identity() - cg * cg.transpose());
  EXPECT_LT((c.J + dry.J - J).norm(), 1e-13);
  expect_derivatives(*shape, 2);
}

records::FunctionRecord make_step(const std::string& name, double value, double at) {
  records::FunctionRecord f;
  f.name = name;
  f.type = "step";
  f.values = {{"value", value}, {"at", at}};
  return f;
}

/// A free rocket along x with a full tank, an engine at its tail and nothing else.
records::SystemSpec make_rocket() {
  auto spec = make_one_body(HingeType::Free);
  auto& h = spec.hinges[0];
  for (auto* v : {&h.parent_position, &h.child_position}) v->setZero();
  for (auto* R : {&h.parent_rotation, &h.child_rotation}) R->setIdentity();
  spec.bodies[0].nodes = {{1, {-1.5, 0, 0}}};
  records::TankRecord tank;
  tank.name = "tank";
  tank.body = "body";
  tank.at = {"system.toml", 7, 1};
  tank.axis = {1, 0, 0};
  tank.radius = 0.5;
  tank.height = 2;
  tank.density = 8;
  tank.mass = 10;
  spec.tanks = {tank};
  spec.functions = {make_step("throttle", 40, -1)};
  records::ActuatorRecord engine;
  engine.name = "engine";
  engine.type = "engine";
  engine.body = "body";
  engine.node = 1;
  engine.input = "throttle";
  engine.at = {"system.toml", 50, 1};
  engine.settings.numbers = {{"axis", {1, 0, 0}}, {"exhaust_velocity", {5}}};
  engine.settings.words = {{"tank", {"tank"}}};
  spec.actuators = {engine};
  spec.simulation.integrator = "rk";
  spec.simulation.relative_tolerance = 1e-12;
  spec.simulation.absolute_tolerance = 1e-13;
  return spec;
}

TEST(Propellant, GivesTsiolkovskysSpeed) {
  auto spec = make_rocket();
  spec.simulation.gravity = {-1.5, 0, 0};
  const MemorySink sink = run_kept(spec);
  const VectorXd t = sink.time(), v = sink.get("/bodies/body/velocity").col(0), m = sink.get("/system_mass/mass");
  for (int i = 0; i < t.size(); ++i) {
    EXPECT_NEAR(m[i], 12 - 8 * t[i], 1e-11);
    EXPECT_NEAR(v[i], 5 * std::log(12 / (12 - 8 * t[i])) - 1.5 * t[i], 1e-9);
    EXPECT_NEAR(sink.get("/tanks/tank/flow")(i, 0), 8, 1e-12);
  }
}

// m k² α = ṁ (k² - l²) ω with a constant radius of gyration k about a centre of mass that stays: ω = ω0 (m/m0)^(l²/k² -
// 1) (Meriam & Kraige; Thomson, Introduction to Space Dynamics, 8.5). About the axis of a nozzle of radius R: ω = ω0
// (m/m0)^(R²/(2 k²) - 1).
TEST(Propellant, DampsTurningAsTheClosedFormSays) {
  for (const bool is_axial : {false, true}) {
    auto spec = make_rocket();
    const double k2 = 0.8;
    spec.bodies[0].inertia = spec.bodies[0].mass * k2 * Matrix3d::Identity();
    auto& tank = spec.tanks[0];
    tank.type = TankType::Table;
    tank.masses = {0, 10};
    tank.cg = {Vector3d::Zero(), Vector3d::Zero()};
    tank.inertia = {Matrix3d::Zero(), 10 * k2 * Matrix3d::Identity()};
    spec.actuators[0].settings.numbers["exit_radius"] = {0.6};
    spec.hinges[0].rate = {is_axial ? 0.3 : 0, is_axial ? 0 : 0.3, 0, 0, 0, 0};
    const MemorySink sink = run_kept(spec);
    const VectorXd t = sink.time(), w = sink.get("/bodies/body/angular_velocity").col(is_axial ? 0 : 1);
    // Across, the disc adds R²/4 to l².
    const double power = (is_axial ? 0.5 * 0.36 : 1.5 * 1.5 + 0.25 * 0.36) / k2 - 1;
    for (int i = 0; i < t.size(); ++i) EXPECT_NEAR(w[i], 0.3 * std::pow(1 - 8 * t[i] / 12, power), 1e-10);
  }
}

/// Two bodies that tumble, with tanks on both, jets and engines aside of the centre of mass.
records::SystemSpec make_tumbler() {
  auto spec = make_rocket();
  spec.bodies[0].cg = {0.1, 0.2, -0.1};
  spec.bodies.push_back(spec.bodies[0]);
  spec.bodies[1].name = "stage";
  spec.hinges.push_back(make_hinge_record("joint", HingeType::Universal, "body", "stage"));
  spec.hinges[1].rate = {0.5, -0.4};
  spec.hinges[1].stiffness = {3, 4};
  spec.hinges[0].rate = {0.3, -0.5, 0.8, 1, 0.2, -0.4};
  auto sphere = spec.tanks[0];
  sphere.name = "sphere";
  sphere.type = TankType::Sphere;
  sphere.position = {0.3, 0.4, -0.2};
  sphere.axis = {0, 1, 1};
  sphere.radius = 0.7;
  sphere.density = 3;
  sphere.mass = 4;
  auto grain = spec.tanks[0];
  grain.name = "grain";
  grain.body = "stage";
  grain.type = TankType::Grain;
  grain.position = {-0.2, 0, 0.3};
  grain.axis = {0, 0, 1};
  grain.radius = 0.6;
  grain.height = 1;
  grain.density = 5;
  grain.mass = 3;
  spec.tanks.push_back(sphere);
  spec.tanks.push_back(grain);
  auto second = spec.actuators[0], third = second;
  second.name = "second";
  second.node = 0;
  second.settings.words["tank"] = {"sphere"};
  second.settings.numbers = {{"axis", {0.2, 1, 0.3}}, {"exhaust_velocity", {12}}, {"exit_radius", {0.3}}};
  second.settings.numbers["lag"] = {0.1};
  third.name = "third";
  third.type = "jet";
  third.body = "stage";
  third.settings.words["tank"] = {"grain"};
  third.settings.numbers = {{"axis", {0, -1, 0.4}}, {"exhaust_velocity", {9}}, {"thrust", {15}}};
  spec.actuators.push_back(second);
  spec.actuators.push_back(third);
  return spec;
}

TEST(Propellant, KeepsTheMomentaOfWhatStaysAndWhatLeft) {
  const MemorySink sink = run_kept(make_tumbler());
  const MatrixXd linear = sink.get("/momentum/linear") + sink.get("/momentum/out_linear");
  const MatrixXd angular = sink.get("/momentum/angular") + sink.get("/momentum/out_angular");
  EXPECT_GT((sink.get("/momentum/linear").rowwise() - sink.get("/momentum/linear").row(0)).norm(), 10);
  EXPECT_LT((linear.rowwise() - linear.row(0)).cwiseAbs().maxCoeff(), 1e-10 * linear.row(0).norm());
  EXPECT_LT((angular.rowwise() - angular.row(0)).cwiseAbs().maxCoeff(), 1e-10 * angular.row(0).norm());
}

// In a central field and a uniform one: the power of the mass that leaves is that of both potentials.
TEST(Propellant, KeepsTheBookOfEnergyInGravity) {
  auto spec = make_tumbler();
  spec.simulation.gravity = {0.3, -2, 1};
  records::ForceElementRecord field;
  field.name = "planet";
  field.type = records::ElementType::CentralGravity;
  field.mu = 40;
  field.j2 = 0.3;
  field.equator = 1;
  field.centre = {5, -3, 2};
  spec.force_elements = {field};
  run_kept(spec, 1e-10);
}

// The recursion against the dense matrix, with the mass of now.
TEST(Propellant, IsInTheDenseEquationsToo) {
  const auto spec = make_tumbler();
  const System system = build(spec);
  auto data = system.make_data();
  State state = system.make_initial_state();
  auto z = get_z(system.layout(), state.x);
  z.setConstant(0.7);
  VectorXd u_dot(system.num_u()), dense(system.num_u());
  calc_motion(system, *data, 0.3, get_q(system.layout(), state.x), get_u(system.layout(), state.x), z, u_dot, [] {});
  calc_accelerations_dense(system, *data, 0.3, dense);
  EXPECT_LT((u_dot - dense).norm(), 1e-11 * dense.norm());
  EXPECT_NEAR(calc_system_mass(system, *data).mass, 4 + 17 - 3 * 0.7, 1e-12);
}

TEST(Propellant, RunsOutAndTheEngineStops) {
  auto spec = make_rocket();
  spec.tanks[0].mass = 4;  // half a second
  const RunResult r = run(spec);
  EXPECT_TRUE(r.outcome.completed);
  EXPECT_NEAR(get_last(r.sink, "/tanks/tank/mass"), 0, 1e-9);
  EXPECT_EQ(get_last(r.sink, "/actuators/engine"), 0);
  EXPECT_NEAR(get_last(r.sink, "/bodies/body/velocity"), 5 * std::log(6.0 / 2), 1e-8);
  EXPECT_FALSE(r.diagnostics.has("run.propellant"));
  ASSERT_EQ(r.sink.events().size(), 1);
  EXPECT_NEAR(r.sink.events()[0].time, 0.5, 1e-9);
  EXPECT_EQ(r.sink.events()[0].what, "tank 'tank' is empty: actuator 'engine' is cut off");
  EXPECT_EQ(r.sink.events()[0].source, "actuator 'engine'");
}

// The mass as a function of time and the thrust as a force give what an engine gives.
TEST(Propellant, MayBeAFunctionOfTime) {
  auto spec = make_rocket();
  spec.hinges[0].rate = {0.1, 0.3, -0.2, 0, 0, 0};
  const MemorySink engine = run_kept(spec);
  spec.actuators.clear();
  spec.tanks[0].mass = 0;
  spec.tanks[0].function = "left";
  spec.tanks[0].exit_node = 1;
  records::FunctionRecord left;
  left.name = "left";
  left.type = "table";
  left.x = {0, 1, 2};
  left.y = {10, 2, 2};
  spec.functions.push_back(left);
  records::ForceRecord thrust;
  thrust.name = "thrust";
  thrust.body = "body";
  thrust.node = 1;
  thrust.direction = {40, 0, 0};
  spec.forces = {thrust};
  const MemorySink function = run_kept(spec);
  for (const char* path : {"/bodies/body/velocity", "/bodies/body/angular_velocity", "/momentum/angular"})
    EXPECT_LT((engine.get(path) - function.get(path)).topRows(10).cwiseAbs().maxCoeff(), 1e-9) << path;
}

TEST(Propellant, NamesWhatCannotBe) {
  const auto get_error = [](const records::SystemSpec& spec) {
    Diagnostics diagnostics;
    draft_system(spec, {}, diagnostics);
    return diagnostics.num_errors() == 1 ? diagnostics.items().back().id + ": " + diagnostics.items().back().what : "";
  };
  auto spec = make_rocket();
  spec.tanks[0].mass = 100;
  EXPECT_THAT(get_error(spec), ::testing::HasSubstr("system.bad-tank: tank 'tank' has a mass of 100"));
  spec = make_rocket();
  spec.tanks[0].mass = -1;
  EXPECT_THAT(get_error(spec), ::testing::HasSubstr("mass below zero"));
  spec = make_rocket();
  spec.actuators[0].settings.numbers.erase("exhaust_velocity");
  EXPECT_THAT(get_error(spec), ::testing::HasSubstr("no exhaust_velocity"));
  spec = make_rocket();
  spec.actuators[0].settings.words["tank"] = {"tonk"};
  EXPECT_THAT(get_error(spec), ::testing::HasSubstr("does not exist"));
  // A function that falls below zero ends the run where it does.
  spec = make_rocket();
  spec.actuators.clear();
  spec.tanks[0].mass = 0;
  spec.tanks[0].function = "left";
  records::FunctionRecord left;
  left.name = "left";
  left.type = "table";
  left.x = {0, 1};
  left.y = {4, -4};
  spec.functions = {left};
  try {
    run(spec);
    FAIL();
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.items().front().id, "run.tank-empty");
  }
}

}  // namespace
}  // namespace bough::solver::testing
