// Pointing budgets: exposures and disturbance sources for `response --budget`.
#include "formats/toml/budget.hpp"

#include <algorithm>
#include <map>
#include <numbers>

#include "formats/toml/detail/density_table.hpp"
#include "formats/toml/detail/fields.hpp"
#include "formats/toml/detail/schema.hpp"

namespace bough::toml_files {

namespace {

constexpr double kPerRpm = 2 * std::numbers::pi / 60;
constexpr double kDegree = std::numbers::pi / 180;

void wrong(const SourceLocation& at, const std::string& what, const std::string& advice, Diagnostics& diagnostics) {
  diagnostics.error("linear.bad-budget", at, what, advice);
}

std::vector<double> repeat(std::vector<double> values, std::size_t size) {
  if (values.size() == 1) values.resize(size, values[0]);
  return values;
}

records::ToneRow read_row(const Fields& table, const std::string& type, Diagnostics& diagnostics) {
  records::ToneRow row;
  row.at = table.locate();
  row.number = table.get_number("number", 1);
  if (row.number == 0 || (row.number < 0 && type == "tones"))
    wrong(table.locate("number"), "the number of a harmonic is " + std::string(row.number == 0 ? "0" : "negative"),
          "give a number above 0", diagnostics);
  if (type == "wheel") {
    refuse_keys(table, {"input", "amplitude"}, "in a source of type wheel", diagnostics);
    row.radial_force = table.get_number("radial_force", 0);
    row.axial_force = table.get_number("axial_force", 0);
    row.radial_moment = table.get_number("radial_moment", 0);
    row.axial_moment = table.get_number("axial_moment", 0);
    const auto phase = table.get_numbers("phase_deg");
    if (phase.size() > 1)
      wrong(table.locate("phase_deg"), "phase_deg of a wheel is a list", "give one number", diagnostics);
    row.moment_phase = phase.empty() ? 0 : phase[0] * kDegree;
    return row;
  }
  refuse_keys(table, {"radial_force", "axial_force", "radial_moment", "axial_moment"}, "in a source of type tones",
              diagnostics);
  row.inputs = table.get_strings("input");
  row.amplitude = repeat(table.get_numbers("amplitude"), row.inputs.size());
  row.phase = table.has("phase_deg") ? repeat(table.get_numbers("phase_deg"), row.inputs.size())
                                     : std::vector<double>(row.inputs.size(), 0);
  for (double& phase : row.phase) phase *= kDegree;
  if (row.inputs.empty() || row.amplitude.size() != row.inputs.size() || row.phase.size() != row.inputs.size())
    wrong(row.at,
          "a harmonic has " + std::to_string(row.inputs.size()) + " inputs, " + std::to_string(row.amplitude.size()) +
              " amplitudes and " + std::to_string(row.phase.size()) + " phases",
          "give an amplitude for each input", diagnostics);
  return row;
}

std::optional<records::WheelMode> read_mode(const Fields& table, const char* key) {
  if (!table.has(key)) return {};
  const Fields mode = table.get_table(key);
  return records::WheelMode{mode.get_number("frequency_hz", 0), mode.get_number("damping", 0)};
}

void read_wheel(const Fields& table, records::DisturbanceSource& source, Diagnostics& diagnostics) {
  const std::string name = "source '" + source.name + "'";
  for (const double rpm : table.get_numbers("speed_rpm")) source.speed.push_back(rpm * kPerRpm);
  if (table.has("range_rpm")) {
    refuse_keys(table, {"speed_rpm"}, "if there is range_rpm", diagnostics);
    const auto range = table.get_numbers("range_rpm");
    const int points = table.get_int("points", 200);
    if (range.size() == 2 && range[1] > range[0])
      for (int k = 0; k < points; ++k)
        source.speed.push_back((range[0] + (range[1] - range[0]) * k / (points - 1)) * kPerRpm);
    else
      wrong(table.locate("range_rpm"), name + ": the speeds do not rise", "give [LOWEST, HIGHEST]", diagnostics);
  } else {
    refuse_keys(table, {"points"}, "if there is no range_rpm", diagnostics);
    if (source.speed.empty()) wrong(source.at, name + " has no speed", "give speed_rpm or range_rpm", diagnostics);
  }
  source.force = table.get_strings("force");
  source.moment = table.get_strings("moment");
  source.radial = read_mode(table, "radial");
  source.axial = read_mode(table, "axial");
  source.rocking = read_mode(table, "rocking");
  if (!source.rocking) refuse_keys(table, {"inertia_ratio"}, "if there is no rocking", diagnostics);
  source.inertia_ratio = table.get_number("inertia_ratio", source.inertia_ratio);
  for (const auto& row : source.rows) {
    const auto demand = [&](double value, const std::vector<std::string>& inputs, std::size_t size, const char* key,
                            const char* list) {
      if (value == 0 || inputs.size() >= size) return;
      wrong(row.at, name + ": a harmonic has " + key + ", and the source has no input for it",
            std::string("name ") + std::to_string(size) + " inputs in " + list, diagnostics);
    };
    demand(row.radial_force, source.force, 2, "radial_force", "force");
    demand(row.axial_force, source.force, 3, "axial_force", "force");
    demand(row.radial_moment, source.moment, 2, "radial_moment", "moment");
    demand(row.axial_moment, source.moment, 3, "axial_moment", "moment");
  }
}

records::DisturbanceSource read_source(const Fields& table, const std::string& path, Diagnostics& diagnostics) {
  records::DisturbanceSource source;
  source.at = table.locate();
  source.name = table.get_string("name");
  source.type = table.get_string("type");
  static const std::map<std::string, std::vector<std::string>> owners = {
      {"psd", {"psd"}},         {"frequency_hz", {"tones"}},  {"speed_rpm", {"wheel"}},
      {"range_rpm", {"wheel"}}, {"points", {"wheel"}},        {"force", {"wheel"}},
      {"moment", {"wheel"}},    {"radial", {"wheel"}},        {"axial", {"wheel"}},
      {"rocking", {"wheel"}},   {"inertia_ratio", {"wheel"}}, {"harmonic", {"tones", "wheel"}},
  };
  for (const auto& [key, types] : owners)
    if (std::find(types.begin(), types.end(), source.type) == types.end())
      refuse_keys(table, {key.c_str()}, "in source '" + source.name + "' of type " + source.type, diagnostics);
  for (const char* key : {"psd", "frequency_hz", "harmonic"}) {
    const auto& types = owners.at(key);
    if (std::find(types.begin(), types.end(), source.type) != types.end() && !table.has(key))
      diagnostics.error("toml.missing-key", source.at,
                        "missing key '" + std::string(key) + "' in source '" + source.name + "' of type " + source.type,
                        "add it");
  }
  for (const Fields& density : table.get_tables("psd"))
    source.densities.push_back(read_density(density, path, diagnostics));
  source.frequency_hz = table.get_number("frequency_hz", 0);
  for (const Fields& row : table.get_tables("harmonic")) source.rows.push_back(read_row(row, source.type, diagnostics));
  if (source.type == "wheel") read_wheel(table, source, diagnostics);
  return source;
}

}  // namespace

records::BudgetSpec read_budget(const std::string& path, Diagnostics& diagnostics) {
  records::BudgetSpec spec;
  Value root;
  if (!read_checked(path, get_budget_schema(), root, diagnostics)) return spec;
  const Fields fields(root, path);
  spec.exposures = fields.get_numbers("exposure");
  spec.interval = fields.get_number("interval", 0);
  if (spec.exposures.empty()) refuse_keys(fields, {"interval"}, "if there is no exposure", diagnostics);
  for (const Fields& table : fields.get_tables("source")) {
    spec.sources.push_back(read_source(table, path, diagnostics));
    const auto& name = spec.sources.back().name;
    for (std::size_t k = 0; k + 1 < spec.sources.size(); ++k)
      if (spec.sources[k].name == name)
        wrong(spec.sources.back().at, "two sources have the name '" + name + "'", "rename one", diagnostics);
  }
  return spec;
}

}  // namespace bough::toml_files
