#include "analysis/select/system_weighing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>

#include "analysis/common/body_files.hpp"
#include "analysis/common/spectrum_file.hpp"
#include "analysis/select/system_plant.hpp"
#include "analysis/select/weights.hpp"
#include "formats/records/mode_subset.hpp"

namespace bough::analysis {

using statespace::StateSpace;

namespace {

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

/// One row of a ranking: a mode of each of these bodies, which have one file.
using ModeUses = std::vector<std::vector<BodyMode>>;

std::vector<BodyMode> list_modes(const ModeUses& uses) {
  std::vector<BodyMode> all;
  for (const auto& row : uses) all.insert(all.end(), row.begin(), row.end());
  return all;
}

/// Ranks modes in the linear model of a whole system. \param find_uses  the rows of the ranking.
Weighing weigh_in_system(const SelectRequest& o, const std::string& file, std::optional<double> at,
                         const std::function<ModeUses(const SystemPlant&)>& find_uses, Diagnostics& diagnostics) {
  const auto plant = std::make_shared<SystemPlant>(
      file, OperatingChoice{at, o.equilibrium, o.open, o.inputs, o.outputs, o.set}, diagnostics);
  const auto uses = find_uses(*plant);
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
  w.reduce = [plant, o, file, uses](const std::vector<int>& kept) {
    ModeUses some;
    for (const int row : kept) some.push_back(uses[static_cast<std::size_t>(row)]);
    auto reduced = plant->linearize_with(list_modes(uses), list_modes(some));
    scale_by_weights(o, file, reduced);
    return StateSpace{reduced.A, reduced.B, reduced.C};
  };
  const auto cost = w.spectrum ? statespace::calc_component_cost(w.full, *w.spectrum)
                               : statespace::calc_component_cost(model.A, model.B, model.C);
  w.ranking.total = w.ranking.other = cost.total;
  w.ranking.modes.resize(uses.size());
  std::map<std::string, Eigen::Index> states;
  for (int i = 0; i < model.states.size(); ++i) states[model.states.name[static_cast<std::size_t>(i)]] = i;
  for (std::size_t row = 0; row < uses.size(); ++row) {
    for (const auto& use : uses[row]) {
      const auto name = use.body + ":eta" + std::to_string(use.mode + 1);
      for (const auto& state : {name, name + "_dot"}) {
        const auto found = states.find(state);
        if (found == states.end()) continue;  // a mode that the system does not use
        w.ranking.modes[row].cost += cost.state[found->second];
        w.ranking.other -= cost.state[found->second];
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

std::vector<Weighing> weigh_everywhere(const SelectRequest& o,
                                       const std::function<ModeUses(const SystemPlant&)>& find_uses,
                                       Diagnostics& diagnostics) {
  std::vector<Weighing> all;
  for (const auto& file : o.systems) {
    if (o.at.empty()) all.push_back(weigh_in_system(o, file, {}, find_uses, diagnostics));
    for (const double at : o.at) all.push_back(weigh_in_system(o, file, at, find_uses, diagnostics));
  }
  return all;
}

/// The modes that a body uses; nothing if it is rigid.
std::optional<records::FlexBody> take_used_modes(const LoadedSystem& loaded, const records::BodyRecord& record) {
  const auto found = loaded.flex.find(record.file);
  if (found == loaded.flex.end()) return {};
  const int num_used = record.num_modes < 0 ? found->second.num_modes() : record.num_modes;
  if (num_used == 0) return {};
  if (num_used == found->second.num_modes()) return found->second;
  std::vector<int> used(static_cast<std::size_t>(num_used));
  std::iota(used.begin(), used.end(), 0);
  return records::keep_modes(found->second, used);
}

}  // namespace

std::vector<Weighing> weigh_in_systems(const SelectRequest& o, Diagnostics& diagnostics) {
  return weigh_everywhere(
      o, [&](const SystemPlant& plant) { return plant.list_uses(o.body); }, diagnostics);
}

std::vector<SystemBody> list_system_bodies(const SelectRequest& o, Diagnostics& diagnostics) {
  std::vector<SystemBody> bodies;
  const auto by_name = [](const SystemBody& a, const SystemBody& b) { return a.name < b.name; };
  for (const auto& system : o.systems) {
    Diagnostics again;
    const bool is_first = &system == &o.systems.front();
    const auto loaded = load_system(system, is_first ? diagnostics : again, {}, o.set);
    std::vector<SystemBody> of_system;
    for (const auto& record : loaded.spec.bodies) demand_one_level(record, system);
    for (const auto& record : loaded.spec.bodies)
      if (auto body = take_used_modes(loaded, record))
        of_system.push_back({record.name, embed::shorten_path(resolve_beside(system, record.file)), std::move(*body)});
    if (of_system.empty())
      throw InputError("select.no-modes", {system}, "no body of the system has modes",
                       "name a system with flexible bodies, or a body file first");
    std::sort(of_system.begin(), of_system.end(), by_name);
    if (is_first) {
      bodies = std::move(of_system);
      continue;
    }
    const auto is_same = [](const SystemBody& a, const SystemBody& b) {
      return a.name == b.name && is_same_body(a.file, b.file) && a.body.num_modes() == b.body.num_modes();
    };
    if (!std::equal(bodies.begin(), bodies.end(), of_system.begin(), of_system.end(), is_same))
      throw InputError("select.other-bodies", {system},
                       "its flexible bodies are not those of " + o.systems.front() + " by name, file and modes",
                       "rank systems of the same bodies together, others by separate calls");
  }
  return bodies;
}

std::vector<Weighing> weigh_in_systems(const SelectRequest& o, const std::vector<SystemBody>& bodies,
                                       Diagnostics& diagnostics) {
  ModeUses uses;
  for (const auto& one : bodies)
    for (int mode = 0; mode < one.body.num_modes(); ++mode) uses.push_back({{one.name, mode}});
  return weigh_everywhere(
      o, [&](const SystemPlant&) { return uses; }, diagnostics);
}

}  // namespace bough::analysis
