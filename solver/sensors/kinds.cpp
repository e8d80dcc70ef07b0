#include "solver/sensors/kinds.hpp"

#include <algorithm>
#include <iterator>

namespace bough::solver {

const SensorKind& get_kind(records::SensorType type) {
  using T = records::SensorType;
  static const SensorKind kinds[] = {
      {T::Position, "position", "L", SensorOf::Point, 3, false},
      {T::Velocity, "velocity", "L/T", SensorOf::Point, 3, false},
      {T::Acceleration, "acceleration", "L/T^2", SensorOf::Point, 3, true},
      {T::AngularVelocity, "angular velocity", "1/T", SensorOf::Point, 3, false},
      {T::AngularAcceleration, "angular acceleration", "1/T^2", SensorOf::Point, 3, true},
      {T::Deflection, "deflection", "L", SensorOf::Elastic, 3, false},
      {T::Rotation, "rotation", "1", SensorOf::Elastic, 3, false},
      {T::HingeAngle, "hinge coordinates", "1 or L", SensorOf::Coordinate, 0, false},
      {T::HingeRate, "hinge rates", "1/T or L/T", SensorOf::Coordinate, 0, false},
      {T::Resolver, "resolver", "1", SensorOf::Coordinate, 0, false},
      {T::Tachometer, "tachometer", "1/T or L/T", SensorOf::Coordinate, 0, false},
      {T::Quaternion, "attitude as a quaternion", "1", SensorOf::Attitude, 4, false},
      {T::Euler, "attitude as Euler angles in rad", "1", SensorOf::Attitude, 3, false},
      {T::DirectionCosines, "attitude as direction cosines, row by row", "1", SensorOf::Attitude, 9, false},
      {T::Gyro, "rate gyro", "1/T", SensorOf::Instrument, 3, false},
      {T::IntegratingGyro, "integrating gyro", "1", SensorOf::Instrument, 3, false},
      {T::Accelerometer, "accelerometer (acceleration less gravity)", "L/T^2", SensorOf::Instrument, 3, true},
      {T::Direction, "direction to the target", "1", SensorOf::Instrument, 3, false},
      {T::Horizon, "roll and pitch from the direction to the centre", "1", SensorOf::Instrument, 2, false},
      {T::Magnetometer, "magnetic field", "by the field", SensorOf::Instrument, 3, false},
      {T::HingeForce, "force across the hinge, on the child", "F", SensorOf::HingeLoad, 3, true},
      {T::HingeMoment, "moment across the hinge, on the child", "F L", SensorOf::HingeLoad, 3, true},
      {T::StrainEnergy, "strain energy", "F L", SensorOf::Energy, 1, false},
      {T::ModalCoordinate, "modal coordinates", "by normalisation", SensorOf::Modes, 0, false},
      {T::ModalRate, "modal rates", "by normalisation", SensorOf::Modes, 0, false},
      {T::Distance, "distance", "L", SensorOf::Gap, 1, false},
      {T::Element, "element", "F, F L, F/L^2", SensorOf::Element, 0, true},
  };
  const auto found = std::find_if(std::begin(kinds), std::end(kinds), [&](const auto& k) { return k.type == type; });
  BOUGH_DEMAND(found != std::end(kinds));
  return *found;
}

}  // namespace bough::solver
