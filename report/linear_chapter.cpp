#include "report/linear_chapter.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>
#include <numbers>

#include "formats/records/unit_names.hpp"
#include "report/bode_plot.hpp"
#include "report/budget_plot.hpp"
#include "report/html.hpp"
#include "report/label.hpp"
#include "report/pack.hpp"
#include "report/pole_plot.hpp"

namespace bough::report {

namespace {

using nlohmann::json;

constexpr std::size_t kMaxDiagrams = 6, kMaxPairs = 24;
constexpr double kUndamped = 1e-7;  // damping ratio, below which rounding decides whether a pole decays

std::string make_poles(const records::LinearModel& model) {
  Plot plot = make_pole_plot({{"", &model}});
  plot.title = "Poles and zeros";
  const records::Poles poles = round_poles(model.poles);
  const auto frequency = label_frequency(model.units.time), unit = records::name_frequency_unit(model.units.time);
  HtmlTable table("Poles", {{"real"}, {"imaginary"}, {frequency}, {"damping %"}, {"coordinate", true}});
  int num_gone = 0;
  for (Eigen::Index i = 0; i < poles.real.size(); ++i) {
    if (records::is_gone(model, i)) {
      ++num_gone;
      continue;
    }
    table.add_row({format_value(poles.real[i]), format_value(poles.imag[i]), format_value(poles.frequency_hz[i]),
                   format_value(100 * poles.damping[i], 4), poles.mode[static_cast<std::size_t>(i)]});
  }
  std::string html = make_figure(plot, "poles") + table.to_html(400);
  if (num_gone > 0)
    html += make_text(fmt::format("{} {} at z = 0: gone within a sample.", num_gone, num_gone == 1 ? "pole" : "poles"),
                      "note");
  if (!model.aliased.empty()) {
    HtmlTable aliased(
        fmt::format("Modes above the Nyquist frequency {} {}: aliased", format_value(0.5 / model.sample_time, 4), unit),
        {{"mode", true}, {frequency}, {make_label("appears at", unit)}});
    for (const auto& one : model.aliased)
      aliased.add_row({one.mode, format_value(one.frequency_hz), format_value(one.appears_at_hz)});
    html += aliased.to_html(400);
  }
  if (model.has_zeros && model.zeros_real.size() > 0) {
    HtmlTable zeros("Transmission zeros", {{"real"}, {"imaginary"}});
    for (Eigen::Index i = 0; i < model.zeros_real.size(); ++i)
      zeros.add_row({format_value(model.zeros_real[i]), format_value(model.zeros_imag[i])});
    html += zeros.to_html(400);
  }
  return html;
}

/// Diagrams of one pair, with the margins of a loop.
std::vector<Plot> make_bode_plots(const LinearFindings& findings, const BodePair& pair) {
  const auto& frequency = findings.response.frequency_hz;
  auto plots = make_bode_axes(findings.response.units.time);
  add_bode_curve(pair, frequency, "", plots);
  if (findings.has_margins) add_margins(findings.margins, pair, findings.response, plots);
  plots[0].title = pair.name;
  return plots;
}

std::string make_bode(const LinearFindings& findings, const std::vector<BodePair>& pairs) {
  const auto& response = findings.response;
  std::string html = "<div class=\"live\" data-view=\"bode\">\n";
  for (std::size_t p = 0; p < std::min(kMaxDiagrams, pairs.size()); ++p)
    html += make_figure(make_bode_plots(findings, pairs[p]));
  html += "</div>\n";
  const auto all = static_cast<std::size_t>(response.inputs.size()) * static_cast<std::size_t>(response.outputs.size());
  if (all > pairs.size()) html += make_text(fmt::format("The first {} of {} pairs.", pairs.size(), all), "note");
  return html;
}

std::string make_singular_values(const LinearFindings& findings) {
  auto plot = make_sigma_plot(findings.response, "");
  plot.title = "Singular values of the transfer matrix";
  if (plot.curves.size() > 6) plot.curves.resize(6);
  return make_figure(plot);
}

std::string make_margins(const records::Margins& m, const std::string& time) {
  HtmlTable table(
      "The loop, with negative feedback",
      {{"margin", true}, {label_frequency(time)}, {"dB or degrees"}, {make_label("delay", time.empty() ? "T" : time)}});
  for (const auto& c : m.gain)
    table.add_row({"gain", format_value(c.frequency_hz), format_value(20 * std::log10(c.margin), 5), ""});
  for (const auto& c : m.phase)
    table.add_row({"phase", format_value(c.frequency_hz), format_value(c.margin * 180 / std::numbers::pi, 5),
                   format_value(c.delay, 5)});
  return table.to_html(400);
}

std::string make_hankel(const records::Hankel& hankel) {
  HtmlTable table("", {{"number"}, {"Hankel singular value"}});
  for (Eigen::Index i = 0; i < hankel.value.size(); ++i)
    table.add_row({std::to_string(i + 1), format_value(hankel.value[i])});
  std::string html =
      "<details><summary>" + std::to_string(hankel.value.size()) + "</summary>\n" + table.to_html(400) + "</details>\n";
  if (hankel.num_left_out > 0)
    html += make_text(fmt::format("Of the stable part; {} other poles are left out.", hankel.num_left_out), "note");
  return html;
}

/// Stability, gain, Bode diagrams, singular values, margins.
void add_response(const LinearFindings& findings, const std::vector<BodePair>& pairs, Chapter& chapter) {
  if (findings.has_margins)
    chapter.checks.push_back({"with the loop closed", findings.margins.is_stable ? "stable" : "unstable",
                              findings.margins.is_stable ? Verdict::Good : Verdict::Warning,
                              "largest real part " + format_value(findings.margins.largest_real, 4)});
  if (!pairs.empty()) {
    chapter.checks.push_back({"largest gain", findings.peak.is_finite ? format_value(findings.peak.value) : "infinite",
                              Verdict::None,
                              findings.peak.is_finite ? "at " + format_value(findings.peak.frequency_hz) + " " +
                                                            records::name_frequency_unit(findings.response.units.time)
                                                      : findings.peak.why});
    chapter.add_panel("bode", "Bode", make_bode(findings, pairs));
    chapter.add_panel("sigma", "Singular values", make_singular_values(findings));
  }
  if (findings.has_margins)
    chapter.add_panel("margins", "Margins", make_margins(findings.margins, findings.response.units.time));
}

json to_list(const Eigen::VectorXd& values) {
  json list = json::array();
  for (const double v : values) list.push_back(std::isfinite(v) ? json(v) : json());
  return list;
}

/// Every pole of the table, with its point in the plane of make_pole_plot (x, y) and its number in the model.
json list_poles(const records::LinearModel& model) {
  const auto poles = round_poles(model.poles);
  json list{{"real", json::array()},    {"imag", json::array()}, {"x", json::array()},
            {"y", json::array()},       {"mode", json::array()}, {"frequency", json::array()},
            {"damping", json::array()}, {"index", json::array()}};
  for (Eigen::Index i = 0; i < poles.real.size(); ++i) {
    if (records::is_gone(model, i)) continue;
    const std::complex<double> s(poles.real[i], poles.imag[i]);
    const auto point = model.sample_time > 0 ? records::calc_z(model, i) : s;
    for (const auto& [key, value] :
         {std::pair("real", s.real()), std::pair("imag", s.imag()), std::pair("x", point.real()),
          std::pair("y", point.imag()), std::pair("frequency", poles.frequency_hz[i]),
          std::pair("damping", poles.damping[i])})
      list[key].push_back(std::isfinite(value) ? json(value) : json());
    list["mode"].push_back(poles.mode[static_cast<std::size_t>(i)]);
    list["index"].push_back(i);
  }
  return list;
}

/// Labels, guides and notes of the plane.
json make_plane(const records::LinearModel& model) {
  const auto plot = make_pole_plot({{"", &model}});
  json guides = json::array(), notes = json::array();
  for (const auto& guide : plot.guides)
    guides.push_back({{"label", guide.label}, {"x", to_list(guide.x)}, {"y", to_list(guide.y)}});
  for (const auto& note : plot.notes) notes.push_back({{"x", note.x}, {"y", note.y}, {"text", note.text}});
  return {{"x_label", plot.x_label},
          {"y_label", plot.y_label},
          {"equal", plot.is_equal},
          {"guides", std::move(guides)},
          {"notes", std::move(notes)}};
}

/// Three numbers that judge the model: stability, the pole with the smallest damping, a margin or the largest gain.
void add_highlights(const records::LinearModel& model, const LinearFindings& findings, int unstable, Chapter& chapter) {
  auto& highlights = chapter.highlights;
  const std::string unit = records::name_frequency_unit(model.units.time);
  const auto poles = round_poles(model.poles);
  if (unstable > 0) highlights.push_back({"poles in the right half plane", std::to_string(unstable), ""});
  Eigen::Index weakest = -1, lowest = -1;
  for (Eigen::Index i = 0; i < poles.real.size(); ++i) {
    if (records::is_gone(model, i) || !(poles.imag[i] > 0)) continue;
    if (weakest < 0 || poles.damping[i] < poles.damping[weakest]) weakest = i;
    if (lowest < 0 || poles.frequency_hz[i] < poles.frequency_hz[lowest]) lowest = i;
  }
  const auto get_mode = [&](Eigen::Index i) {
    const auto& mode = poles.mode[static_cast<std::size_t>(i)];
    return mode.empty() ? "" : ", " + mode;
  };
  const auto format_ratio = [&](Eigen::Index i) {
    const bool is_undamped = std::abs(poles.damping[i]) <= kUndamped;
    return (is_undamped ? "0" : format_value(100 * poles.damping[i], 3)) + " %";
  };
  if (weakest >= 0)
    highlights.push_back({"smallest damping ratio", format_ratio(weakest),
                          "at " + format_value(poles.frequency_hz[weakest], 5) + " " + unit + get_mode(weakest)});
  const records::Crossing* margin = nullptr;
  for (const auto& c : findings.margins.phase)
    if (!margin || std::abs(c.margin) < std::abs(margin->margin)) margin = &c;
  if (findings.has_margins && margin)
    highlights.push_back({"smallest phase margin",
                          format_value(margin->margin * 180 / std::numbers::pi, 4) + " degrees",
                          "at " + format_value(margin->frequency_hz, 5) + " " + unit});
  else if (!findings.response.value.empty())
    highlights.push_back({"largest gain", findings.peak.is_finite ? format_value(findings.peak.value, 4) : "infinite",
                          findings.peak.is_finite ? "at " + format_value(findings.peak.frequency_hz, 5) + " " + unit
                                                  : findings.peak.why});
  if (lowest >= 0 && lowest != weakest)
    highlights.push_back({"lowest frequency", format_value(poles.frequency_hz[lowest], 5) + " " + unit,
                          "damping ratio " + format_ratio(lowest) + get_mode(lowest)});
  if (highlights.size() > 3) highlights.resize(3);
}

/// Pairs of the interactive Bode diagrams, with the marks of their margins.
json list_pairs(const LinearFindings& findings, const std::vector<BodePair>& pairs_of) {
  json pairs = json::array();
  for (const auto& pair : pairs_of) {
    json diagrams = json::array();
    for (const auto& plot : make_bode_plots(findings, pair)) {
      json marks = json::array(), guides = json::array();
      for (const auto& curve : plot.curves)
        if (curve.markers_only)
          marks.push_back({{"label", curve.label}, {"x", to_list(curve.x)}, {"y", to_list(curve.y)}});
      for (const auto& guide : plot.guides)
        guides.push_back({{"label", guide.label}, {"x", to_list(guide.x)}, {"y", to_list(guide.y)}});
      diagrams.push_back({{"marks", std::move(marks)}, {"guides", std::move(guides)}});
    }
    pairs.push_back({{"name", pair.name},
                     {"output", findings.response.outputs.name[static_cast<std::size_t>(pair.output)]},
                     {"input", findings.response.inputs.name[static_cast<std::size_t>(pair.input)]},
                     {"decibel", pack_doubles(pair.decibel)},
                     {"degrees", pack_doubles(pair.degrees)},
                     {"diagrams", std::move(diagrams)}});
  }
  return pairs;
}

}  // namespace

Chapter make_chapter(const records::LinearModel& model, const LinearFindings& findings, const std::string& file,
                     const std::vector<std::pair<std::string, std::string>>& facts) {
  Chapter chapter{"linear model", file, facts, {}, {}, {}, {}};
  int unstable = 0;
  double worst = 0;
  std::string on_axis;
  const Eigen::VectorXd doubt = calc_pole_uncertainty(model.poles, 1e-6);
  for (Eigen::Index i = 0; i < model.poles.real.size(); ++i) {
    const double size = std::hypot(model.poles.real[i], model.poles.imag[i]);
    if (model.poles.imag[i] > 0 && std::abs(model.poles.real[i]) <= kUndamped * size) {
      if (std::abs(model.poles.real[i]) > doubt[i]) on_axis += (on_axis.empty() ? "" : ", ") + format_value(size, 5);
    } else if (model.poles.real[i] > std::max(doubt[i], kUndamped * size)) {
      ++unstable;
      worst = std::max(worst, model.poles.real[i]);
    }
  }
  chapter.checks.push_back({"poles in the right half plane", std::to_string(unstable),
                            unstable > 0 ? Verdict::Warning : Verdict::Good,
                            unstable > 0 ? "largest real part " + format_value(worst, 4) : ""});
  if (!on_axis.empty())
    chapter.checks.push_back({"poles on the imaginary axis, damping below 1e-7", "\u00b1 " + on_axis + " i",
                              Verdict::None, "rounding decides the sign of their real part"});
  chapter.checks.push_back({"estimated relative error of A and C", format_value(model.error, 2),
                            model.error > 1e-5 ? Verdict::Warning : Verdict::Good, ""});
  chapter.checks.push_back({"rate of change |u̇| at the point", format_value(model.residual, 3), Verdict::None,
                            "0 at rest and in a steady spin"});
  add_highlights(model, findings, unstable, chapter);
  chapter.add_panel("poles", "Poles and zeros", make_poles(model));
  const auto pairs_of = make_bode_pairs(findings.response, kMaxPairs);
  add_response(findings, pairs_of, chapter);
  if (model.hankel.value.size() > 0) chapter.add_panel("hankel", "Hankel", make_hankel(model.hankel));
  for (const auto& [id, title, signals] :
       {std::tuple("states", "States", &model.states), std::tuple("inputs", "Inputs", &model.inputs),
        std::tuple("outputs", "Outputs", &model.outputs)}) {
    HtmlTable table("", {{"number"}, {"name", true}, {model.units.empty() ? "dims" : "unit", true}});
    for (int i = 0; i < signals->size(); ++i)
      table.add_row({std::to_string(i + 1), signals->name[static_cast<std::size_t>(i)],
                     records::label_dims(signals->dims[static_cast<std::size_t>(i)], model.units)});
    chapter.add_panel(
        id, title,
        "<details><summary>" + std::to_string(signals->size()) + "</summary>\n" + table.to_html(400) + "</details>\n");
  }
  chapter.data = json{{"poles", list_poles(model)},
                      {"plane", make_plane(model)},
                      {"zeros", {{"real", to_list(model.zeros_real)}, {"imag", to_list(model.zeros_imag)}}},
                      {"frequency_unit", records::name_frequency_unit(model.units.time)},
                      {"frequency", pack_doubles(findings.response.frequency_hz)},
                      {"pairs", list_pairs(findings, pairs_of)}}
                     .dump(-1, ' ', false, json::error_handler_t::replace);
  return chapter;
}

Chapter make_chapter(const LinearFindings& findings, const std::string& file,
                     const std::vector<std::pair<std::string, std::string>>& facts) {
  Chapter chapter{"response of a linear model", file, facts, {}, {}, {}, {}};
  const auto& response = findings.response;
  const auto pairs = make_bode_pairs(response, kMaxPairs);
  const Eigen::Index n = response.frequency_hz.size();
  chapter.facts.emplace_back(
      "frequencies",
      n == 0 ? "0" : fmt::format("{} from {:g} to {:g}", n, response.frequency_hz[0], response.frequency_hz[n - 1]));
  chapter.facts.emplace_back("inputs", fmt::format("{}", fmt::join(response.inputs.name, ", ")));
  chapter.facts.emplace_back("outputs", fmt::format("{}", fmt::join(response.outputs.name, ", ")));
  add_response(findings, pairs, chapter);
  chapter.data = json{{"frequency_unit", records::name_frequency_unit(response.units.time)},
                      {"frequency", pack_doubles(response.frequency_hz)},
                      {"pairs", list_pairs(findings, pairs)}}
                     .dump(-1, ' ', false, json::error_handler_t::replace);
  return chapter;
}

namespace {

constexpr double kToRpm = 60 / (2 * std::numbers::pi);
constexpr Eigen::Index kMaxBudgetOutputs = 6;

HtmlTable make_budget_table(const records::PointingBudget& budget, const records::BudgetTable& table) {
  std::vector<HtmlTable::Column> columns{{"source", true}};
  for (const auto& name : budget.outputs.name) columns.push_back({name});
  HtmlTable html(table.exposure > 0 ? table.weighting + " RMS, exposure " + format_value(table.exposure) : "total RMS",
                 std::move(columns));
  const auto add = [&](const std::string& name, const Eigen::RowVectorXd& values) {
    std::vector<std::string> cells{name};
    for (const double value : values) cells.push_back(format_value(value));
    html.add_row(std::move(cells));
  };
  for (std::size_t s = 0; s < budget.sources.size(); ++s) {
    const auto row = static_cast<Eigen::Index>(s);
    add(budget.sources[s], table.rms.row(row));
    if (budget.speed[s].size() > 0) add(budget.sources[s] + ", at rpm", kToRpm * table.speed.row(row));
  }
  add("root of the sum of squares", table.total.transpose());
  return html;
}

/// Mean squares up to each of the frequencies; of tones (`has_steps`) those at or below it.
Eigen::VectorXd sample_squares(const Eigen::VectorXd& hz, const Eigen::VectorXd& rms, bool has_steps,
                               const std::vector<double>& at) {
  Eigen::VectorXd squares(std::ssize(at));
  Eigen::Index next = 0;
  for (std::size_t k = 0; k < at.size(); ++k) {
    while (next < hz.size() && hz[next] <= at[k]) ++next;
    double square = next == 0 ? 0 : rms[next - 1] * rms[next - 1];
    if (!has_steps && next > 0 && next < hz.size())
      square += (at[k] - hz[next - 1]) / (hz[next] - hz[next - 1]) * (rms[next] * rms[next] - square);
    squares[static_cast<Eigen::Index>(k)] = square;
  }
  return squares;
}

/// RMS up to each frequency of one output: a curve for each source, and the root of their sum of squares.
Plot make_waterfall(const records::PointingBudget& budget, Eigen::Index output) {
  constexpr Eigen::Index kMaxPicturePoints = 4000, kMaxSteps = 64;
  const std::string& name = budget.outputs.name[static_cast<std::size_t>(output)];
  Plot plot;
  plot.title = name + ", RMS up to each frequency";
  plot.x_label = "frequency [Hz]";
  plot.y_label = "cumulative RMS";
  std::vector<double> at;
  std::vector<bool> has_steps;
  for (const auto& curve : budget.curves) {
    has_steps.push_back(curve.rms.rows() <= kMaxSteps);
    if (curve.rms.rows() == 0) continue;
    for (const double f : curve.frequency_hz.col(output)) {
      at.push_back(f);
      if (has_steps.back()) at.push_back(std::nextafter(f, 0));
    }
  }
  if (at.empty()) return plot;
  std::sort(at.begin(), at.end());
  at.erase(std::unique(at.begin(), at.end()), at.end());
  at.push_back(1.1 * at.back());
  plot.has_log_x = at.front() > 0;
  const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(at.data(), std::ssize(at));
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(x.size());
  for (std::size_t s = 0; s < budget.sources.size(); ++s) {
    const auto& curve = budget.curves[s];
    if (curve.rms.rows() == 0) continue;
    const auto squares = sample_squares(curve.frequency_hz.col(output), curve.rms.col(output), has_steps[s], at);
    sum += squares;
    plot.curves.push_back(
        thin_curve({budget.sources[s], x, squares.cwiseSqrt(), false}, kMaxPicturePoints, plot.has_log_x));
  }
  plot.curves.push_back(
      thin_curve({"root of the sum of squares", x, sum.cwiseSqrt(), false}, kMaxPicturePoints, plot.has_log_x));
  return plot;
}

/// RMS over the speed of one wheel, a curve for each output.
Plot make_speed_plot(const records::PointingBudget& budget, const records::BudgetTable& table, std::size_t source) {
  Plot plot;
  plot.title = budget.sources[source] + ", " + table.weighting + " RMS over its speed" +
               (table.exposure > 0 ? ", exposure " + format_value(table.exposure, 4) : "");
  plot.x_label = "speed [rpm]";
  plot.y_label = "RMS";
  for (Eigen::Index i = 0; i < std::min(kMaxBudgetOutputs, table.rms.cols()); ++i)
    plot.curves.push_back({budget.outputs.name[static_cast<std::size_t>(i)], kToRpm * budget.speed[source],
                           table.over_speed[source].col(i), false});
  return plot;
}

}  // namespace

Chapter make_chapter(const records::PointingBudget& budget, const std::string& file,
                     const std::vector<std::pair<std::string, std::string>>& facts) {
  Chapter chapter{"pointing budget", file, facts, {}, {}, {}, {}};
  chapter.facts.emplace_back("sources", fmt::format("{}", fmt::join(budget.sources, ", ")));
  chapter.facts.emplace_back("outputs", fmt::format("{}", fmt::join(budget.outputs.name, ", ")));
  if (budget.to_hz > 0)
    chapter.facts.emplace_back("spectral densities", fmt::format("{:.4g} to {:.4g} Hz", budget.from_hz, budget.to_hz));
  std::string tables, waterfall, speeds;
  for (const auto& table : budget.tables) tables += make_budget_table(budget, table).to_html(200);
  chapter.add_panel("budget", "Budget", tables);
  const Eigen::Index num_outputs = budget.outputs.size();
  std::string shares;
  for (Eigen::Index i = 0; i < std::min(kMaxBudgetOutputs, num_outputs); ++i) {
    if (!budget.tables.empty()) shares += draw_budget_waterfall(budget, budget.tables.front(), i);
    if (budget.tables.size() > 1) shares += draw_budget_shares(budget, i);
  }
  if (num_outputs > kMaxBudgetOutputs && !shares.empty())
    shares += make_text(fmt::format("The first {} of {} outputs are drawn.", kMaxBudgetOutputs, num_outputs), "note");
  if (!shares.empty()) chapter.add_panel("sources", "Budget by source", shares);
  for (Eigen::Index i = 0; i < std::min(kMaxBudgetOutputs, num_outputs); ++i) {
    const Plot plot = make_waterfall(budget, i);
    if (!plot.curves.empty()) waterfall += make_figure(plot);
  }
  if (num_outputs > kMaxBudgetOutputs)
    waterfall +=
        make_text(fmt::format("The first {} of {} outputs are drawn.", kMaxBudgetOutputs, num_outputs), "note");
  if (!waterfall.empty()) chapter.add_panel("waterfall", "RMS up to each frequency", waterfall);
  for (std::size_t s = 0; s < budget.sources.size(); ++s)
    for (const auto& table : budget.tables)
      if (budget.speed[s].size() > 1 && (table.weighting == "total" || table.weighting == "jitter"))
        speeds += make_figure(make_speed_plot(budget, table, s));
  if (!speeds.empty()) chapter.add_panel("speeds", "Wheels over their speeds", speeds);
  return chapter;
}

}  // namespace bough::report
