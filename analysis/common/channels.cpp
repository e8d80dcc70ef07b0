#include "analysis/common/channels.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/common/body_files.hpp"
#include "formats/records/signal_name.hpp"
#include "formats/records/unit_labels.hpp"

namespace bough::analysis {

namespace {
void add_columns(const std::string& path, const Eigen::MatrixXd& values, const std::string& description,
                 const std::string& unit, const std::string& component, const std::string& file,
                 std::vector<exports::CsvColumn>& columns) {
  const auto names = records::get_component_names(path, static_cast<int>(values.cols()), description);
  const int count = static_cast<int>(values.cols());
  const int chosen = component.empty() ? -1 : records::find_component({path, component}, count, description);
  for (int c = 0; c < count; ++c) {
    if (!component.empty() && c != chosen) continue;
    columns.push_back(
        {path.substr(1) + (names[c].empty() ? "" : ":" + names[c]), values.col(c), records::pick_unit(unit, c, count)});
  }
  if (!component.empty() && chosen < 0) {
    std::string list;
    for (const auto& name : names) list += (list.empty() ? "" : " ") + name;
    throw InputError("cli.unknown-channel", {file}, "channel " + path + " has no component \"" + component + "\"",
                     list.empty() ? "it is a scalar" : "its components are " + list);
  }
}
}  // namespace

void warn_incomplete(const std::string& file, Diagnostics& diagnostics) {
  if (read_file_format(file) != "bough-results") return;
  hdf5::RunState state;
  try {
    state = hdf5::read_run_state(file);
  } catch (const Failure&) {
    return;  // the parser of the rest reports the error
  }
  if (state.completed) return;
  const std::string why = state.reason.empty() || state.reason == "running" ? "" : " (" + state.reason + ")";
  diagnostics.warning("cli.incomplete-run", {file},
                      fmt::format("the run {}; these are its results up to t = {:g}{}",
                                  state.is_written ? "still goes on" : "did not complete", state.time, why),
                      state.is_written ? "do this again when it is through" : "bough run --resume continues it");
}

std::string get_unit(const hdf5::ResultsFile& results, const std::string& path) {
  const auto find = [&](const std::map<std::string, std::string>& texts) {
    const auto found = texts.find(path);
    return found == texts.end() ? std::string() : found->second;
  };
  const auto unit = find(results.units);
  if (!unit.empty() || has_unit_labels(results)) return unit;
  const auto dims = find(results.dims);
  return dims == "1" ? "" : dims;
}

bool has_unit_labels(const hdf5::ResultsFile& results) {
  return std::any_of(results.units.begin(), results.units.end(), [](const auto& unit) { return !unit.second.empty(); });
}

std::vector<exports::CsvColumn> choose_columns(const hdf5::ResultsFile& results, const std::string& file,
                                               const std::string& choice) {
  std::string name = choice, component;
  const auto is_there = [&](const std::string& given) {
    const std::string path = given.starts_with('/') ? given : "/sensors/" + given;
    return std::any_of(results.channels.begin(), results.channels.end(), [&](const auto& channel) {
      return channel.first == path || channel.first.starts_with(path + "/");
    });
  };
  // A name may hold a colon itself.
  if (const auto colon = choice.rfind(':'); colon != std::string::npos && !is_there(choice)) {
    name = choice.substr(0, colon);
    component = choice.substr(colon + 1);
  }
  std::vector<exports::CsvColumn> columns;
  const std::string path = name.starts_with('/') ? name : "/sensors/" + name;
  for (const auto& [channel, values] : results.channels) {
    if (channel == path || channel.starts_with(path + "/")) {
      const auto described = results.descriptions.find(channel);
      add_columns(channel, values, described == results.descriptions.end() ? "" : described->second,
                  get_unit(results, channel), component, file, columns);
    }
  }
  if (columns.empty()) {
    std::vector<std::string> known;
    for (const auto& [channel, values] : results.channels) {
      known.push_back(name.starts_with('/') || !channel.starts_with("/sensors/") ? channel : channel.substr(9));
    }
    const auto nearest = find_nearest(name, known);
    std::string sensors;
    for (const auto& [channel, values] : results.channels)
      if (channel.starts_with("/sensors/")) sensors += (sensors.empty() ? "" : ", ") + channel.substr(9);
    throw InputError("cli.unknown-channel", {file}, "no channel \"" + name + "\"",
                     !nearest.empty()  ? "did you mean \"" + nearest + "\""
                     : sensors.empty() ? "bough info lists the channels"
                                       : "the sensors are " + sensors + "; bough info lists all channels");
  }
  return columns;
}

}  // namespace bough::analysis
