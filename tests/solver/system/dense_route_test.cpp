// calc_derivative against a second route without recursion, for random systems with everything that the route covers.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <tuple>

#include "solver/system/derivative.hpp"
#include "tests/solver/support/dense_route.hpp"
#include "tests/solver/support/records.hpp"

namespace bough::solver::testing {
namespace {

using records::ConstraintRecord;
using records::ConstraintType;
using records::HingeType;

constexpr double kTime = 0.3;

/// Other types with as many coordinates: screws, and hinges of several axes.
void change_hinges(Random& random, records::SystemSpec& spec) {
  for (auto& h : spec.hinges) {
    if (random.integer(0, 2) > 0) continue;
    if (h.type == HingeType::Revolute) {
      h.type = HingeType::Screw;
      h.pitch = 0.3;
    } else if (h.type == HingeType::Universal || h.type == HingeType::Planar) {
      h.rotations = h.type == HingeType::Universal ? "z" : "zx";
      h.translations = "y";
      h.type = HingeType::General;
    }
  }
}

records::EndRecord make_end(Random& random, const std::string& body, bool is_node) {
  records::EndRecord end;
  end.body = body;
  end.node = is_node ? 101 : 0;
  end.position = random.vector(0.5);
  return end;
}

void add_elements(Random& random, records::SystemSpec& spec, bool has_planet) {
  const int n = static_cast<int>(spec.bodies.size());
  for (int i = 0; i < 2; ++i) {
    records::ForceElementRecord spring;
    spring.name = "spring" + std::to_string(i);
    const int a = random.integer(1, n - 1);
    spring.from = random.integer(0, 3) ? make_end(random, "b" + std::to_string(random.integer(0, a - 1)), true)
                                       : make_end(random, "ground", false);
    spring.to = make_end(random, "b" + std::to_string(a), random.integer(0, 1) == 1);
    spring.stiffness = 3;
    spring.damping = 0.4;
    spring.free_length = 0.7;
    spring.preload = 0.2;
    if (i == 1) spring.function = "wave";
    spec.force_elements.push_back(spring);
  }
  if (!has_planet) return;
  records::ForceElementRecord field;
  field.name = "planet";
  field.type = records::ElementType::CentralGravity;
  field.mu = 400;
  field.centre = {30, -5, 8};
  spec.force_elements.push_back(field);
}

Eigen::Matrix<double, 6, 6> make_positive(Random& random) {
  const MatrixXd A = MatrixXd::NullaryExpr(6, 6, [&] { return random(); });
  return A * A.transpose();
}

/// A bushing, a contact or a plate in the wind between bodies.
void add_element(Random& random, records::SystemSpec& spec, unsigned kind) {
  const int n = static_cast<int>(spec.bodies.size()), child = random.integer(1, n - 1);
  records::ForceElementRecord element;
  element.name = "element";
  const bool is_grounded = random.integer(0, 3) == 0;
  element.from = make_end(random, "b" + std::to_string(child), true);
  element.to = is_grounded ? make_end(random, "ground", false)
                           : make_end(random, "b" + std::to_string(random.integer(0, child - 1)), true);
  if (kind == 0) {
    element.type = records::ElementType::Bushing;
    element.from.rotation = random.rotation();
    element.to.rotation = random.rotation();
    element.stiffness6 = make_positive(random);
    element.damping6 = 0.3 * make_positive(random);
  } else if (kind < 3) {
    element.type = records::ElementType::Contact;
    element.shape = kind == 1 ? records::ContactShape::Plane : records::ContactShape::Sphere;
    element.radius = 1.5;
    element.to_radius = kind == 1 ? 0 : 1;
    element.normal = random.vector();
    element.stiffness = 2;
    element.damping = 0.3;
    element.friction = 0.4;
    element.slip_velocity = 0.2;
  } else {
    element.type = records::ElementType::Drag;
    element.density = 1.2;
    element.coefficient = 1.1;
    element.area = 0.5;
    element.wind = random.vector(2);
    if (kind == 4) element.normal = random.vector();
  }
  spec.force_elements.push_back(element);
}

/// Locks one coordinate that is free and has no motion; its rate becomes zero.
void lock_one(Random& random, const System& system, DiscreteState& discrete, VectorXd& u) {
  std::vector<size_t> rows;
  for (int b = 0; b < system.tree.size(); ++b)
    for (int i = 0; i < system.tree[b].num_hinge_u(); ++i) {
      const auto row = static_cast<size_t>(system.tree[b].u_offset + i);
      if (discrete.mode[row] == HingeMode::Free) rows.push_back(row);
    }
  if (rows.size() < 2) return;
  const size_t row = rows[static_cast<size_t>(random.integer(0, static_cast<int>(rows.size()) - 1))];
  discrete.mode[row] = HingeMode::Locked;
  u[static_cast<Eigen::Index>(row)] = 0;
}

/// A controller with two states of an angle, its rate and an input, to a motor on the last hinge of plain coordinates.
void add_control(Random& random, records::SystemSpec& spec) {
  std::vector<std::string> plain;
  for (const auto& h : spec.hinges)
    if (h.motion.empty() && h.type != HingeType::Fixed && h.type != HingeType::Spherical && h.type != HingeType::Free)
      plain.push_back(h.name);
  const auto single = std::find_if(spec.hinges.begin(), spec.hinges.end(), [](const auto& h) {
    return h.motion.empty() &&
           (h.type == HingeType::Revolute || h.type == HingeType::Prismatic || h.type == HingeType::Screw);
  });
  if (single == spec.hinges.end()) return;
  for (const auto type : {records::SensorType::HingeAngle, records::SensorType::HingeRate}) {
    records::SensorRecord sensor;
    sensor.name = type == records::SensorType::HingeAngle ? "angle" : "rate";
    sensor.type = type;
    sensor.hinge = single->name;
    spec.sensors.push_back(sensor);
  }
  records::InputRecord input;
  input.name = "command";
  input.start = 0.6;
  spec.inputs.push_back(input);
  records::ControllerRecord law;
  law.name = "law";
  law.type = "state_space";
  law.inputs = {"angle", "rate", "command"};
  for (const auto& [key, rows, columns] : {std::tuple("A", 2, 2), {"B", 2, 3}, {"C", 1, 2}, {"D", 1, 3}})
    law.settings.matrices[key] = MatrixXd::NullaryExpr(rows, columns, [&] { return random(); });
  spec.controllers.push_back(law);
  for (const auto* name : {"law", "command"}) {
    records::ActuatorRecord motor;
    motor.name = std::string("motor of ") + name;
    motor.type = "hinge";
    motor.hinge = plain.back();
    motor.input = name;
    spec.actuators.push_back(motor);
  }
}

records::FunctionRecord make_table(const std::string& name, double from, double to, int count, Random& random) {
  records::FunctionRecord table;
  table.name = name;
  table.type = "table";
  table.interpolation = count > 4 ? "cubic" : "linear";
  for (int i = 0; i < count; ++i) {
    table.x.push_back(from + (to - from) * (i + (i > 0 && i + 1 < count ? random(0.3) : 0)) / (count - 1));
    table.y.push_back(random(2));
  }
  return table;
}

bool is_plain(const records::HingeRecord& h) {
  return h.type != HingeType::Fixed && h.type != HingeType::Spherical && h.type != HingeType::Free;
}

/// Tables, preloads, friction (dry and smooth), springs as stops and motors along every hinge of single coordinates.
void add_laws(Random& random, records::SystemSpec& spec) {
  spec.functions.push_back(make_table("bends", -0.8, 0.9, 4, random));
  spec.functions.push_back(make_table("curve", -0.9, 0.7, 6, random));
  spec.functions.push_back(make_table("reach", 0.2, 3, 7, random));
  for (auto& h : spec.hinges) {
    if (!is_plain(h)) continue;
    const size_t n = h.motion.empty() ? h.stiffness.size() : h.motion.size();
    auto& law = h.law;
    for (size_t i = 0; i < n; ++i) {
      law.rotor_inertia.push_back(0.2 + std::abs(random(0.2)));
      law.gear_ratio.push_back(1 + random());
      if (!h.motion.empty()) continue;
      h.null_position.push_back(random(0.3));
      law.preload.push_back(random());
      law.spring_table.emplace_back(i % 2 == 0 ? "bends" : "");
      law.damper_table.emplace_back("curve");
      law.stop_lower.push_back(-0.6);
      law.stop_upper.push_back(0.5);
      law.stop_stiffness.push_back(4);
      law.stop_damping.push_back(0.8);
      law.coulomb.push_back(0.3);
      law.static_friction.push_back(0.5);
      law.stribeck_velocity.push_back(0.4);
      law.smoothing.push_back(random.integer(0, 1) ? 0.2 : 0);
    }
    law.has_stops = law.has_friction = h.motion.empty();
  }
  for (auto& element : spec.force_elements) {
    if (element.type != records::ElementType::Spring) continue;
    element.damper_table = "curve";
    if (random.integer(0, 1))
      element.spring_table = "reach";
    else
      element.sense = random.integer(0, 1) ? records::SpringSense::Tension : records::SpringSense::Compression;
  }
}

records::ActuatorRecord make_actuator(const std::string& type, const std::string& body, const std::string& input) {
  records::ActuatorRecord r;
  r.name = type + " of " + body;
  r.type = type;
  r.body = body;
  r.input = input;
  return r;
}

void set_axis(records::ActuatorRecord& r, const char* key, const Vector3d& axis) {
  r.settings.numbers[key] = {axis.x(), axis.y(), axis.z()};
}

/// A wheel with friction and a gyro, on nodes of two bodies.
void add_rotors(Random& random, records::SystemSpec& spec, const std::string& signal) {
  const int n = static_cast<int>(spec.bodies.size());
  auto wheel = make_actuator("wheel", spec.bodies[static_cast<size_t>(random.integer(0, n - 1))].name, signal);
  wheel.node = 101;
  set_axis(wheel, "axis", random.vector());
  wheel.settings.numbers["inertia"] = {0.7};
  wheel.settings.numbers["viscous"] = {0.3};
  wheel.settings.numbers["coulomb"] = {0.2};
  wheel.settings.numbers["stick_rate"] = {0.5};
  wheel.settings.numbers["lag"] = {0.4};
  wheel.settings.numbers["rate_limit"] = {1.5};
  spec.actuators.push_back(wheel);
  const bool is_double = random.integer(0, 1) == 1;
  records::ControllerRecord rates;
  rates.name = "rates";
  rates.type = "state_space";
  rates.inputs = {"command", signal};
  for (const auto& [key, rows, columns] : {std::tuple("A", 1, 1), {"B", 1, 2}, {"C", 2, 1}, {"D", 2, 2}})
    rates.settings.matrices[key] = MatrixXd::NullaryExpr(rows, columns, [&] { return random(); });
  if (is_double) spec.controllers.push_back(rates);
  auto gyro =
      make_actuator(is_double ? "double_gimbal_cmg" : "cmg",
                    spec.bodies[static_cast<size_t>(random.integer(0, n - 1))].name, is_double ? "rates" : "command");
  gyro.node = 102;
  const Matrix3d axes = random.rotation();
  set_axis(gyro, "gimbal_axis", axes.col(0));
  if (is_double) set_axis(gyro, "inner_axis", axes.col(1));
  set_axis(gyro, "spin_axis", axes.col(2));
  gyro.settings.numbers["momentum"] = {1.3};
  gyro.settings.numbers["scale"] = {1.5};
  gyro.settings.numbers["bias"] = {-0.2};
  gyro.settings.numbers["deadband"] = {0.1};
  spec.actuators.push_back(gyro);
}

void shape_tank(Random& random, const records::BodyRecord& body, records::TankRecord& tank) {
  tank.type = static_cast<records::TankType>(random.integer(0, 3));
  tank.position = random.vector(0.4);
  tank.axis = random.vector();
  tank.density = 3;
  tank.radius = 0.8;
  tank.height = tank.type == records::TankType::Cylinder ? 1.3 : 2.2;
  tank.bore = 0.1;
  if (tank.type == records::TankType::Table) {
    tank.is_of_body = random.integer(0, 1) == 1;
    for (const double mass : {0.0, 0.9, 5.1, 8.0}) {  // no kink where the others differentiate
      const bool is_empty = mass == 0 && tank.is_of_body;
      tank.masses.push_back(mass + (tank.is_of_body ? body.mass : 0));
      tank.cg.push_back(is_empty ? body.cg : Vector3d(body.cg + random.vector(0.1)));
      tank.inertia.push_back(is_empty ? body.inertia : Matrix3d(body.inertia + mass * Matrix3d::Identity()));
    }
  } else if (random.integer(0, 1) == 1) {
    tank.slosh_mass = 0.2;
    tank.slosh_position = random.vector(0.3);
  }
}

/// Engines on the tank of one rigid body, a tank of another whose mass is a function of time.
void add_tanks(Random& random, records::SystemSpec& spec, const std::string& signal) {
  bool is_first = true;
  for (const auto& body : spec.bodies) {
    if (!body.file.empty()) continue;
    records::TankRecord tank;
    tank.name = "tank of " + body.name;
    tank.body = body.name;
    tank.mass = 3;
    shape_tank(random, body, tank);
    if (!is_first) {
      tank.function = "burn";
      tank.exit_node = 102;
      tank.exit_radius = 0.2;
      tank.exit_axis = random.vector();
    }
    spec.tanks.push_back(tank);
    if (!is_first) break;
    is_first = false;
    for (const int node : {101, 103}) {
      auto engine = make_actuator("engine", body.name, node == 101 ? signal : "command");
      engine.name += std::to_string(node);
      engine.node = node;
      set_axis(engine, "axis", random.vector());
      engine.settings.numbers["exhaust_velocity"] = {2.5};
      engine.settings.numbers["exit_radius"] = {0.3};
      engine.settings.numbers["bias"] = {3};
      engine.settings.words["tank"] = {tank.name};
      spec.actuators.push_back(engine);
    }
  }
  records::FunctionRecord burn;
  burn.name = "burn";
  burn.type = "sine";
  burn.values = {{"amplitude", 0.8}, {"omega", 3.1}, {"phase", 1.4}, {"offset", 3}};
  spec.functions.push_back(burn);
}

/// A sampled controller with a state and a delay, of sensors that are sampled and late too. Returns its name, that
/// of an input where no hinge can be measured.
std::string add_samples(Random& random, records::SystemSpec& spec) {
  if (spec.sensors.empty()) return "command";
  auto sensor = spec.sensors.front();
  sensor.name = "late angle";
  sensor.chain.numbers["sample_time"] = {0.07};
  sensor.chain.numbers["delay"] = {0.031};
  spec.sensors.push_back(sensor);
  records::ControllerRecord digital;
  digital.name = "digital";
  digital.type = "state_space";
  digital.inputs = {"late angle", "rate", "command", "law"};
  digital.settings.numbers["sample_time"] = {0.05};
  digital.settings.numbers["delay"] = {0.082};
  for (const auto& [key, rows, columns] : {std::tuple("A", 2, 2), {"B", 2, 4}, {"C", 1, 2}, {"D", 1, 4}})
    digital.settings.matrices[key] = MatrixXd::NullaryExpr(rows, columns, [&] { return random(); });
  spec.controllers.push_back(digital);
  return "digital";
}

void add_constraints(Random& random, records::SystemSpec& spec, bool is_driven) {
  // Driven coordinates may contradict other constraints: one distance can always be kept.
  if (is_driven) {
    spec.constraints.push_back(make_random_constraint(random, 0, 0, static_cast<int>(spec.bodies.size())));
    return;
  }
  for (int i = 0; i < 2; ++i)
    spec.constraints.push_back(
        make_random_constraint(random, i, random.integer(0, 5), static_cast<int>(spec.bodies.size())));
  ConstraintRecord gear;
  gear.name = "gear";
  gear.type = ConstraintType::Coupler;
  gear.active = false;
  for (const auto& h : spec.hinges)
    if (h.type == HingeType::Revolute || h.type == HingeType::Prismatic || h.type == HingeType::Planar)
      gear.terms.push_back({h.name, 1, 1 + random()});
  if (gear.terms.size() > 1) spec.constraints.push_back(gear);
}

/// Returns true if a bushing is turned by more than the element accepts.
bool is_past_half_turn(const ComputationError& error) {
  return error.items().front().id == "solver.bushing-past-half-turn";
}

/// A random state on the closed constraints, for the modes of `data`.
VectorXd make_state(const System& system, SystemData& data, double t, unsigned seed, const DiscreteState& discrete) {
  Random random(seed);
  VectorXd q, u;
  make_random_state(system, seed, q, u);
  for (int row = 0; row < system.num_u(); ++row)
    if (discrete.mode[static_cast<size_t>(row)] == HingeMode::Locked) u[row] = 0;
  project(system, data, t, q, u);
  const StateLayout layout = system.layout();
  VectorXd x = VectorXd::Zero(layout.size());
  get_q(layout, x) = q;
  get_u(layout, x) = u;
  for (int i = 0; i < system.num_z(); ++i) get_z(layout, x)[i] = random();
  return x;
}

/// Dry friction slides the way of the rate.
VectorXd find_slides(const System& system, const VectorXd& x, const DiscreteState& discrete) {
  VectorXd slide = VectorXd::Zero(system.num_u());
  for (const auto& contact : system.joint_contacts) {
    const double rate = get_u(system.layout(), x)[contact.u_row];
    if (discrete.mode[static_cast<size_t>(contact.u_row)] == HingeMode::Free) slide[contact.u_row] = rate > 0 ? 1 : -1;
  }
  return slide;
}

/// Takes all samples before kTime, each at a separate state.
History take_samples(const System& system, SystemData& data, unsigned seed, const DiscreteState& discrete) {
  History history;
  for (const auto& sample : system.signals.collect_samples())
    for (double t = sample.first; t < kTime; t += sample.period) history[t];
  VectorXd x_dot(system.layout().size());
  for (auto& [t, x] : history) {
    x = make_state(system, data, t, seed++, discrete);
    calc_derivative(system, data, t, x, x_dot);
    calc_signals(system, data);
    system.signals.sample(get_motion(system, data), data.signals, 1e-9);
  }
  return history;
}

enum class Parts {
  Constraints,
  Element,  ///< of add_element(), without constraints
  Lock,
  All
};

records::SystemSpec make_spec(unsigned seed, Parts parts, unsigned kind, RandomTree& tree) {
  Random random(seed + 7000);
  const bool is_driven = seed % 3 == 0;
  change_hinges(random, tree.spec);
  add_elements(random, tree.spec, seed % 8 == 0 || (parts == Parts::All && seed % 3 == 1));
  add_control(random, tree.spec);
  if (parts == Parts::Element) add_element(random, tree.spec, kind);
  if (parts == Parts::All) {
    add_element(random, tree.spec, 1 + seed % 4);
    add_laws(random, tree.spec);
    const std::string signal = add_samples(random, tree.spec);
    if (signal != "command") {
      add_rotors(random, tree.spec, signal);
      add_tanks(random, tree.spec, signal);
    }
    for (auto& element : tree.spec.force_elements) {
      if (element.type != records::ElementType::CentralGravity) continue;
      element.j2 = 0.1;
      element.equator = 20;
      element.axis = random.vector();
    }
  }
  if (seed % 4 != 1 && (parts == Parts::Constraints || parts == Parts::All))
    add_constraints(random, tree.spec, is_driven);
  return tree.spec;
}

/// Largest difference of the derivatives, relative to the norm of each part of x.
double compare(unsigned seed, Parts parts, unsigned kind = 0) {
  RandomTreeOptions options;
  options.num_bodies = 4;
  options.prescribed = seed % 3 == 0;
  RandomTree tree = make_random_tree(seed, options);
  const records::SystemSpec spec = make_spec(seed, parts, kind, tree);
  const System system = build(spec, tree.flex);
  const auto data = system.make_data();
  VectorXd q, u;
  make_random_state(system, seed + 1000, q, u);
  calc_kinematics(system, *data, kTime, q, u);
  DiscreteState discrete = get_discrete(*data);
  for (int c = 0; c < system.num_constraints(); ++c)
    discrete.constraints[static_cast<size_t>(c)] = find_as_closed(system.loops, system.tree, data->tree, c);
  Random random(seed + 8000);
  if (parts == Parts::Lock || (parts == Parts::All && seed % 5 == 0)) lock_one(random, system, discrete, u);
  set_modes(system, *data, discrete);
  const History history = take_samples(system, *data, 100 * seed, discrete);
  const VectorXd x = make_state(system, *data, kTime, seed + 1000, discrete);
  discrete.memory = data->signals.memory;
  discrete.slide = find_slides(system, x, discrete);
  set_modes(system, *data, discrete);

  const StateLayout layout = system.layout();
  VectorXd x_dot = VectorXd::Zero(layout.size());
  calc_derivative(system, *data, kTime, x, x_dot);
  const DenseDerivative dense = calc_dense_derivative(spec, tree.flex, system, discrete, kTime, x, history);
  const VectorXd& other = dense.x_dot;
  // Constraints that nearly depend on each other multiply the rounding of both routes.
  const double tolerance = 1e-11 + std::numeric_limits<double>::epsilon() * dense.condition;

  double worst = 0;
  const auto add = [&](const char* part, const VectorXd& a, const VectorXd& b) {
    const double error = (a - b).norm() / (1 + b.norm());
    if (!(error < tolerance))
      ADD_FAILURE() << "seed " << seed << ", parts " << static_cast<int>(parts) << " (" << kind << "), " << part << ": "
                    << error;
    worst = std::max(worst, error);
  };
  add("q", get_q(layout, x_dot), get_q(layout, other));
  add("u", get_u(layout, x_dot), get_u(layout, other));
  add("z", get_z(layout, x_dot), get_z(layout, other));
  add("work", x_dot.tail(2).head(1), other.tail(2).head(1));
  add("dissipated", x_dot.tail(1), other.tail(1));
  return worst;
}

TEST(DenseRoute, IsTheDerivativeOfRandomSystems) {
  double worst = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) worst = std::max(worst, compare(seed, Parts::Constraints));
  RecordProperty("worst", std::to_string(worst * 1e15) + "e-15");
}

TEST(DenseRoute, HoldsBushingsContactsDragAndLocks) {
  int num_skipped = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    compare(seed, Parts::Lock);
    for (unsigned kind = 0; kind < 5; ++kind) {
      try {
        compare(seed, Parts::Element, kind);
      } catch (const ComputationError& error) {
        ASSERT_TRUE(is_past_half_turn(error)) << error.what();
        ++num_skipped;
      }
    }
  }
  EXPECT_LT(num_skipped, 8);  // of 20 bushings at random angles one in eleven is turned by more than 172 degrees
}

TEST(DenseRoute, HoldsEverythingAtOnce) {
  double worst = 0;
  for (unsigned seed = 1; seed <= 120; ++seed) worst = std::max(worst, compare(seed, Parts::All));
  RecordProperty("worst", std::to_string(worst * 1e15) + "e-15");
}

}  // namespace
}  // namespace bough::solver::testing
