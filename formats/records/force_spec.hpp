#pragma once
/// \file [[force]] with a type, and what acts along hinge coordinates, as the user wrote them.
#include <limits>
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/records/flex_body.hpp"

namespace bough::records {

/// Where a force ends: a frame fixed in a node of a body, or in ground.
struct EndRecord {
  std::string body = "ground";
  int node = 0;
  Vector3d position = Vector3d::Zero();      ///< from the node, in the body's frame
  Matrix3d rotation = Matrix3d::Identity();  ///< axes, in the body's frame
};

enum class ElementType { Spring, Bushing, CentralGravity, Contact, Drag, SolarPressure };
enum class SpringSense { Both, Tension, Compression };  ///< in which it acts
enum class ContactShape { Plane, Sphere };              ///< of the `to` end

struct ForceElementRecord {
  std::string name;
  ElementType type = ElementType::Spring;
  EndRecord from, to;
  // Tension = preload + stiffness (l - free_length) + spring_table(l) + damping l̇ + damper_table(l̇) + function
  double stiffness = 0, damping = 0, free_length = 0, preload = 0;
  SpringSense sense = SpringSense::Both;
  std::string spring_table, damper_table, function;
  // Bushing: 6 x 6 over [x y z rx ry rz] in the axes of `from`
  Eigen::Matrix<double, 6, 6> stiffness6 = Eigen::Matrix<double, 6, 6>::Zero(), damping6 = stiffness6;
  // Contact, with stiffness and damping (per unit of approach speed) of Hunt and Crossley
  ContactShape shape = ContactShape::Plane;
  double radius = 0, to_radius = 0, exponent = 1.5, friction = 0, slip_velocity = 0;
  Vector3d normal =
      Vector3d::Zero();  ///< contact: of the plane, in the frame of to's body; drag: of the plate, or zero
  // Central gravity
  double mu = 0, j2 = 0, equator = 0;  ///< equator: radius that J2 goes with
  Vector3d centre = Vector3d::Zero(), axis = Vector3d::UnitZ();
  std::vector<std::string> bodies;     ///< empty: all
  Vector3d dipole = Vector3d::Zero();  ///< magnetic, inertial
  // Drag
  double area = 0, coefficient = 0, density = 0;
  Vector3d wind = Vector3d::Zero();  ///< velocity of the air, inertial
  std::string planet;                ///< drag, solar pressure: a central gravity with a radius; empty: none
  double scale_height = 0, altitude = 0;
  std::string density_table;         ///< in place of density: function of type table, density over altitude
  Vector3d spin = Vector3d::Zero();  ///< of the air with its planet, inertial
  bool has_faces = false;            ///< drag, solar pressure: on the faces of a flexible body's mesh, in place of area
  std::vector<int> faces;            ///< ids of the elements of these faces; empty: all of surfaces
  // Solar pressure
  double pressure = 0, specular = 0, diffuse = 0, sun_size = 0;
  Vector3d sun = Vector3d::Zero();  ///< direction to it, inertial
  bool is_one_sided = false;
  std::vector<std::string> shaded_by;  ///< bodies whose hulls cast a shadow
  SourceLocation at;
};

/// Force laws along the coordinates of a hinge in addition to linear springs and dampers; one entry per coordinate, or
/// empty.
struct HingeLawRecord {
  std::vector<double> preload;                          ///< generalized force in the direction of the coordinate
  std::vector<std::string> spring_table, damper_table;  ///< functions that resist deflection and rate; "": none
  std::vector<double> stop_lower, stop_upper, stop_stiffness, stop_damping;
  std::vector<double> stop_restitution;  ///< of rigid stops, which have no stiffness; empty: springs
  std::vector<double> coulomb, static_friction, stribeck_velocity, smoothing;
  /// Friction by bearing load: coefficients, and the lengths that turn reactions into it; 0: without effect.
  std::vector<double> mu, mu_static, pin_radius, friction_arm, bending_arm, reaction_arm;
  std::vector<double> rotor_inertia, gear_ratio;
  bool has_stops = false, has_friction = false;
};

}  // namespace bough::records
