// calc_derivative against a second route without recursion, for random systems with everything that the route covers.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "solver/system/derivative.hpp"
#include "tests/solver/support/dense_route.hpp"
#include "tests/solver/support/models.hpp"

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

/// A law with two states of an angle, its rate and an input, to a motor on the last hinge with plain coordinates.
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

ConstraintRecord make_constraint(Random& random, int i, int kind, int num_bodies) {
  static const HingeType hinges[] = {HingeType::Fixed,       HingeType::Revolute, HingeType::Prismatic,
                                     HingeType::Universal,   HingeType::Planar,   HingeType::Spherical,
                                     HingeType::Cylindrical, HingeType::Screw,    HingeType::General};
  ConstraintRecord c;
  c.name = "c" + std::to_string(i);
  c.type = kind == 0   ? ConstraintType::Distance
           : kind == 1 ? ConstraintType::PointOnLine
           : kind == 2 ? ConstraintType::PointOnPlane
                       : ConstraintType::Hinge;
  c.hinge = hinges[random.integer(0, 8)];
  c.rotations = random.integer(0, 1) ? "xz" : "q";
  c.translations = random.integer(0, 1) ? "y" : "xz";
  c.pitch = 0.3;
  c.length = 1.5;
  const int child = random.integer(1, num_bodies - 1);
  c.child = "b" + std::to_string(child);
  c.parent = random.integer(0, 3) == 0 ? "ground" : "b" + std::to_string(random.integer(0, child - 1));
  if (c.parent != "ground") c.parent_node = random.integer(0, 1) * 101;
  c.child_node = random.integer(0, 1) * 102;
  c.parent_position = random.vector(0.5);
  c.child_position = random.vector(0.5);
  c.parent_rotation = random.rotation();
  c.child_rotation = random.rotation();
  c.axis = random.vector();
  c.axis2 = random.vector();
  c.active = false;
  return c;
}

void add_constraints(Random& random, records::SystemSpec& spec, bool is_driven) {
  // Driven coordinates may contradict other constraints: one distance can always be kept.
  if (is_driven) {
    spec.constraints.push_back(make_constraint(random, 0, 0, static_cast<int>(spec.bodies.size())));
    return;
  }
  for (int i = 0; i < 2; ++i)
    spec.constraints.push_back(make_constraint(random, i, random.integer(0, 5), static_cast<int>(spec.bodies.size())));
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

/// Largest difference of the derivatives, relative to the norm of each part of x. `more`: an element of add_element(),
/// 5: one coordinate is locked.
double compare(unsigned seed, unsigned more = 6) {
  Random random(seed + 7000);
  RandomTreeOptions options;
  options.num_bodies = 4;
  options.prescribed = seed % 3 == 0;
  RandomTree tree = make_random_tree(seed, options);
  change_hinges(random, tree.spec);
  add_elements(random, tree.spec, seed % 8 == 0);
  add_control(random, tree.spec);
  if (more < 5) add_element(random, tree.spec, more);
  if (more > 5 && seed % 4 != 1) add_constraints(random, tree.spec, options.prescribed);
  const System system = build(tree.spec, tree.flex);
  const auto data = system.make_data();
  VectorXd q, u;
  make_random_state(system, seed + 1000, q, u);
  calc_kinematics(system, *data, kTime, q, u);
  DiscreteState discrete = get_discrete(*data);
  for (int c = 0; c < system.num_constraints(); ++c)
    discrete.constraints[static_cast<size_t>(c)] = find_as_closed(system.loops, system.tree, data->tree, c);
  if (more == 5) lock_one(random, system, discrete, u);
  set_modes(system, *data, discrete);
  project(system, *data, kTime, q, u);

  const StateLayout layout = system.layout();
  VectorXd x = VectorXd::Zero(layout.size()), x_dot = x;
  get_q(layout, x) = q;
  get_u(layout, x) = u;
  for (int i = 0; i < system.num_z(); ++i) get_z(layout, x)[i] = random();
  calc_derivative(system, *data, kTime, x, x_dot);
  const VectorXd other = calc_dense_derivative(tree.spec, tree.flex, system, discrete, kTime, x);

  double worst = 0;
  const auto add = [&](const char* part, const VectorXd& a, const VectorXd& b) {
    const double error = (a - b).norm() / (1 + b.norm());
    if (!(error < 1e-11)) ADD_FAILURE() << "seed " << seed << ", more " << more << ", " << part << ": " << error;
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
  for (unsigned seed = 1; seed <= 200; ++seed) worst = std::max(worst, compare(seed));
  RecordProperty("worst", std::to_string(worst * 1e15) + "e-15");
}

TEST(DenseRoute, HoldsBushingsContactsDragAndLocks) {
  int num_skipped = 0;
  for (unsigned more = 0; more <= 5; ++more)
    for (unsigned seed = 1; seed <= 20; ++seed) {
      try {
        compare(seed, more);
      } catch (const ComputationError& error) {
        ASSERT_TRUE(is_past_half_turn(error)) << error.what();
        ++num_skipped;
      }
    }
  EXPECT_LT(num_skipped, 8);  // of 20 bushings at random angles one in eleven is turned by more than 172 degrees
}

}  // namespace
}  // namespace bough::solver::testing
