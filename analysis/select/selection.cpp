#include "analysis/select/selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "analysis/common/body_files.hpp"
#include "analysis/common/choices.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/select/exchange.hpp"
#include "analysis/select/system_weighing.hpp"
#include "formats/records/mode_subset.hpp"
#include "formats/toml/specs.hpp"

namespace bough::analysis {

namespace {

constexpr double kDefaultTolerance = 0.01;

std::vector<int> list_kept(const std::vector<statespace::Choice>& choices) {
  std::vector<int> kept;
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (choices[i].kept) kept.push_back(static_cast<int>(i));
  return kept;
}

/// Costs of either sign cancel: the tolerance is held to what the outputs lose, in every configuration.
void hold_tolerance(const std::vector<statespace::ModeTraits>& traits, const std::vector<Weighing>& weighings,
                    double tolerance, Selection& s) {
  s.kept = list_kept(s.choices);
  s.lost = calc_lost(weighings, s.kept);
  std::size_t fits = 0, dropped = 0;
  for (const auto& choice : s.choices) dropped += choice.within_tolerance ? 1 : 0;
  if (dropped == 0 || s.lost <= tolerance) return;
  const auto all = s.choices;
  for (std::size_t too_many = dropped; too_many - fits > 1;) {
    const std::size_t middle = fits + (too_many - fits) / 2;
    auto choices = all;
    statespace::keep_dearest(traits, s.ranking, middle, choices);
    (calc_lost(weighings, list_kept(choices)) <= tolerance ? fits : too_many) = middle;
  }
  statespace::keep_dearest(traits, s.ranking, fits, s.choices);
  s.kept = list_kept(s.choices);
  s.lost = calc_lost(weighings, s.kept);
}

/// Warns if the outputs lose more than half, or if more modes are kept than requested.
void warn_of_losses(const SelectRequest& o, const std::string& file, const Selection& s, Diagnostics& diagnostics) {
  if (o.number > 0 && static_cast<int>(s.kept.size()) > o.number)
    diagnostics.warning("select.always-kept", {file},
                        "--number " + std::to_string(o.number) + ", and " + std::to_string(s.kept.size()) +
                            " modes are kept: static shapes and those of --keep always are",
                        "ask for more modes than those, or reduce the body without residual vectors");
  if (s.lost > 0.5 && !s.kept.empty())
    diagnostics.warning("select.most-is-lost", {file},
                        "the modes kept lose " + std::to_string(std::lround(100 * s.lost)) +
                            " % of what the outputs do: they are no model of the body",
                        "keep more modes, or weigh them by the inputs and outputs that matter");
}

Selection choose_kept(const SelectRequest& o, const RankedModes& modes, const std::vector<Weighing>& weighings,
                      Events& events) {
  Selection s;
  std::vector<statespace::ModeRanking> rankings;
  for (const auto& w : weighings) rankings.push_back(w.ranking);
  s.ranking = statespace::combine_worst(rankings);
  const double tolerance = o.tolerance.value_or(kDefaultTolerance);
  const bool by_cost = o.below_hz == 0 || o.number > 0 || o.tolerance;
  std::vector<int> pinned;
  for (const auto& word : o.pinned) {
    const auto found = std::find(modes.names.begin(), modes.names.end(), word);
    if (found == modes.names.end())
      throw InputError(
          "select.unknown-mode", {modes.file},
          fmt::format("--keep {}: there are modes {} to {}", word, modes.names.front(), modes.names.back()),
          "name modes as select numbers them: 3, of a system boom:3");
    pinned.push_back(static_cast<int>(found - modes.names.begin()));
  }
  s.choices = statespace::choose_modes(modes.traits, s.ranking, {o.number, tolerance, o.below_hz, by_cost, pinned});
  hold_tolerance(modes.traits, weighings, tolerance, s);
  if (o.exchange && by_cost)
    exchange_modes(weighings, o.number == 0 ? std::optional<double>(tolerance) : std::nullopt, events, s);
  for (std::size_t i = 0; i < s.choices.size(); ++i)
    if (!s.choices[i].kept && s.ranking.total > 0) s.dropped += s.ranking.modes[i].cost / s.ranking.total;
  return s;
}

}  // namespace

Selection choose_and_measure(const SelectRequest& request, const RankedModes& modes,
                             const std::vector<Weighing>& weighings, Events& events, Diagnostics& diagnostics) {
  Selection s = choose_kept(request, modes, weighings, events);
  for (const auto& w : weighings) s.losses.push_back(weigh_loss(w, s.kept));
  warn_of_losses(request, modes.file, s, diagnostics);
  return s;
}

void warn_of_lost_order(const records::FlexBody& body, const std::string& file, Diagnostics& diagnostics) {
  if (!body.third_order.empty())
    diagnostics.warning("select.third-order", {file},
                        "the third order of the body is of all its modes: the body with fewer has second order",
                        "reduce the deck again with [body.modes] select, to keep third order");
}

void demand_select_numbers(const SelectRequest& request) {
  demand_range("--number", request.number, 0, std::numeric_limits<int>::max());
  if (request.tolerance) demand_range("--tolerance", *request.tolerance, 0.0, 1.0);
  demand_positive("--below", request.below_hz, true);
  demand_positive("--damping", request.damping);
  for (const double time : request.at) demand_finite("--at", time);
}

std::vector<std::string> list_select_inputs(const SelectRequest& request) {
  std::vector<std::string> files;
  if (!request.body.empty()) {
    demand_body_file(request.body);
    files.push_back(get_body_path(request.body));
  }
  for (const auto& system : request.systems) {
    demand_file(system);
    demand_kind(system, toml_files::detect_kind(system), "system");
    files.push_back(system);
  }
  if (!request.spectrum.empty()) files.push_back(request.spectrum);
  return files;
}

Selection select_modes(const SelectRequest& request, const records::FlexBody& body, Events& events,
                       Diagnostics diagnostics) {
  demand_select_numbers(request);
  std::vector<Weighing> weighings;
  std::vector<statespace::NodeDirection> inputs, outputs;
  if (request.systems.empty()) {
    inputs = choose_places(body, request.inputs, request.weights, false, request.body);
    outputs = choose_places(body, request.outputs, request.weights, true, request.body);
    if (inputs.empty() || outputs.empty()) {
      throw InputError("select.no-signals", {request.body},
                       "no output node of the body moves: nothing to weigh its modes by",
                       "reduce the body with output nodes that its modes move");
    }
    weighings.push_back(weigh_alone(request, body, inputs, outputs));
  } else {
    weighings = weigh_in_systems(request, diagnostics);
  }
  RankedModes modes{request.body, {}, {}};
  statespace::add_traits(body, 0, modes.traits);
  for (int i = 1; i <= body.num_modes(); ++i) modes.names.push_back(std::to_string(i));
  Selection s = choose_and_measure(request, modes, weighings, events, diagnostics);
  if (request.systems.empty()) {
    if (!s.kept.empty()) s.static_error = statespace::calc_static_error(body, s.kept, inputs, outputs);
    s.modal_hankel = statespace::calc_modal_hankel(body, inputs, outputs, request.damping);
  }
  if (s.kept.size() < static_cast<std::size_t>(body.num_modes())) warn_of_lost_order(body, request.body, diagnostics);
  add_messages(diagnostics, events);
  return s;
}

records::FlexBody keep_selected(const SelectRequest& request, const records::FlexBody& body, const Selection& selection,
                                const std::vector<std::string>& files) {
  if (selection.kept.empty())
    throw InputError("select.nothing-kept", {request.body}, "no mode would be left",
                     "keep more, by --number or --below");
  auto small = records::keep_modes(body, selection.kept);
  const auto more = calc_sources(files);
  small.source.insert(small.source.end(), more.begin(), more.end());
  return small;
}

}  // namespace bough::analysis
