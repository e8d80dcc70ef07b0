#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/text_file.hpp"
#include "analysis/export/csv_tables.hpp"
#include "analysis/response/budget.hpp"
#include "analysis/response/input_spectrum.hpp"
#include "analysis/response/response.hpp"
#include "cli/common/console_events.hpp"
#include "cli/common/number_checks.hpp"
#include "cli/common/options.hpp"
#include "cli/common/usage_text.hpp"
#include "cli/linearize/linear_model_files.hpp"
#include "cli/response/budget_tables.hpp"
#include "cli/verbs.hpp"
#include "formats/hdf5/linear_file.hpp"
#include "formats/hdf5/sweep_file.hpp"
#include "formats/records/unit_names.hpp"

namespace bough::cli {

namespace {

using Eigen::Index;
using records::FrequencyResponse;
using records::LinearModel;

struct ResponseOptions : CommonOptions {
  analysis::ResponseRequest request;
  std::string csv, budget;
};

constexpr std::size_t kMaxRows = 24;
double to_decibel(double gain) { return 20 * std::log10(gain); }
double to_degrees(double angle) { return angle * 180 / std::numbers::pi; }

struct Summit {
  std::string name;
  double gain = 0, frequency_hz = 0, first = 0;
};

std::vector<Summit> find_summits(const FrequencyResponse& response) {
  std::vector<Summit> summits;
  for (int j = 0; j < response.inputs.size(); ++j)
    for (int i = 0; i < response.outputs.size(); ++i) {
      Summit summit{response.outputs.name[static_cast<std::size_t>(i)] + " over " +
                        response.inputs.name[static_cast<std::size_t>(j)],
                    0, 0, std::abs(response.value.front()(i, j))};
      for (std::size_t k = 0; k < response.value.size(); ++k) {
        const double gain = std::abs(response.value[k](i, j));
        if (!(gain > summit.gain)) continue;
        summit.gain = gain;
        summit.frequency_hz = response.frequency_hz[static_cast<Index>(k)];
      }
      summits.push_back(summit);
    }
  return summits;
}

std::string format_margins(const records::Margins& m, const std::string& unit) {
  Table table{{"margin", "frequency " + unit, "value", "delay"}, {}};
  for (const auto& c : m.gain)
    table.rows.push_back({c.margin >= 1 ? "gain, up" : "gain, down", fmt::format("{:.6g}", c.frequency_hz),
                          fmt::format("{:.4g} dB", to_decibel(c.margin)), ""});
  for (const auto& c : m.phase)
    table.rows.push_back({"phase", fmt::format("{:.6g}", c.frequency_hz),
                          fmt::format("{:.4g} deg", to_degrees(c.margin)), fmt::format("{:.4g}", c.delay)});
  std::string text = fmt::format("\nthe loop with negative feedback: {} when closed (largest real part {:.3g})\n",
                                 m.is_stable ? "stable" : "unstable", m.largest_real);
  text += table.rows.empty() ? "no crossing: neither |L| = 1 nor L real and negative\n" : table.to_text();
  return text + fmt::format("nearest to -1: {:.4g} at {:.6g} {}\n", m.distance, m.distance_hz, unit);
}

std::string format(const LinearModel& model, const FrequencyResponse& response, const records::PeakGain& peak,
                   const records::Margins* margins) {
  const auto unit = records::name_frequency_unit(response.units.time);
  std::string text =
      fmt::format("{}, {:.4g} to {:.4g} {}\n", count(response.value.size(), "frequency"), response.frequency_hz[0],
                  response.frequency_hz[response.frequency_hz.size() - 1], unit);
  if (!peak.is_finite)
    text += "largest gain: infinite, " + peak.why + "\n";
  else if (peak.value == 0)
    text += "the response is 0: no way leads from any of these inputs to any of these outputs\n";
  else
    text += fmt::format("largest gain (H-infinity norm): {:.6g}, {:.4g} dB, {}{}\n", peak.value, to_decibel(peak.value),
                        std::isfinite(peak.frequency_hz) ? fmt::format("at {:.6g} {}", peak.frequency_hz, unit)
                                                         : std::string("beyond all poles"),
                        peak.is_certified ? "" : "; of the frequencies looked at");
  Table table{{"output over input", "dB at first", "largest dB", "at " + unit}, {}};
  const auto summits = find_summits(response);
  for (std::size_t k = 0; k < std::min(kMaxRows, summits.size()); ++k) {
    const auto& s = summits[k];
    table.rows.push_back({s.name, s.first > 0 ? fmt::format("{:.4g}", to_decibel(s.first)) : "-",
                          s.gain > 0 ? fmt::format("{:.4g}", to_decibel(s.gain)) : "-",
                          fmt::format("{:.6g}", s.frequency_hz)});
  }
  text += "\n" + table.to_text();
  if (summits.size() > kMaxRows) text += fmt::format("and {} more\n", summits.size() - kMaxRows);
  if (margins) text += format_margins(*margins, unit);
  return text + format_hankel(model.hankel);
}

nlohmann::json make_json(const FrequencyResponse& response, const records::PeakGain& peak,
                         const records::Margins* margins) {
  nlohmann::json json{{"inputs", response.inputs.name},
                      {"outputs", response.outputs.name},
                      {"num_frequencies", response.value.size()},
                      {"peak", {{"finite", peak.is_finite}, {"certified", peak.is_certified}}}};
  if (peak.is_finite) json["peak"]["value"] = peak.value;
  if (std::isfinite(peak.frequency_hz)) json["peak"]["frequency_hz"] = peak.frequency_hz;
  auto pairs = nlohmann::json::array();
  for (const auto& s : find_summits(response))
    pairs.push_back({{"name", s.name}, {"largest", s.gain}, {"frequency_hz", s.frequency_hz}});
  json["pairs"] = pairs;
  if (!margins) return json;
  auto gain = nlohmann::json::array(), phase = nlohmann::json::array();
  for (const auto& c : margins->gain) gain.push_back({{"frequency_hz", c.frequency_hz}, {"factor", c.margin}});
  for (const auto& c : margins->phase)
    phase.push_back({{"frequency_hz", c.frequency_hz}, {"degrees", to_degrees(c.margin)}, {"delay", c.delay}});
  json["margins"] = {{"gain", gain},
                     {"phase", phase},
                     {"stable", margins->is_stable},
                     {"largest_real", margins->largest_real},
                     {"distance", margins->distance},
                     {"distance_hz", margins->distance_hz}};
  return json;
}

/// "-" where the integral has no bound.
std::string format_value(const Eigen::VectorXd& values, Index i) {
  return std::isfinite(values[i]) ? fmt::format("{:.6g}", values[i]) : "-";
}

std::string format_random(const records::RandomOutputs& random, const std::string& unit) {
  std::string text = fmt::format("\nrandom response, {:.4g} to {:.4g} {}\n", random.frequency_hz[0],
                                 random.frequency_hz[random.frequency_hz.size() - 1], unit);
  const bool has_total = random.total_rms.size() > 0;
  Table table{{"output", "RMS", "N0 " + unit, "band RMS", "band N0 " + unit}, {}};
  if (has_total) table.headings.insert(table.headings.end(), {"white RMS", "white N0 " + unit});
  for (Index i = 0; i < random.rms.size() && static_cast<std::size_t>(i) < kMaxRows; ++i) {
    std::vector<std::string> row{random.outputs.name[static_cast<std::size_t>(i)]};
    for (const auto* values : {&random.rms, &random.crossing_hz, &random.band_rms, &random.band_crossing_hz})
      row.push_back(format_value(*values, i));
    if (has_total)
      row.insert(row.end(), {format_value(random.total_rms, i), format_value(random.total_crossing_hz, i)});
    table.rows.push_back(std::move(row));
  }
  text += table.to_text();
  if (static_cast<std::size_t>(random.rms.size()) > kMaxRows)
    text += fmt::format("and {} more\n", static_cast<std::size_t>(random.rms.size()) - kMaxRows);
  return has_total ? text + "white: of all frequencies, by Lyapunov's equation; - has no bound\n" : text;
}

nlohmann::json make_random_json(const records::RandomOutputs& random) {
  auto outputs = nlohmann::json::array();
  const auto get = [](const Eigen::VectorXd& values, Index i) {
    return std::isfinite(values[i]) ? nlohmann::json(values[i]) : nlohmann::json(nullptr);
  };
  for (Index i = 0; i < random.rms.size(); ++i) {
    nlohmann::json one{{"name", random.outputs.name[static_cast<std::size_t>(i)]},
                       {"rms", random.rms[i]},
                       {"zero_crossings_hz", random.crossing_hz[i]},
                       {"band_rms", random.band_rms[i]},
                       {"band_zero_crossings_hz", random.band_crossing_hz[i]}};
    if (random.total_rms.size() > 0) {
      one["total_rms"] = get(random.total_rms, i);
      one["total_zero_crossings_hz"] = get(random.total_crossing_hz, i);
    }
    outputs.push_back(one);
  }
  const Index last = random.frequency_hz.size() - 1;
  nlohmann::json json{{"from_hz", random.frequency_hz[0]}, {"to_hz", random.frequency_hz[last]}, {"outputs", outputs}};
  if (!random.no_total.empty()) json["no_total"] = random.no_total;
  return json;
}

int run_budget(const ResponseOptions& o, Console& console) {
  check_outputs(o, {o.output, o.csv}, {o.request.file, o.budget});
  ConsoleEvents events(console);
  const auto budget = analysis::calc_budget({o.request.file, o.budget, o.request.outputs, o.request.range}, events);
  console.print(events.get_messages());
  if (o.json)
    console.print_data(make_budget_json(budget).dump(2) + "\n");
  else
    console.print(format_budget(budget));
  if (!o.output.empty()) hdf5::write_budget(budget, o.output);
  if (!o.csv.empty()) analysis::write_text_file(o.csv, analysis::make_budget_csv(budget));
  return print_written_files(o, console, {o.output, o.csv});
}

int run_response(const ResponseOptions& o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  if (!o.budget.empty()) return run_budget(o, console);
  analysis::demand_file(o.request.file);
  auto inputs = analysis::list_spectrum_files(o.request.psd);
  inputs.push_back(o.request.file);
  check_outputs(o, {o.output, o.csv}, inputs);
  ConsoleEvents events(console);
  const auto [model, response, peak, margins, random] = analysis::calc_response(o.request, events);
  console.print(events.get_messages());
  const records::Margins* given = margins ? &*margins : nullptr;
  const records::RandomOutputs* outputs = random ? &*random : nullptr;
  if (o.json) {
    auto json = make_json(response, peak, given);
    if (outputs) json["random"] = make_random_json(*outputs);
    console.print_data(json.dump(2) + "\n");
  } else {
    console.print(format(model, response, peak, given) +
                  (outputs ? format_random(*outputs, records::name_frequency_unit(response.units.time)) : ""));
  }
  if (!o.output.empty()) hdf5::write_response(response, peak, given, outputs, o.output);
  if (!o.csv.empty())
    analysis::write_text_file(o.csv,
                              outputs ? analysis::make_random_csv(*outputs) : analysis::make_response_csv(response));
  return print_written_files(o, console, {o.output, o.csv});
}

}  // namespace

void add_response(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_response, "response", &analysis::ResponseRequest::file);
  verb->add_option("file", o->request.file, "Linear model (.h5) of bough linearize")->required();
  verb->add_option("--inputs", o->request.inputs, "Only these inputs (default: all)")->delimiter(',');
  verb->add_option("--outputs", o->request.outputs, "Only these outputs (default: all)")->delimiter(',');
  verb->add_option("--from", o->request.range.from_hz, "Lowest frequency (default: a decade below the poles)")
      ->check(make_positive());
  verb->add_option("--to", o->request.range.to_hz, "Highest frequency (default: a decade above the poles)")
      ->check(make_positive());
  verb->add_option("--points", o->request.range.points, "Frequencies at least; resonances and notches get more")
      ->check(is_within(1, 100000))
      ->capture_default_str();
  verb->add_flag("--loop", o->request.is_loop,
                 "Margins of the one input and output as a loop with negative feedback (always of linearize --break)");
  verb->add_option("--psd", o->request.psd,
                   "Random response to these one-sided spectral densities of the inputs: NUMBER for all, NAME=NUMBER, "
                   "or a .toml or .csv file; as often as needed")
      ->excludes("--loop");
  verb->add_option("--csv", o->csv,
                   "Write the response to this CSV file, with --psd the densities and running RMS, with --budget its "
                   "tables");
  add_common_options(*verb, *o, kOutput | kJson, "Write the response, or the budget, to this HDF5 file");
  verb->add_option("--budget", o->budget,
                   "Pointing budget: RMS of each output by the sources of this .toml file, by wheel speed and exposure")
      ->excludes("--psd")
      ->excludes("--loop")
      ->excludes("--inputs");
}

}  // namespace bough::cli
