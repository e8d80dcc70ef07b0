#pragma once
/// \file Makers of the actuators' blocks; for build/actuators.cpp.
#include <string>

#include "solver/actuators/actuator.hpp"
#include "solver/forces/applied.hpp"

namespace bough::solver {

/// Where an actuator acts: a row of u (of a mode: of TreeData::applied), or a marker.
struct ActuatorPlace {
  std::string effort = "F L or F";  ///< dimension along the hinge coordinate
  int row = -1, marker = -1;
  int tank = -1;               ///< in Tree::tanks, of thrusters
  bool is_tank_empty = false;  ///< from the start
};

/// Makes a force, motor or brake on a hinge coordinate. Reports control.* through `keys`.
std::unique_ptr<Actuator> make_hinge_actuator(const records::ActuatorRecord& record, SettingsReader& keys,
                                              const ActuatorPlace& place);
/// Makes a generalized force on a modal coordinate; all keys are those of read_shaping().
std::unique_ptr<Actuator> make_modal_actuator(const records::ActuatorRecord& record, SettingsReader& keys,
                                              const ActuatorPlace& place);
/// Makes a force, moment, jet, engine or torque rod at a marker.
std::unique_ptr<Actuator> make_node_actuator(const records::ActuatorRecord& record, SettingsReader& keys,
                                             const ActuatorPlace& place);
/// Makes a momentum wheel or a control moment gyro with one or two gimbals at a marker.
std::unique_ptr<Actuator> make_rotor(const records::ActuatorRecord& record, SettingsReader& keys,
                                     const ActuatorPlace& place);
/// A unit vector: "axis".
Vector3d read_axis(SettingsReader& keys, const std::string& key = "axis");

}  // namespace bough::solver
