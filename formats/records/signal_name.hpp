#pragma once
/// \file "name:component", the one form in which files and options name a signal: a sensor, or with a slash before it
/// any channel of the results. Without a component a scalar is meant, or all of them.
#include <string>
#include <vector>

namespace bough::records {

struct SignalName {
  std::string path;       ///< "/sensors/tip", "/hinges/root/q"
  std::string component;  ///< "x", "2"; may be empty
};
/// Splits a name at its last colon; a path without a slash is that of a sensor.
SignalName parse_signal_name(const std::string& text);

/// Names of the components of a channel: x y z, w x y z, or counts from 1 (hinges, modes, actuators); one empty name
/// for a scalar.
std::vector<std::string> get_component_names(const std::string& path, int size);

/// Names listed at the end of the channel's description, otherwise those of its path. Lists: "axial, shear_y" of
/// /bodies/B/recovery/..., "CBEAM/101 of body frame: axial, shear_y" and "... in rad: angle1, angle2, angle3" of
/// sensors, "outputs of a controller of type fmu: torque, speed" of controllers. A name stands for a scalar too.
std::vector<std::string> get_component_names(const std::string& path, int size, const std::string& description);

/// Index from 0 of a component by its name or its count from 1, -1 without such a component; empty: 0 of a scalar.
int find_component(const SignalName& name, int size, const std::string& description);

}  // namespace bough::records
