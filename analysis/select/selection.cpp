#include "analysis/select/selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/common/body_files.hpp"
#include "analysis/common/choices.hpp"
#include "analysis/common/inputs.hpp"
#include "formats/records/mode_subset.hpp"
#include "formats/toml/specs.hpp"
#include "solver/statespace/frequency_response.hpp"
#include "solver/statespace/hankel.hpp"
#include "solver/statespace/poles.hpp"

namespace bough::analysis {

using Eigen::Index;
using statespace::StateSpace;

namespace {

constexpr double kDefaultTolerance = 0.01;

std::vector<int> list_kept(const std::vector<statespace::Choice>& choices) {
  std::vector<int> kept;
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (choices[i].kept) kept.push_back(static_cast<int>(i));
  return kept;
}

/// Costs of either sign cancel: the tolerance is held to what the outputs lose, in every configuration.
void hold_tolerance(const records::FlexBody& body, const std::vector<Weighing>& weighings, double tolerance,
                    Selection& s) {
  const auto calc_lost = [&](const std::vector<int>& kept) {
    double worst = 0;
    for (const auto& w : weighings) worst = std::max(worst, w.calc_lost(kept));
    return worst;
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
    statespace::keep_dearest(body, s.ranking, middle, choices);
    (calc_lost(list_kept(choices)) <= tolerance ? fits : too_many) = middle;
  }
  statespace::keep_dearest(body, s.ranking, fits, s.choices);
  s.kept = list_kept(s.choices);
  s.lost = calc_lost(s.kept);
}

/// R of m = Q R, with no more rows than columns.
Eigen::MatrixXd take_triangle(const Eigen::MatrixXd& m) {
  if (m.rows() <= m.cols()) return m;
  const Eigen::HouseholderQR<Eigen::MatrixXd> factor(m);
  return factor.matrixQR().topRows(m.cols()).triangularView<Eigen::Upper>();
}

/// A body has forces and outputs at each of its nodes, and few states: with B = Rᵀ Qᵀ and C = Q R the gains are those
/// of Rᵀ and R.
StateSpace compress(const StateSpace& s) {
  return {s.A, take_triangle(s.B.transpose()).transpose(), take_triangle(s.C)};
}

/// The part that decays: poles at 0 and what grows left out, so that gains are finite. Of the gains singular values and
/// norm are kept.
records::LinearModel make_decaying(const StateSpace& whole) {
  const StateSpace s = compress(whole);
  const auto part = statespace::split_stable(s.A, true);
  const Eigen::MatrixXd P = (part.U * part.L).real();
  records::LinearModel model;
  model.A = s.A;
  model.B = P * s.B;
  model.C = s.C * P;
  model.D = Eigen::MatrixXd::Zero(s.C.rows(), s.B.cols());
  for (Index i = 0; i < s.A.rows(); ++i) model.states.name.push_back(std::to_string(i));
  for (Index i = 0; i < s.B.cols(); ++i) model.inputs.name.push_back(std::to_string(i));
  for (Index i = 0; i < s.C.rows(); ++i) model.outputs.name.push_back(std::to_string(i));
  model.poles = statespace::calc_poles(model.A, model.states.name);
  return model;
}

double calc_norm_at_rest(const records::LinearModel& model) {
  const statespace::TransferMatrix transfer(model.A, model.B, model.C, model.D);
  // The response at 0, which is finite for the stable part; taken at a small offset from poles at 0.
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (Index i = 0; i < model.poles.size(); ++i)
    high = std::max(high, std::hypot(model.poles.real[i], model.poles.imag[i]));
  for (Index i = 0; i < model.poles.size(); ++i) {
    const double size = std::hypot(model.poles.real[i], model.poles.imag[i]);
    if (size > 1e-6 * high) low = std::min(low, size);
  }
  return transfer.calc({0, std::isfinite(low) ? 1e-3 * low : 1}).norm();
}

Loss weigh_loss(const Weighing& w, const std::vector<int>& kept) {
  Loss loss;
  loss.name = w.name;
  loss.total = w.ranking.total;
  loss.other = w.ranking.other;
  loss.lost = w.calc_lost(kept);
  const auto full = make_decaying(w.full);
  const auto response = statespace::calc_frequency_response(full, {0, 0, 200, 1500});
  loss.peak = statespace::calc_peak_gain(full, response).value;
  if (kept.empty()) return loss;
  const auto reduced = w.reduce(kept);
  const auto difference = make_decaying(statespace::subtract(w.full, reduced));
  const auto peak =
      statespace::calc_peak_gain(difference, statespace::calc_frequency_response(difference, {0, 0, 200, 1500}));
  loss.error = peak.value;
  loss.error_hz = peak.frequency_hz;
  const auto hankel = statespace::calc_hankel(w.full.A, w.full.B, w.full.C);
  loss.balanced_bound =
      statespace::calc_truncation_bound(hankel.value, static_cast<int>(reduced.A.rows()) - hankel.num_left_out);
  const double size = calc_norm_at_rest(full);
  loss.steady_error = size > 0 ? calc_norm_at_rest(difference) / size : 0;
  const auto small = make_decaying(reduced);
  const statespace::TransferMatrix after(small.A, small.B, small.C, small.D),
      apart(difference.A, difference.B, difference.C, difference.D);
  const Index count = response.frequency_hz.size();
  loss.frequency_hz = response.frequency_hz;
  loss.before = response.singular_values.col(0);
  loss.after.resize(count);
  loss.difference.resize(count);
  for (Index k = 0; k < count; ++k) {
    const std::complex<double> s(0, 2 * M_PI * response.frequency_hz[k]);
    loss.after[k] = Eigen::JacobiSVD<Eigen::MatrixXcd>(after.calc(s)).singularValues()[0];
    loss.difference[k] = Eigen::JacobiSVD<Eigen::MatrixXcd>(apart.calc(s)).singularValues()[0];
  }
  return loss;
}

/// Warns if the outputs lose more than half, or if more modes are kept than requested.
void warn_of_losses(const SelectRequest& o, const Selection& s, Diagnostics& diagnostics) {
  if (o.number > 0 && static_cast<int>(s.kept.size()) > o.number)
    diagnostics.warning("select.always-kept", {o.body},
                        "--number " + std::to_string(o.number) + ", and " + std::to_string(s.kept.size()) +
                            " modes are kept: static shapes and those of --keep always are",
                        "ask for more modes than those, or reduce the body without residual vectors");
  if (s.lost > 0.5 && !s.kept.empty())
    diagnostics.warning("select.most-is-lost", {o.body},
                        "the modes kept lose " + std::to_string(std::lround(100 * s.lost)) +
                            " % of what the outputs do: they are no model of the body",
                        "keep more modes, or weigh them by the inputs and outputs that matter");
}

Selection choose_kept(const SelectRequest& o, const records::FlexBody& body, const std::vector<Weighing>& weighings) {
  Selection s;
  std::vector<statespace::ModeRanking> rankings;
  for (const auto& w : weighings) rankings.push_back(w.ranking);
  s.ranking = statespace::combine_worst(rankings);
  const double tolerance = o.tolerance.value_or(kDefaultTolerance);
  const bool by_cost = o.below_hz == 0 || o.number > 0 || o.tolerance;
  std::vector<int> pinned;
  for (const int mode : o.pinned) {
    if (mode < 1 || mode > body.num_modes())
      throw InputError("select.unknown-mode", {o.body},
                       fmt::format("--keep {}: the body has modes 1 to {}", mode, body.num_modes()),
                       "name modes as select numbers them");
    pinned.push_back(mode - 1);
  }
  s.choices = statespace::choose_modes(body, s.ranking, {o.number, tolerance, o.below_hz, by_cost, pinned});
  hold_tolerance(body, weighings, tolerance, s);
  for (std::size_t i = 0; i < s.choices.size(); ++i)
    if (!s.choices[i].kept && s.ranking.total > 0) s.dropped += s.ranking.modes[i].cost / s.ranking.total;
  return s;
}

}  // namespace

std::vector<std::string> list_select_inputs(const SelectRequest& request) {
  demand_body_file(request.body);
  std::vector<std::string> files{get_body_path(request.body)};
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
  demand_range("--number", request.number, 0, std::numeric_limits<int>::max());
  if (request.tolerance) demand_range("--tolerance", *request.tolerance, 0.0, 1.0);
  demand_positive("--below", request.below_hz, true);
  demand_positive("--damping", request.damping);
  for (const double time : request.at) demand_finite("--at", time);
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
    weighings = weigh_in_systems(request, body, diagnostics);
  }
  Selection s = choose_kept(request, body, weighings);
  if (request.systems.empty()) {
    if (!s.kept.empty()) s.static_error = statespace::calc_static_error(body, s.kept, inputs, outputs);
    s.modal_hankel = statespace::calc_modal_hankel(body, inputs, outputs, request.damping);
  }
  for (const auto& w : weighings) s.losses.push_back(weigh_loss(w, s.kept));
  warn_of_losses(request, s, diagnostics);
  if (!body.third_order.empty() && s.kept.size() < static_cast<std::size_t>(body.num_modes()))
    diagnostics.warning("select.third-order", {request.body},
                        "the third order of the body is of all its modes: the body with fewer has second order",
                        "reduce the deck again with [body.modes] select, to keep third order");
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
