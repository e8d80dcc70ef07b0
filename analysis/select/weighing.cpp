#include "analysis/select/weighing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "analysis/common/inputs.hpp"
#include "analysis/common/spectrum_file.hpp"
#include "analysis/select/system_plant.hpp"
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

struct Weight {
  std::string name;
  double value = 1;
};

std::vector<Weight> read_weights(const std::vector<std::string>& words, const std::string& file) {
  std::vector<Weight> weights;
  for (const auto& word : words) {
    const auto sign = word.rfind('=');
    const std::string text = sign == std::string::npos ? "" : word.substr(sign + 1);
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0' || !std::isfinite(value))
      throw InputError("select.bad-weight", {file}, "--weight " + word + " is not NAME=NUMBER",
                       "write --weight tip:y=10");
    weights.push_back({word.substr(0, sign), value});
  }
  return weights;
}

[[noreturn]] void fail_weight(const std::string& name, const std::string& file, const std::vector<std::string>& known) {
  const auto near = find_nearest(name, known);
  throw InputError("select.bad-weight", {file}, "--weight: there is no input or output '" + name + "'",
                   near.empty() ? "name one of --inputs and --outputs" : "did you mean '" + near + "'?");
}

std::string name_place(const NodeDirection& place) {
  return std::to_string(place.node) + ":" +
         (place.is_rate ? kRates : kDirections)[static_cast<std::size_t>(place.direction - 1)];
}

void scale_by_weights(const SelectRequest& o, const std::string& file, records::LinearModel& model) {
  for (const auto& weight : read_weights(o.weights, file)) {
    bool is_known = false;
    const auto is_meant = [&](const std::string& name) {
      return name == weight.name || name.starts_with(weight.name + ":");
    };
    for (int i = 0; i < model.outputs.size(); ++i)
      if (is_meant(model.outputs.name[static_cast<std::size_t>(i)])) {
        model.C.row(i) *= weight.value;
        model.D.row(i) *= weight.value;
        is_known = true;
      }
    for (int i = 0; i < model.inputs.size(); ++i)
      if (is_meant(model.inputs.name[static_cast<std::size_t>(i)])) {
        model.B.col(i) *= weight.value;
        model.D.col(i) *= weight.value;
        is_known = true;
      }
    if (!is_known) {
      auto known = model.outputs.name;
      known.insert(known.end(), model.inputs.name.begin(), model.inputs.name.end());
      fail_weight(weight.name, file, known);
    }
  }
}

/// Share of the modes in the mean square below which it is rounding.
constexpr double kSeen = 1e-12;

/// The modes of `file` in the linear model of a whole system; those of several bodies from one file add up.
Weighing weigh_in_system(const SelectRequest& o, const std::string& file, std::optional<double> at,
                         const records::FlexBody& body, Diagnostics& diagnostics) {
  const auto plant = std::make_shared<SystemPlant>(
      file, o.body, OperatingChoice{at, o.equilibrium, o.open, o.inputs, o.outputs, o.set}, diagnostics);
  auto model = plant->linearize(diagnostics);
  if (model.inputs.size() == 0 || model.outputs.size() == 0) {
    throw InputError("select.no-signals", {file}, "the system has no [[force]] or no [[sensor]] to weigh modes by",
                     "add them, or name hinges with --inputs");
  }
  if (!model.D.isZero(0))
    diagnostics.note("select.feedthrough", {file},
                     "an output follows an input at once: only what the states bring to it is counted");
  for (int k = 0; k < model.poles.size(); ++k) {
    const double size = std::hypot(model.poles.real[k], model.poles.imag[k]);
    if (size <= 1e-6 * model.poles.frequency_hz.maxCoeff() * 2 * std::numbers::pi ||
        model.poles.real[k] < -1e-11 * size)
      continue;
    throw ComputationError(
        "select.unstable", {file},
        fmt::format("the pole {:.3g} ± {:.4g} i of {} does not decay: the outputs grow without limit "
                    "and no mode can be ranked",
                    model.poles.real[k], std::abs(model.poles.imag[k]), model.poles.mode[static_cast<std::size_t>(k)]),
        "give it damping, or choose a stable state");
  }
  scale_by_weights(o, file, model);
  Weighing w;
  w.name = file + (at ? fmt::format(" at t = {:g}", *at) : "");
  w.full = {model.A, model.B, model.C};
  if (!o.spectrum.empty()) w.spectrum = read_spectrum(o.spectrum, model.inputs.name, "select.bad-spectrum");
  w.reduce = [plant, o, file](const std::vector<int>& kept) {
    auto reduced = plant->linearize_with(kept);
    scale_by_weights(o, file, reduced);
    return StateSpace{reduced.A, reduced.B, reduced.C};
  };
  const auto cost = w.spectrum ? statespace::calc_component_cost(w.full, *w.spectrum)
                               : statespace::calc_component_cost(model.A, model.B, model.C);
  w.ranking.total = w.ranking.other = cost.total;
  w.ranking.modes.resize(static_cast<std::size_t>(body.num_modes()));
  for (int i = 0; i < model.states.size(); ++i) {
    for (const auto& user : plant->users()) {
      for (int mode = 0; mode < body.num_modes(); ++mode) {
        const auto name = user + ":eta" + std::to_string(mode + 1);
        const auto& state = model.states.name[static_cast<std::size_t>(i)];
        if (state != name && state != name + "_dot") continue;
        w.ranking.modes[static_cast<std::size_t>(mode)].cost += cost.state[i];
        w.ranking.other -= cost.state[i];
      }
    }
  }
  double seen = 0;
  for (const auto& mode : w.ranking.modes) seen += std::abs(mode.cost);
  if (!(seen > kSeen * w.ranking.total))
    diagnostics.warning("select.unseen", {file},
                        "no output sees the modes of the body at once: their costs are rounding, and so is their order",
                        "add outputs that move with the modes, as a deflection; what the outputs lose still holds");
  return w;
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

std::vector<Weighing> weigh_in_systems(const SelectRequest& o, const records::FlexBody& body,
                                       Diagnostics& diagnostics) {
  std::vector<Weighing> all;
  for (const auto& file : o.systems) {
    if (o.at.empty()) all.push_back(weigh_in_system(o, file, {}, body, diagnostics));
    for (const double at : o.at) all.push_back(weigh_in_system(o, file, at, body, diagnostics));
  }
  return all;
}

}  // namespace bough::analysis
