#pragma once
/// \file The types of sensors: word of the system file, keys, components, dimensions. A new type is one enumerator, one
/// row and, if no group measures it yet, its value in solver/sensors/measure.cpp.
#include <string_view>

namespace bough::records {

enum class SensorType {
  Position,
  Velocity,
  Acceleration,
  Deflection,
  Rotation,
  AngularVelocity,
  AngularAcceleration,
  HingeAngle,
  HingeRate,
  Quaternion,
  Euler,
  DirectionCosines,
  Gyro,
  IntegratingGyro,
  Accelerometer,
  Resolver,
  Tachometer,
  Direction,
  Horizon,
  Magnetometer,
  HingeForce,
  HingeMoment,
  StrainEnergy,
  ModalCoordinate,
  ModalRate,
  Distance,
  Element,
  LineOfSight
};

/// Groups of types with the same keys.
enum class SensorOf {
  Point,       ///< body, node, frame, relative_to
  Elastic,     ///< body, node, frame
  Attitude,    ///< body, node, mount, relative_to
  Instrument,  ///< body, node, mount
  Coordinate,  ///< hinge, coordinate
  HingeLoad,   ///< hinge
  Modes,       ///< body, coordinate
  Energy,      ///< body
  Gap,         ///< body, node, to_body, to_node
  Element,     ///< body, element, component
  Optics       ///< terms, relative_to
};

struct SensorKind {
  SensorType type;
  const char* word;  ///< `type` in the system file
  const char* name;  ///< in descriptions of channels
  const char* dims;
  SensorOf of;
  int size;  ///< 0: as many as the hinge or the body has
  bool reads_acceleration;
  bool is_angle;  ///< dimensionless components are angles, in rad: labels of units say so
};

inline constexpr SensorKind kSensorKinds[] = {
    {SensorType::Position, "position", "position", "L", SensorOf::Point, 3, false, false},
    {SensorType::Velocity, "velocity", "velocity", "L/T", SensorOf::Point, 3, false, false},
    {SensorType::Acceleration, "acceleration", "acceleration", "L/T^2", SensorOf::Point, 3, true, false},
    {SensorType::AngularVelocity, "angular_velocity", "angular velocity", "1/T", SensorOf::Point, 3, false, true},
    {SensorType::AngularAcceleration, "angular_acceleration", "angular acceleration", "1/T^2", SensorOf::Point, 3, true,
     true},
    {SensorType::Deflection, "deflection", "deflection", "L", SensorOf::Elastic, 3, false, false},
    {SensorType::Rotation, "rotation", "rotation", "1", SensorOf::Elastic, 3, false, true},
    // An angle by the coordinates of its hinge.
    {SensorType::HingeAngle, "hinge_angle", "hinge coordinates", "1 or L", SensorOf::Coordinate, 0, false, false},
    {SensorType::HingeRate, "hinge_rate", "hinge rates", "1/T or L/T", SensorOf::Coordinate, 0, false, true},
    {SensorType::Resolver, "resolver", "resolver", "1", SensorOf::Coordinate, 0, false, true},
    {SensorType::Tachometer, "tachometer", "tachometer", "1/T or L/T", SensorOf::Coordinate, 0, false, true},
    {SensorType::Quaternion, "quaternion", "attitude as a quaternion", "1", SensorOf::Attitude, 4, false, false},
    {SensorType::Euler, "euler", "attitude as Euler angles in rad", "1", SensorOf::Attitude, 3, false, true},
    {SensorType::DirectionCosines, "dcm", "attitude as direction cosines, row by row", "1", SensorOf::Attitude, 9,
     false, false},
    {SensorType::Gyro, "gyro", "rate gyro", "1/T", SensorOf::Instrument, 3, false, true},
    {SensorType::IntegratingGyro, "integrating_gyro", "integrating gyro", "1", SensorOf::Instrument, 3, false, true},
    {SensorType::Accelerometer, "accelerometer", "accelerometer (acceleration minus gravity)", "L/T^2",
     SensorOf::Instrument, 3, true, false},
    {SensorType::Direction, "direction", "direction to the target", "1", SensorOf::Instrument, 3, false, false},
    {SensorType::Horizon, "horizon", "roll and pitch from the direction to the centre", "1", SensorOf::Instrument, 2,
     false, true},
    {SensorType::Magnetometer, "magnetometer", "magnetic field", "by the field", SensorOf::Instrument, 3, false, false},
    {SensorType::HingeForce, "hinge_force", "force across the hinge, on the child", "F", SensorOf::HingeLoad, 3, true,
     false},
    {SensorType::HingeMoment, "hinge_moment", "moment across the hinge, on the child", "F L", SensorOf::HingeLoad, 3,
     true, false},
    {SensorType::StrainEnergy, "strain_energy", "strain energy", "F L", SensorOf::Energy, 1, false, false},
    {SensorType::ModalCoordinate, "modal_coordinate", "modal coordinates", "by normalisation", SensorOf::Modes, 0,
     false, false},
    {SensorType::ModalRate, "modal_rate", "modal rates", "by normalisation", SensorOf::Modes, 0, false, false},
    {SensorType::Distance, "distance", "distance", "L", SensorOf::Gap, 1, false, false},
    {SensorType::Element, "element", "element", "F, F L, F/L^2", SensorOf::Element, 0, true, false},
    {SensorType::LineOfSight, "line_of_sight", "line of sight", "1", SensorOf::Optics, 0, false, true},
};

/// The row of a type.
constexpr const SensorKind& get_kind(SensorType type) {
  const SensorKind* kind = kSensorKinds;
  while (kind->type != type) ++kind;
  return *kind;
}
/// The row of a word; nullptr for a word that no type has.
constexpr const SensorKind* find_sensor_kind(std::string_view word) {
  for (const auto& kind : kSensorKinds)
    if (word == kind.word) return &kind;
  return nullptr;
}

}  // namespace bough::records
