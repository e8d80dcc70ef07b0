#pragma once
/// \file Records of small systems, one call for each.
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/solver/support/models.hpp"

namespace bough::solver::testing {

/// A rigid body with principal moments of inertia about its centre of mass along the axes of B.
inline records::BodyRecord make_body_record(const std::string& name, double mass, const Vector3d& inertia,
                                            const Vector3d& cg = Vector3d::Zero()) {
  records::BodyRecord body;
  body.name = name;
  body.mass = mass;
  body.cg = cg;
  body.inertia = inertia.asDiagonal();
  return body;
}

/// A uniform rod along x from its origin to node 1.
inline records::BodyRecord make_rod_record(const std::string& name, double length = 1, double mass = 1,
                                           double about_axis = 1e-3) {
  const double across = mass * length * length / 12;
  auto rod = make_body_record(name, mass, {about_axis * mass, across, across}, {length / 2, 0, 0});
  rod.nodes = {{1, {length, 0, 0}}};
  return rod;
}

inline records::SensorRecord make_sensor(const std::string& name, records::SensorType type, const std::string& body,
                                         const std::string& hinge = "") {
  return {.name = name, .type = type, .body = body, .hinge = hinge, .at = {"system.toml", 30, 1}};
}

inline records::FunctionRecord make_function(const std::string& name, const std::string& type,
                                             const std::map<std::string, double>& values) {
  records::FunctionRecord f;
  f.name = name;
  f.type = type;
  f.values = values;
  return f;
}

/// A force on a body, or a moment if `kind` says so, times a function or a signal.
inline records::ForceRecord make_force(const std::string& name, const std::string& body, const Vector3d& direction,
                                       const std::string& function = "",
                                       records::ForceKind kind = records::ForceKind::Force) {
  return {.name = name, .kind = kind, .body = body, .direction = direction, .function = function};
}

/// A spring from the origin of a body to a place on ground.
inline records::ForceElementRecord make_spring(const std::string& name, const std::string& body, const Vector3d& to,
                                               double stiffness, double free_length) {
  records::ForceElementRecord spring;
  spring.name = name;
  spring.type = records::ElementType::Spring;
  spring.from.body = body;
  spring.to.position = to;
  spring.stiffness = stiffness;
  spring.free_length = free_length;
  return spring;
}

/// A contact of the origin of a body with ground.
inline records::ForceElementRecord make_contact(const std::string& name, records::ContactShape shape,
                                                const std::string& body, double stiffness) {
  records::ForceElementRecord contact;
  contact.name = name;
  contact.type = records::ElementType::Contact;
  contact.shape = shape;
  contact.from.body = body;
  contact.stiffness = stiffness;
  return contact;
}

/// A constraint of the distance of a body's origin from that of ground.
inline records::ConstraintRecord make_distance(const std::string& name, const std::string& child, double length) {
  records::ConstraintRecord rod;
  rod.name = name;
  rod.type = records::ConstraintType::Distance;
  rod.child = child;
  rod.length = length;
  return rod;
}

/// An event that does something to `target`.
inline records::UserEventRecord make_event(const std::string& name, records::EventAction action,
                                           const std::string& target) {
  return {.name = name, .action = action, .target = target, .at = {"system.toml", 30, 1}};
}

/// An event where a signal passes a value.
inline records::UserEventRecord make_trigger(const std::string& name, const std::string& signal, double value,
                                             records::EventDirection direction = records::EventDirection::Both) {
  return {.name = name, .signal = signal, .value = value, .direction = direction, .at = {"system.toml", 30, 1}};
}

/// Adds a copy of the first body of a system and of its hinge, under other names.
inline void add_copy(records::SystemSpec& spec, const std::string& body, const std::string& hinge) {
  spec.bodies.push_back(spec.bodies[0]);
  spec.bodies.back().name = body;
  spec.hinges.push_back(spec.hinges[0]);
  spec.hinges.back().name = hinge;
  spec.hinges.back().child = body;
}

/// A constraint of a random type, inactive, between two bodies of a random tree. \param kind  0 distance, 1 point on
/// line, 2 point on plane, others a hinge.
inline records::ConstraintRecord make_random_constraint(Random& random, int i, int kind, int num_bodies) {
  using records::ConstraintType;
  using records::HingeType;
  static const HingeType hinges[] = {HingeType::Fixed,       HingeType::Revolute, HingeType::Prismatic,
                                     HingeType::Universal,   HingeType::Planar,   HingeType::Spherical,
                                     HingeType::Cylindrical, HingeType::Screw,    HingeType::General};
  records::ConstraintRecord c;
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

}  // namespace bough::solver::testing
