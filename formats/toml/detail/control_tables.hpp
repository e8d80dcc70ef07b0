#pragma once
/// \file [[controller]], [[actuator]] and the sensors' own keys of a system file.
#include "formats/records/system_spec.hpp"
#include "formats/toml/detail/fields.hpp"

namespace bough::toml_files {

/// Numbers, lists, lists of rows and texts of a table, but for the keys in `known`. Angles under K_deg become K, in
/// radians. Reports "toml.wrong-type" for rows of different lengths.
records::Settings read_settings(const Fields& table, const std::string& path, const std::vector<std::string>& known,
                                Diagnostics& diagnostics);
records::ControllerRecord read_controller(const Fields& table, const std::string& path, Diagnostics& diagnostics);
records::ActuatorRecord read_actuator(const Fields& table, const std::string& path, Diagnostics& diagnostics);
records::ConnectRecord read_connect(const Fields& table);
records::InputRecord read_input(const Fields& table);
/// Mount, target, the other end, sequence, and what becomes of the measurement; refuses those that the type does not
/// take.
void read_sensor_keys(const Fields& table, const std::string& path, const std::string& type,
                      records::SensorRecord& sensor, Diagnostics& diagnostics);

}  // namespace bough::toml_files
