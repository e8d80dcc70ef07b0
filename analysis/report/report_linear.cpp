#include <fmt/format.h>

#include <algorithm>

#include "analysis/plot/linear_plots.hpp"
#include "analysis/report/report_files.hpp"
#include "formats/hdf5/complex_modes_file.hpp"
#include "formats/hdf5/linear_file.hpp"
#include "formats/hdf5/sweep_file.hpp"
#include "formats/records/unit_names.hpp"
#include "report/complex_chapter.hpp"
#include "report/html.hpp"
#include "report/label.hpp"
#include "report/linear_chapter.hpp"
#include "report/random_panel.hpp"
#include "solver/statespace/frequency_response.hpp"

namespace bough::analysis {

using Eigen::Index;
using report::Verdict;

report::Chapter make_linear_chapter(const std::string& file) {
  const auto model = hdf5::read_linear_model(file);
  report::LinearFindings findings{{}, {}, {}, records::is_cut_loop(model)};
  if (model.inputs.size() > 0 && model.outputs.size() > 0) {
    statespace::FrequencyRange range{0, 0, 300, 2000};
    if (findings.has_margins) range = statespace::widen_for_loop(model, range);
    findings.response = statespace::calc_frequency_response(model, range);
    findings.peak = statespace::calc_peak_gain(model, findings.response);
    if (findings.has_margins) findings.margins = statespace::calc_margins(model, findings.response);
  }
  return report::make_chapter(model, findings, file, list_facts(file));
}

namespace {

void add_random_outputs(const records::RandomOutputs& random, const std::string& time, report::Chapter& chapter) {
  const auto unit = records::name_frequency_unit(time);
  report::RandomTable table{
      "random response",
      "RMS and zero crossings per unit of time (N0)",
      {"RMS", report::make_label("N0", unit), "RMS of the band", report::make_label("N0 of the band", unit)},
      random.frequency_hz,
      {},
      unit};
  const bool has_total = random.total_rms.size() > 0;
  if (has_total)
    table.columns.insert(table.columns.end(),
                         {"RMS of all frequencies", report::make_label("N0 of all frequencies", unit)});
  for (Index i = 0; i < random.outputs.size(); ++i) {
    report::RandomRow row{random.outputs.name[static_cast<std::size_t>(i)],
                          random.psd.col(i),
                          random.cumulative_rms.col(i),
                          random.rms[i],
                          {random.rms[i], random.crossing_hz[i], random.band_rms[i], random.band_crossing_hz[i]}};
    if (has_total) row.numbers.insert(row.numbers.end(), {random.total_rms[i], random.total_crossing_hz[i]});
    table.rows.push_back(std::move(row));
  }
  chapter.add_panel("random", "Random response", report::make_random_panel(std::move(table)));
}

}  // namespace

report::Chapter make_model_response_chapter(const std::string& file) {
  auto read = hdf5::read_model_response(file);
  report::LinearFindings findings{std::move(read.response), std::move(read.peak), std::move(read.margins),
                                  read.has_margins};
  if (!findings.peak.is_finite) findings.peak.why = "a pole on the imaginary axis";
  auto chapter = report::make_chapter(findings, file, list_facts(file));
  if (read.has_random) add_random_outputs(read.random, findings.response.units.time, chapter);
  return chapter;
}

namespace {

/// "1 to 3, 7": runs of the values for which it holds.
std::string list_ranges(const Eigen::VectorXd& value, const std::vector<bool>& holds) {
  std::string text;
  for (std::size_t i = 0; i < holds.size(); ++i) {
    if (!holds[i]) continue;
    std::size_t last = i;
    while (last + 1 < holds.size() && holds[last + 1]) ++last;
    const auto get = [&](std::size_t k) { return report::format_value(value[static_cast<Index>(k)]); };
    text += (text.empty() ? "" : ", ") + get(i) + (last > i ? " to " + get(last) : "");
    i = last;
  }
  return text;
}

}  // namespace

report::Chapter make_complex_chapter(const std::string& file) {
  const auto modes = hdf5::read_complex_modes(file);
  auto chapter = report::make_chapter(modes, file, list_facts(file));
  if (!modes.rotors) return chapter;
  const auto& rotors = *modes.rotors;
  if (rotors.sweep.value.size() > 1) {
    auto plots = make_linear_plots({file}, {"campbell", {}, {}});
    plots.front().title = "Campbell diagram";
    chapter.add_panel("campbell", "Campbell diagram", report::make_figure(plots.front()));
  }
  for (const bool is_critical : {true, false}) {
    const auto& points = is_critical ? rotors.critical : rotors.thresholds;
    if (points.empty()) continue;
    std::vector<report::HtmlTable::Column> columns{{is_critical && rotors.is_synchronous ? "mode" : "branch"},
                                                   {"speed [rad/s]"},
                                                   {report::label_frequency("")},
                                                   {"whirl", true}};
    if (!is_critical) columns.push_back({"above this speed", true});
    report::HtmlTable table("", std::move(columns));
    for (const auto& point : points) {
      std::vector<std::string> row{std::to_string(point.branch + 1), report::format_value(point.speed, 7),
                                   report::format_value(point.frequency_hz, 7), records::name_whirl(point.whirl)};
      if (!is_critical) row.emplace_back(point.is_onset ? "unstable" : "stable");
      table.add_row(row);
    }
    chapter.add_panel(is_critical ? "critical-speeds" : "thresholds",
                      is_critical ? "Critical speeds" : "Thresholds of instability", table.to_html());
  }
  return chapter;
}

report::Chapter make_sweep_chapter(const std::string& file) {
  const auto sweep = hdf5::read_sweep(file);
  report::Chapter chapter{"sweep", file, list_facts(file), {}, {}, {}, {}};
  const Index count = sweep.value.size(), branches = sweep.real.cols();
  if (count == 0 || branches == 0)
    throw InputError("cli.no-report", {file}, "the sweep has no poles", "give one of a system with states");
  chapter.facts.emplace_back("parameter", sweep.parameter);
  chapter.facts.emplace_back("values",
                             fmt::format("{} from {:g} to {:g}", count, sweep.value[0], sweep.value[count - 1]));
  chapter.facts.emplace_back("states", std::to_string(branches));
  const double largest = std::max(sweep.real.cwiseAbs().maxCoeff(), sweep.imag.cwiseAbs().maxCoeff());
  std::vector<bool> is_unstable;
  for (Index k = 0; k < count; ++k) {
    // Poles gone within a sample are the logarithm of round-off: of sampled models 1 / T is the scale.
    const double sample_time = sweep.models[static_cast<std::size_t>(k)].sample_time;
    const double scale = sample_time > 0 ? 1 / sample_time : largest;
    is_unstable.push_back(sweep.real.row(k).maxCoeff() > 1e-6 * scale);
  }
  const bool is_sampled = sweep.models.front().sample_time > 0;
  const auto unstable = std::count(is_unstable.begin(), is_unstable.end(), true);
  chapter.checks.push_back(
      {is_sampled ? "values with poles outside the unit circle" : "values with poles in the right half plane",
       std::to_string(unstable), unstable > 0 ? Verdict::Warning : Verdict::Good,
       unstable > 0 ? sweep.parameter + " = " + list_ranges(sweep.value, is_unstable) : ""});
  if (count > 1) {
    const double min_value = sweep.correlation.bottomRows(count - 1).minCoeff();
    chapter.checks.push_back(
        {"least likeness of a motion to itself at the value before", report::format_value(min_value, 3),
         min_value > 0.5 ? Verdict::Good : Verdict::Warning,
         min_value > 0.5 ? "1: the same" : "branches may have been exchanged; sweep in smaller steps"});
  }
  for (const auto& [kind, title] : {std::pair("campbell", "Campbell diagram"), std::pair("locus", "Root locus")}) {
    auto plots = make_linear_plots({file}, {kind, {}, {}});
    plots.front().title = title;
    chapter.add_panel(kind, title, report::make_figure(plots.front()));
  }
  report::HtmlTable table("Of each motion at the first and the last value",
                          {{"first", true},
                           {"last", true},
                           {report::label_frequency(sweep.models.front().units.time)},
                           {"at the end"},
                           {"damping %"},
                           {"at the end"},
                           {"least"},
                           {"at " + sweep.parameter}});
  for (Index b = 0; b < branches; ++b) {
    if (sweep.imag.col(b).sum() < 0 || records::is_gone(sweep, b)) continue;  // of a pair one
    Index at = 0;
    const double min_value = sweep.damping.col(b).minCoeff(&at);
    const auto k = static_cast<std::size_t>(b);
    table.add_row({sweep.mode.front()[k], sweep.mode.back()[k], report::format_value(sweep.frequency_hz(0, b)),
                   report::format_value(sweep.frequency_hz(count - 1, b)),
                   report::format_value(100 * sweep.damping(0, b), 4),
                   report::format_value(100 * sweep.damping(count - 1, b), 4), report::format_value(100 * min_value, 4),
                   report::format_value(sweep.value[at])});
  }
  chapter.add_panel("branches", "Motions", table.to_html(400));
  return chapter;
}

}  // namespace bough::analysis
