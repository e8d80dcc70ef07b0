#pragma once
/// \file [[controller]], [[actuator]] and the sensors' own keys of a system file.
#include "formats/records/system_spec.hpp"
#include "formats/toml/detail/fields.hpp"

namespace bough::toml_files {

/// Numbers, lists, lists of rows and texts of a table, but for the keys in `known`. Angles under K_deg become K, in
/// radians. Reports "toml.wrong-type" for rows of different lengths.
records::Settings read_settings(const Fields& table, const std::string& path, const std::vector<std::string>& known,
                                Diagnostics& diagnostics);
/// Reads a [[controller]]; keys that depend on its type become settings.
records::ControllerRecord read_controller(const Fields& table, const std::string& path, Diagnostics& diagnostics);
/// Reads an [[actuator]]; keys that depend on its type become settings.
records::ActuatorRecord read_actuator(const Fields& table, const std::string& path, Diagnostics& diagnostics);
/// Reads a [[connect]]; the gain is 1 by default.
records::ConnectRecord read_connect(const Fields& table);
/// Reads an [[input]]; it starts at 0 and is held by default.
records::InputRecord read_input(const Fields& table);
/// Reads the terms of a line of sight. Reports toml.wrong-type, toml.wrong-length and toml.missing-key.
std::vector<records::OpticalTerm> read_optical_terms(const Fields& table, const std::string& sensor,
                                                     Diagnostics& diagnostics);
/// Reads mount, target, the other end, sequence and the processing of the measurement; rejects keys that do not belong
/// to the type.
void read_sensor_keys(const Fields& table, const std::string& path, const std::string& type,
                      records::SensorRecord& sensor, Diagnostics& diagnostics);

}  // namespace bough::toml_files
