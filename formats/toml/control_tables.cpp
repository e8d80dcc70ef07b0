#include "formats/toml/detail/control_tables.hpp"

#include <algorithm>
#include <numbers>

#include "base/rotation.hpp"

namespace bough::toml_files {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

bool is_known(const std::vector<std::string>& known, const std::string& key) {
  return std::find(known.begin(), known.end(), key) != known.end();
}

/// False when the items are not lists of numbers of one length.
bool read_rows(const Value& value, Eigen::MatrixXd& matrix) {
  const auto rows = static_cast<Eigen::Index>(value.items.size());
  const auto columns = static_cast<Eigen::Index>(value.items.front().items.size());
  matrix.resize(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const auto& row = value.items[static_cast<std::size_t>(i)].items;
    if (static_cast<Eigen::Index>(row.size()) != columns) return false;
    for (Eigen::Index j = 0; j < columns; ++j) {
      if (!row[static_cast<std::size_t>(j)].is_number()) return false;
      matrix(i, j) = row[static_cast<std::size_t>(j)].number;
    }
  }
  return true;
}

}  // namespace

records::ConnectRecord read_connect(const Fields& table) {
  return {table.get_string("from"), table.get_string("to"), table.get_number("gain", 1), table.locate()};
}

records::InputRecord read_input(const Fields& table) {
  const bool is_linear = table.get_string("hold", "zero") == "linear";
  return {table.get_string("name"), table.get_string("dims"), table.get_number("start", 0),
          is_linear ? records::InputHold::Linear : records::InputHold::Zero, table.locate()};
}

records::Settings read_settings(const Fields& table, const std::string& path, const std::vector<std::string>& known,
                                Diagnostics& diagnostics) {
  records::Settings settings;
  for (const auto& entry : table.entries()) {
    if (is_known(known, entry.key)) continue;
    const Value& v = entry.value;
    const bool in_degrees = entry.key.ends_with("_deg");
    const std::string key = in_degrees ? entry.key.substr(0, entry.key.size() - 4) : entry.key;
    if (v.is_string() || (v.is_array() && !v.items.empty() && v.items[0].is_string())) {
      settings.words[key] = table.get_strings(entry.key);
    } else if (v.is_array() && !v.items.empty() && v.items[0].is_array()) {
      Eigen::MatrixXd matrix;
      if (!read_rows(v, matrix))
        diagnostics.error("toml.wrong-type", {path, entry.line}, "'" + key + "' is not a list of rows of one length",
                          "give a list of lists of numbers");
      settings.matrices[key] = matrix;
    } else {
      auto numbers = table.get_numbers(entry.key);
      if (entry.key == "angle" || entry.key == "misalignment") check_radians(table, key, numbers, diagnostics);
      for (double& number : numbers) number *= in_degrees ? kDegree : 1;
      settings.numbers[key] = std::move(numbers);
    }
  }
  return settings;
}

/// A record with its place, name and type.
template <class Record>
Record read_head(const Fields& table) {
  Record r;
  r.at = table.locate();
  r.name = table.get_string("name");
  r.type = table.get_string("type");
  return r;
}

records::ControllerRecord read_controller(const Fields& table, const std::string& path, Diagnostics& diagnostics) {
  auto r = read_head<records::ControllerRecord>(table);
  r.inputs = table.get_strings("inputs");
  r.reference = table.get_string("reference");
  r.rate = table.get_string("rate");
  r.active = table.get_bool("active", true);
  r.settings = read_settings(table, path, {"name", "type", "inputs", "reference", "rate", "active"}, diagnostics);
  if (const auto file = r.settings.words.find("file"); file != r.settings.words.end() && !file->second.empty())
    file->second = {resolve_path(path, file->second.front())};
  return r;
}

records::ActuatorRecord read_actuator(const Fields& table, const std::string& path, Diagnostics& diagnostics) {
  auto r = read_head<records::ActuatorRecord>(table);
  r.input = table.get_string("input");
  r.body = table.get_string("body");
  r.hinge = table.get_string("hinge");
  r.node = table.get_int("node", 0);
  r.coordinate = table.get_int("coordinate", 1);
  r.frame = table.get_string("frame", "body");
  r.settings = read_settings(table, path, {"name", "type", "input", "body", "hinge", "node", "coordinate", "frame"},
                             diagnostics);
  return r;
}

