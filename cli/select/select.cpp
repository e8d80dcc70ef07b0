#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>

#include "cli/common/console.hpp"
#include "cli/common/options.hpp"
#include "cli/common/usage_text.hpp"
#include "cli/select/system_plant.hpp"
#include "cli/verbs.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/records/mode_subset.hpp"
#include "formats/toml/specs.hpp"
#include "solver/statespace/cost.hpp"
#include "solver/statespace/mode_ranking.hpp"

namespace bough::cli {

using statespace::ModeRanking;
using statespace::NodeDirection;

namespace {

struct SelectOptions : CommonOptions {
  std::vector<std::string> set;
  std::string body, system;
  std::vector<std::string> inputs, outputs;
  int number = 0;
  std::optional<double> tolerance;
  double below_hz = 0, damping = 0.01;
  std::optional<double> at;
  bool equilibrium = false;
};

constexpr double kDefaultTolerance = 0.01;
const std::vector<std::string> kDirections{"x", "y", "z", "rx", "ry", "rz"};

/// "12" (its three translations) or "12:z".
std::vector<NodeDirection> read_place(const records::FlexBody& body, const std::string& word, const std::string& file) {
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
  const auto found = std::find(kDirections.begin(), kDirections.end(), word.substr(colon + 1));
  if (found == kDirections.end()) {
    throw InputError("select.unknown-direction", {file}, "\"" + word + "\" names no direction",
                     "write NODE, or NODE:x, y, z, rx, ry or rz");
  }
  return {{id, static_cast<int>(found - kDirections.begin()) + 1}};
}

/// Named places, else the translations of the interface nodes that move, else of all nodes.
std::vector<NodeDirection> choose_places(const records::FlexBody& body, const std::vector<std::string>& words,
                                         const std::string& file) {
  std::vector<NodeDirection> places;
  for (const auto& word : words)
    for (const auto& place : read_place(body, word, file)) places.push_back(place);
  if (!places.empty()) return places;
  for (const auto* ids : {&body.interface_nodes, &body.node_id}) {
    for (const int id : *ids) {
      const auto& phi = body.phi[static_cast<std::size_t>(body.find_node(id))];
      if (phi.topRows(3).isZero(0)) continue;
      for (int direction = 1; direction <= 3; ++direction) places.push_back({id, direction});
    }
    if (!places.empty()) break;
  }
  return places;
}

/// Full model and costs; how the modes kept do instead.
struct Weighing {
  ModeRanking ranking;
  statespace::StateSpace full;
  std::function<statespace::StateSpace(const std::vector<int>&)> reduce;
};

Weighing weigh_alone(const SelectOptions& o, const records::FlexBody& body, const std::vector<NodeDirection>& inputs,
                     const std::vector<NodeDirection>& outputs) {
  const double damping = o.damping;
  return {statespace::rank_modes(body, inputs, outputs, damping),
          statespace::make_state_space(body, inputs, outputs, damping),
          [&body, inputs, outputs, damping](const std::vector<int>& kept) {
            return statespace::make_state_space(records::keep_modes(body, kept), inputs, outputs, damping);
          }};
}

/// The modes of `file` in the linear model of a whole system; those of several bodies from one file add up.
Weighing weigh_in_system(const SelectOptions& o, const records::FlexBody& body, Diagnostics& diagnostics) {
  const auto plant = std::make_shared<SystemPlant>(
      o.system, o.body, OperatingChoice{o.at, o.equilibrium, o.inputs, o.outputs, o.set}, diagnostics);
  const auto model = plant->linearize(diagnostics);
  if (model.inputs.size() == 0 || model.outputs.size() == 0) {
    throw InputError("select.no-signals", {o.system}, "the system has no [[force]] or no [[sensor]] to weigh modes by",
                     "add them, or name hinges with --inputs");
  }
  if (!model.D.isZero(0))
    diagnostics.note("select.feedthrough", {o.system},
                     "an output follows an input at once: only what the states bring to it is counted");
  for (int k = 0; k < model.poles.size(); ++k) {
    const double size = std::hypot(model.poles.real[k], model.poles.imag[k]);
    if (size <= 1e-6 * model.poles.frequency_hz.maxCoeff() * 2 * M_PI || model.poles.real[k] < -1e-11 * size) continue;
    throw ComputationError(
        "select.unstable", {o.system},
        fmt::format("the pole {:.3g} ± {:.4g} i of {} does not decay: the outputs grow without limit "
                    "and no mode can be ranked",
                    model.poles.real[k], std::abs(model.poles.imag[k]), model.poles.mode[static_cast<std::size_t>(k)]),
        "give it damping, or choose a stable state");
  }
  const auto cost = statespace::calc_component_cost(model.A, model.B, model.C);
  Weighing w{{}, {model.A, model.B, model.C}, [plant](const std::vector<int>& kept) {
               const auto reduced = plant->linearize_with(kept);
               return statespace::StateSpace{reduced.A, reduced.B, reduced.C};
             }};
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
  return w;
}

struct Selection {
  ModeRanking ranking;
  std::vector<statespace::Choice> choices;
  std::vector<int> kept;
  double dropped = 0, static_error = -1;  ///< dropped: part of V
  double lost = 0;                        ///< mean square of what the outputs lose, to V
};

std::vector<int> list_kept(const std::vector<statespace::Choice>& choices) {
  std::vector<int> kept;
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (choices[i].kept) kept.push_back(static_cast<int>(i));
  return kept;
}

/// Costs of either sign cancel: the tolerance is held to what the outputs lose.
void hold_tolerance(const Weighing& w, double tolerance, Selection& s) {
  const auto calc_lost = [&](const std::vector<int>& kept) {
    if (kept.size() == s.choices.size() || !(w.ranking.total > 0)) return 0.0;
    if (kept.empty()) return 1.0;
    return statespace::calc_mean_square_difference(w.full, w.reduce(kept)) / w.ranking.total;
  };
  s.kept = list_kept(s.choices);
  s.lost = calc_lost(s.kept);
  std::size_t fits = 0, dropped = 0;
  for (const auto& choice : s.choices) dropped += choice.within_tolerance ? 1 : 0;
  if (dropped == 0 || s.lost <= tolerance) return;
  const auto all = s.choices;
  for (std::size_t too_many = dropped; too_many - fits > 1;) {
    const std::size_t middle = fits + (too_many - fits) / 2;
    auto choices = all;
    statespace::keep_dearest(w.ranking, middle, choices);
    (calc_lost(list_kept(choices)) <= tolerance ? fits : too_many) = middle;
  }
  statespace::keep_dearest(w.ranking, fits, s.choices);
  s.kept = list_kept(s.choices);
  s.lost = calc_lost(s.kept);
}

nlohmann::json make_json(const records::FlexBody& body, const Selection& s) {
  auto modes = nlohmann::json::array();
  for (int i = 0; i < body.num_modes(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto& mode = s.ranking.modes[k];
    modes.push_back({{"mode", i + 1},
                     {"frequency_hz", body.frequency_hz[i]},
                     {"cost", mode.cost},
                     {"share", s.ranking.total > 0 ? mode.cost / s.ranking.total : 0},
                     {"closed_form", mode.closed_form},
                     {"kept", s.choices[k].kept},
                     {"reason", s.choices[k].reason}});
  }
  nlohmann::json json{{"modes", modes},
                      {"total_cost", s.ranking.total},
                      {"other_cost", s.ranking.other},
                      {"dropped_share", s.dropped},
                      {"lost_share", s.lost}};
  if (s.static_error >= 0) json["static_error"] = s.static_error;
  return json;
}

std::string format(const records::FlexBody& body, const Selection& s) {
  Table table{{"mode", "frequency Hz", "cost", "share %", "kept", "reason"}, {}};
  for (int i = 0; i < body.num_modes(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double cost = s.ranking.modes[k].cost;
    table.rows.push_back({std::to_string(i + 1), fmt::format("{:.6g}", body.frequency_hz[i]),
                          fmt::format("{:.4g}", cost),
                          fmt::format("{:.3g}", s.ranking.total > 0 ? 100 * cost / s.ranking.total : 0),
                          s.choices[k].kept ? "yes" : "no", s.choices[k].reason});
  }
  auto text = table.to_text() + fmt::format("\ntotal cost {:.6g}", s.ranking.total);
  if (s.ranking.other != 0) text += fmt::format(", of it {:.4g} by the rest of the system", s.ranking.other);
  text += fmt::format("\n{} kept, {} dropped with {:.3g} % of the cost", count(s.kept.size(), "mode"),
                      static_cast<std::size_t>(body.num_modes()) - s.kept.size(), 100 * s.dropped);
  text += fmt::format("; the outputs lose {:.3g} % (mean square)", 100 * s.lost);
  if (s.static_error >= 0) text += fmt::format(", static response off by {:.3g} %", 100 * s.static_error);
  return text + "\n";
}

int run_select(const SelectOptions& o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  demand_file(o.body);
  std::vector<std::string> sources{o.body};
  if (!o.system.empty()) {
    demand_file(o.system);
    demand_kind(o.system, toml_files::detect_kind(o.system), "system");
    sources.push_back(o.system);
  }
  if (!o.output.empty()) check_output(o, o.output, sources);
  Diagnostics diagnostics;
  const auto body = hdf5::read_flex_body(o.body);
  Selection s;
  Weighing weighing;
  std::vector<NodeDirection> inputs, outputs;
  if (o.system.empty()) {
    inputs = choose_places(body, o.inputs, o.body);
    outputs = choose_places(body, o.outputs, o.body);
    if (inputs.empty() || outputs.empty()) {
      throw InputError("select.no-signals", {o.body}, "no output node of the body moves: nothing to weigh its modes by",
                       "reduce the body with output nodes that its modes move");
    }
    weighing = weigh_alone(o, body, inputs, outputs);
  } else {
    weighing = weigh_in_system(o, body, diagnostics);
  }
  s.ranking = weighing.ranking;
  const double tolerance = o.tolerance.value_or(kDefaultTolerance);
  const bool by_cost = o.below_hz == 0 || o.number > 0 || o.tolerance;
  s.choices = statespace::choose_modes(body, s.ranking, {o.number, tolerance, o.below_hz, by_cost});
  hold_tolerance(weighing, tolerance, s);
  for (std::size_t i = 0; i < s.choices.size(); ++i)
    if (!s.choices[i].kept && s.ranking.total > 0) s.dropped += s.ranking.modes[i].cost / s.ranking.total;
  if (o.system.empty() && !s.kept.empty())
    s.static_error = statespace::calc_static_error(body, s.kept, inputs, outputs);
  console.print(diagnostics);
  if (o.json)
    console.print_data(make_json(body, s).dump(2) + "\n");
  else
    console.print(format(body, s));
  if (o.output.empty()) return kSuccess;
  if (s.kept.empty())
    throw InputError("select.nothing-kept", {o.body}, "no mode would be left", "keep more, by --number or --below");
  auto small = records::keep_modes(body, s.kept);
  const auto more = calc_sources(sources);
  small.source.insert(small.source.end(), more.begin(), more.end());
  hdf5::write_flex_body(small, o.output);
  if (!o.json) console.print("written: " + o.output + "\n");
  return kSuccess;
}

}  // namespace

void add_select(CLI::App& app, Action& action) {
  auto o = std::make_shared<SelectOptions>();
  auto* verb = app.add_subcommand("select", "Ranks the modes of a body by component cost and picks those to keep");
  verb->add_option("body", o->body, "Flexible-body HDF5 file")->required();
  verb->add_option("system", o->system, "System file (.toml) with its forces and sensors; without, the body alone");
  verb->add_option("--inputs", o->inputs,
                   "Nodes that are pushed, ID or ID:x, y, z, rx, ry, rz (default: interface); of a system: its forces")
      ->delimiter(',');
  verb->add_option("--outputs", o->outputs, "Nodes whose motion counts, as above; of a system: its sensors")
      ->delimiter(',');
  verb->add_option("-n,--number", o->number, "Keep so many modes")->check(make_positive());
  verb->add_option("--tolerance", o->tolerance,
                   "Drop modes without which the outputs lose at most this part of their mean square (default: 0.01)")
      ->check(CLI::Range(0.0, 1.0));
  verb->add_option("--below", o->below_hz, "Drop modes above this frequency")->check(CLI::PositiveNumber);
  verb->add_option("--damping", o->damping, "Damping ratio of modes that have none (default: 0.01)")
      ->check(CLI::PositiveNumber);
  verb->add_option("--at", o->at, "With a system: weigh the modes at this time of its run");
  verb->add_flag("--equilibrium", o->equilibrium, "With a system: at its state of rest or steady spin");
  add_set_option(*verb, o->set);
  add_common_options(*verb, *o, kOutput | kJson, "Write the body with the modes kept to this HDF5 file");
  verb->footer(
      "Example:\n  bough select panel.h5 --number 12 -o small.h5\n"
      "  bough select panel.h5 satellite.toml --tolerance 0.001 -o small.h5");
  verb->callback([&action, o] { action = [o] { return blame(o->body, [&] { return run_select(*o); }); }; });
}

}  // namespace bough::cli
