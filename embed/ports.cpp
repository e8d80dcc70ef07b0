#include "embed/ports.hpp"

#include <algorithm>
#include <limits>

#include "embed/bough.h"
#include "formats/records/signal_name.hpp"
#include "solver/builder/signal_units.hpp"

namespace bough::embed {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Rank of a channel among the outputs.
int rank(const std::string& path) {
  static const char* const order[] = {"/sensors/", "/controllers/", "/actuators/", "/inputs/", "/hinges/"};
  for (int i = 0; i < 5; ++i)
    if (path.starts_with(order[i])) return i;
  return 5;
}

}  // namespace

Ports::Ports(const records::SystemSpec& spec, const solver::Simulator& simulator) {
  for (const auto& r : spec.inputs) ports_[BOUGH_INPUTS].push_back({r.name, r.dims, r.start, 0});
  for (const auto& [name, value] : spec.parameters) ports_[BOUGH_PARAMETERS].push_back({name, "", value, 0});
  add_outputs(simulator.channels());
  for (const auto& port : ports_[BOUGH_OUTPUTS]) output_rows_.push_back(port.row);
  for (int i = 0; i < simulator.num_states(); ++i)
    ports_[BOUGH_STATES].push_back({simulator.name_state(i), "", kNone, i});
  for (const auto& name : simulator.list_event_functions()) ports_[BOUGH_EVENTS].push_back({name, "", kNone, 0});
  for (int kind = 0; kind < 5; ++kind)
    for (std::size_t i = 0; i < ports_[kind].size(); ++i)
      index_[kind].insert_or_assign(ports_[kind][i].name, static_cast<int>(i));
}

void Ports::add_outputs(const std::vector<records::Channel>& channels) {
  struct Entry {
    const records::Channel* channel;
    int row;
  };
  std::vector<Entry> entries;
  int row = 0;
  for (const auto& c : channels) {
    if (c.path != "/time") entries.push_back({&c, row});
    row += c.size;
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return rank(a.channel->path) < rank(b.channel->path); });
  for (const auto& [channel, first] : entries) {
    const auto& path = channel->path;
    const bool is_sensor = path.starts_with("/sensors/");
    const std::string name = is_sensor ? path.substr(9) : path;
    const auto dims = solver::split_dims(channel->dims, channel->size);
    const auto components = records::get_component_names(path, channel->size, channel->description);
    std::vector<std::string> all{path};
    if (is_sensor) all.push_back(name);
    if (rank(path) < 4) all.push_back(path.substr(path.find('/', 1) + 1));
    for (const auto& own : all)
      channels_.emplace(own, std::pair(static_cast<int>(ports_[BOUGH_OUTPUTS].size()), channel->size));
    for (int i = 0; i < channel->size; ++i) {
      const auto& component = components[static_cast<std::size_t>(i)];
      ports_[BOUGH_OUTPUTS].push_back({name + (component.empty() ? "" : ":" + component),
                                       dims[static_cast<std::size_t>(i)], kNone, first + i, path});
      // Other names of the same: the path of a sensor, the bare name of a controller or actuator, counts.
      auto& index = index_[BOUGH_OUTPUTS];
      const int at = static_cast<int>(ports_[BOUGH_OUTPUTS].size()) - 1;
      for (const auto& other : all) {
        if (!component.empty()) index.emplace(other + ":" + component, at);
        index.emplace(other + ":" + std::to_string(i + 1), at);
        if (channel->size == 1) index.emplace(other, at);
      }
    }
  }
}

const std::vector<Port>* Ports::list(int kind) const { return kind < 0 || kind > 4 ? nullptr : &ports_[kind]; }

int Ports::find(int kind, const std::string& name) const {
  if (kind < 0 || kind > 4) return -1;
  const auto found = index_[kind].find(name);
  return found == index_[kind].end() ? -1 : found->second;
}

std::vector<int> Ports::find_outputs(const std::string& name) const {
  std::vector<int> found;
  const auto channel = channels_.find(name);
  if (channel != channels_.end()) {
    for (int i = 0; i < channel->second.second; ++i) found.push_back(channel->second.first + i);
  } else if (const int one = find(BOUGH_OUTPUTS, name); one >= 0) {
    found.push_back(one);
  }
  return found;
}

}  // namespace bough::embed
