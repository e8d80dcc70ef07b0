#include "analysis/select/weighing.hpp"

#include <algorithm>
#include <charconv>

#include "analysis/common/spectrum_file.hpp"
#include "analysis/select/weights.hpp"
#include "formats/records/mode_subset.hpp"

namespace bough::analysis {

using statespace::NodeDirection;
using statespace::Spectrum;
using statespace::StateSpace;

namespace {

const std::vector<std::string> kDirections{"x", "y", "z", "rx", "ry", "rz"};
const std::vector<std::string> kRates{"vx", "vy", "vz", "wx", "wy", "wz"};

/// "12" (its three translations) or "12:z".
std::vector<NodeDirection> read_place(const records::FlexBody& body, const std::string& word, bool may_be_rate,
                                      const std::string& file) {
  const auto colon = word.find(':');
  const std::string number = word.substr(0, colon);
  int id = 0;
  const auto read = std::from_chars(number.data(), number.data() + number.size(), id);
  if (read.ec != std::errc() || read.ptr != number.data() + number.size() || body.find_node(id) < 0) {
    std::string known;
    for (std::size_t i = 0; i < body.node_id.size() && i < 12; ++i)
      known += (i > 0 ? ", " : "") + std::to_string(body.node_id[i]);
    throw InputError("select.unknown-node", {file}, "the body has no output node \"" + number + "\"",
                     "its nodes are " + known + (body.node_id.size() > 12 ? ", ..." : ""));
  }
  if (colon == std::string::npos) return {{id, 1}, {id, 2}, {id, 3}};
  const std::string direction = word.substr(colon + 1);
  const auto found = std::find(kDirections.begin(), kDirections.end(), direction);
  if (found != kDirections.end()) return {{id, static_cast<int>(found - kDirections.begin()) + 1}};
  const auto rate = std::find(kRates.begin(), kRates.end(), direction);
  if (may_be_rate && rate != kRates.end()) return {{id, static_cast<int>(rate - kRates.begin()) + 1, true}};
  throw InputError("select.unknown-direction", {file}, "\"" + word + "\" names no direction",
                   may_be_rate ? "write NODE, or NODE:x, y, z, rx, ry, rz, or vx, vy, vz, wx, wy, wz for rates"
                               : "write NODE, or NODE:x, y, z, rx, ry or rz");
}

std::string name_place(const NodeDirection& place) {
  return std::to_string(place.node) + ":" +
         (place.is_rate ? kRates : kDirections)[static_cast<std::size_t>(place.direction - 1)];
}

}  // namespace

double Weighing::calc_lost(const std::vector<int>& kept) const {
  if (kept.size() == ranking.modes.size() || !(ranking.total > 0)) return 0;
  if (kept.empty()) return 1;
  const auto small = reduce(kept);
  return (spectrum ? statespace::calc_mean_square_difference(full, small, *spectrum)
                   : statespace::calc_mean_square_difference(full, small)) /
         ranking.total;
}

std::vector<NodeDirection> choose_places(const records::FlexBody& body, const std::vector<std::string>& words,
                                         const std::vector<std::string>& weights, bool may_be_rates,
                                         const std::string& file) {
  std::vector<NodeDirection> places;
  for (const auto& word : words)
    for (const auto& place : read_place(body, word, may_be_rates, file)) places.push_back(place);
  for (const auto* ids : {&body.interface_nodes, &body.node_id}) {
    if (!places.empty()) break;
    for (const int id : *ids) {
      const auto& phi = body.phi[static_cast<std::size_t>(body.find_node(id))];
      if (phi.topRows(3).isZero(0)) continue;
      for (int direction = 1; direction <= 3; ++direction) places.push_back({id, direction});
    }
  }
  for (const auto& weight : read_weights(weights, file)) {
    bool is_known = false;
    std::vector<std::string> known;
    for (auto& place : places) {
      known.push_back(name_place(place));
      if (known.back() != weight.name && !known.back().starts_with(weight.name + ":")) continue;
      place.weight *= weight.value;
      is_known = true;
    }
    // Weights of outputs are no inputs' and the other way round: one of both lists must know them.
    if (!is_known && may_be_rates) {
      try {
        read_place(body, weight.name, true, file);
      } catch (const InputError&) {
        fail_weight(weight.name, file, known);
      }
    }
  }
  return places;
}

Weighing weigh_alone(const SelectRequest& o, const records::FlexBody& body, const std::vector<NodeDirection>& inputs,
                     const std::vector<NodeDirection>& outputs) {
  const double damping = o.damping;
  Weighing w;
  if (!o.spectrum.empty()) {
    std::vector<std::string> names;
    for (const auto& place : inputs) names.push_back(name_place(place));
    w.spectrum = read_spectrum(o.spectrum, names, "select.bad-spectrum");
  }
  w.name = o.body;
  w.ranking = statespace::rank_modes(body, inputs, outputs, damping, w.spectrum ? &*w.spectrum : nullptr);
  w.full = statespace::make_state_space(body, inputs, outputs, damping);
  w.reduce = [&body, inputs, outputs, damping](const std::vector<int>& kept) {
    return statespace::make_state_space(records::keep_modes(body, kept), inputs, outputs, damping);
  };
  return w;
}

}  // namespace bough::analysis