std::vector<records::OpticalTerm> read_optical_terms(const Fields& table, const std::string& sensor,
                                                     Diagnostics& diagnostics) {
  constexpr Eigen::Index kMaxRows = 3;
  std::vector<records::OpticalTerm> terms;
  Eigen::Index num_outputs = 0;
  for (const Fields& item : table.get_tables("terms")) {
    records::OpticalTerm term;
    term.at = item.locate();
    term.body = item.get_string("body");
    term.node = item.get_int("node", 0);
    for (const char* key : {"displacement", "rotation"}) {
      Eigen::MatrixXd& weights = key[0] == 'd' ? term.displacement : term.rotation;
      if (!item.has(key)) continue;
      const bool has_rows = read_rows(*item.find(key), weights) && weights.cols() == 3 && weights.rows() <= kMaxRows &&
                            weights.allFinite();
      if (!has_rows) {
        diagnostics.error("toml.wrong-type", item.locate(key),
                          std::string("'") + key + "' of line of sight '" + sensor + "' is not a list of rows of 3",
                          "give a row of 3 finite numbers for each output, 3 rows at most");
        weights.resize(0, 0);
        continue;
      }
      if (num_outputs == 0) num_outputs = weights.rows();
      if (weights.rows() != num_outputs)
        diagnostics.error("toml.wrong-length", item.locate(key),
                          std::string("'") + key + "' of line of sight '" + sensor + "' has " +
                              std::to_string(weights.rows()) + " rows, expected " + std::to_string(num_outputs),
                          "give as many rows in every term");
    }
    if (!item.has("displacement") && !item.has("rotation"))
      diagnostics.error("toml.missing-key", term.at, "a term of line of sight '" + sensor + "' has no weights",
                        "give displacement, rotation or both");
    terms.push_back(std::move(term));
  }
  return terms;
}

void read_sensor_keys(const Fields& table, const std::string& path, const std::string& type,
                      records::SensorRecord& sensor, Diagnostics& diagnostics) {
  static const std::vector<std::string> common = {"scale",       "bias", "misalignment", "noise_density",
                                                  "random_walk", "seed", "quantization", "range",
                                                  "delay",       "lag",  "sample_time",  "initial"};
  static const std::vector<std::string> own = {"rotation", "target",  "to_body",   "to_node",
                                               "sequence", "element", "component", "terms"};
  sensor.to_body = table.get_string("to_body");
  sensor.to_node = table.get_int("to_node", 0);
  sensor.element = table.get_int("element", 0);
  sensor.component = table.get_string("component");
  sensor.sequence = table.get_string("sequence", "321");
  sensor.target = table.get_vector("target", type == "direction" ? sensor.target : Eigen::Vector3d::Zero());
  sensor.mount = read_rotation(table, "rotation", diagnostics);
  const auto of = records::get_kind(sensor.type).of;
  std::vector<std::string> others;
  for (const auto& entry : table.entries()) {
    const std::string key = entry.key.ends_with("_deg") ? entry.key.substr(0, entry.key.size() - 4) : entry.key;
    if (!is_known(common, key)) others.push_back(entry.key);
    if (!is_known(own, key)) continue;
    const bool is_mounted = of == records::SensorOf::Attitude || of == records::SensorOf::Instrument;
    const bool is_taken = key == "rotation"                        ? is_mounted
                          : key == "sequence"                      ? type == "euler"
                          : key == "terms"                         ? of == records::SensorOf::Optics
                          : key == "element" || key == "component" ? of == records::SensorOf::Element
                          : key == "target" ? type == "direction" || type == "horizon" || of == records::SensorOf::Gap
                                            : of == records::SensorOf::Gap;
    if (!is_taken)
      diagnostics.error("toml.conflicting-keys", {path, entry.line},
                        "'" + entry.key + "' has no meaning in sensor '" + sensor.name + "' of type " + type,
                        "remove it");
  }
  sensor.chain = read_settings(table, path, others, diagnostics);
}

}  // namespace bough::toml_files
