#include "analysis/plot/history_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "analysis/common/channels.hpp"
#include "analysis/common/inputs.hpp"
#include "formats/hdf5/table_file.hpp"
#include "report/label.hpp"
#include "report/shock_spectrum.hpp"
#include "report/spectrum.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;

namespace {

using Eigen::VectorXd;

void cut_to_window(report::Curve& curve, const VectorXd& time, const std::vector<double>& window) {
  std::vector<Eigen::Index> inside;
  for (Eigen::Index i = 0; i < time.size(); ++i)
    if (time[i] >= window[0] && time[i] <= window[1]) inside.push_back(i);
  if (inside.empty())
    throw InputError("cli.bad-range", {},
                     fmt::format("no sample of {} lies between {:g} and {:g}",
                                 curve.label.empty() ? "the curve" : curve.label, window[0], window[1]),
                     "give another --window");
  curve.x = curve.x(inside).eval();
  curve.y = curve.y(inside).eval();
}

/// The time has a path in the file as channels have, but is none.
bool is_time(const std::string& name) { return name == "/time" || name == "time"; }

/// The channel against which curves are drawn, with its label.
VectorXd read_abscissa(const hdf5::ResultsFile& results, const std::string& file, const std::string& name,
                       std::string& label) {
  if (is_time(name) && results.channels.count("/sensors/" + name) == 0) {
    label = report::make_label("time", get_unit(results, "/time"));
    return results.time;
  }
  const auto columns = choose_columns(results, file, name);
  if (columns.size() != 1)
    throw InputError("cli.one-channel", {file}, fmt::format("--x {} names {} curves", name, columns.size()),
                     "name one component, as " + columns.front().name);
  label = report::make_label(name, columns.front().unit);
  return columns.front().values;
}

/// Linear between samples; x ascends, and every `at` lies within.
VectorXd interpolate(const VectorXd& x, const VectorXd& y, const VectorXd& at) {
  VectorXd values(at.size());
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    const auto k = std::clamp<Eigen::Index>(std::upper_bound(x.begin(), x.end(), at[i]) - x.begin(), 1, x.size() - 1);
    const double width = x[k] - x[k - 1];
    values[i] = width > 0 ? y[k - 1] + (y[k] - y[k - 1]) * (at[i] - x[k - 1]) / width : y[k];
  }
  return values;
}

/// The curve minus that of the first file; returns whether it was interpolated.
bool subtract(const report::Curve& first, report::Curve& curve, const std::string& file) {
  if (curve.x.size() == first.x.size() && curve.x == first.x) {
    curve.y -= first.y;
    return false;
  }
  std::vector<Eigen::Index> common;
  for (Eigen::Index i = 0; curve.x.size() > 1 && i < first.x.size(); ++i)
    if (first.x[i] >= curve.x[0] && first.x[i] <= curve.x[curve.x.size() - 1]) common.push_back(i);
  if (common.empty())
    throw InputError("cli.bad-range", {file}, "the two runs have no time in common", "compare runs that overlap");
  const VectorXd time = first.x(common);
  curve.y = (interpolate(curve.x, curve.y, time) - VectorXd(first.y(common))).eval();
  curve.x = time;
  return true;
}

double find_step(const VectorXd& time, const std::string& name) {
  const auto n = time.size();
  const double step = n > 1 ? (time[n - 1] - time[0]) / static_cast<double>(n - 1) : 0;
  double smallest = step, largest = step;
  for (Eigen::Index i = 1; i < n; ++i) {
    smallest = std::min(smallest, time[i] - time[i - 1]);
    largest = std::max(largest, time[i] - time[i - 1]);
  }
  if (!(step > 0) || largest - smallest > 1e-6 * step)
    throw InputError("cli.uneven-samples", {},
                     n < 2 ? "a spectrum needs two samples"
                           : fmt::format("a spectrum of {} needs even samples, their steps go from {:g} to {:g}",
                                         name.empty() ? "the curve" : name, smallest, largest),
                     "choose a --window of even samples, or run with an output_step");
  return step;
}

void take_spectrum(report::Curve& curve, const CurveChoice& choice, Diagnostics& diagnostics) {
  const double step = find_step(curve.x, curve.label);
  if (choice.psd && curve.y.size() < choice.segment)
    diagnostics.note("cli.short-segment", {},
                     fmt::format("a segment of {} samples is wanted of {}, which has {}: they are the only segment, "
                                 "nothing is averaged",
                                 choice.segment, curve.label.empty() ? "the curve" : curve.label, curve.y.size()),
                     "give a --segment of an eighth of the samples or less, or run longer");
  auto spectrum = choice.psd ? report::calc_psd(curve.y, step, choice.segment) : report::calc_amplitudes(curve.y, step);
  curve.x = std::move(spectrum.frequency);
  curve.y = std::move(spectrum.value);
}

/// A tenth of the rate of the samples: above it extremes are between the samples.
constexpr double kShockStep = 0.1;

void take_shock_spectrum(report::Curve& curve, const CurveChoice& choice, Diagnostics& diagnostics) {
  const double step = find_step(curve.x, curve.label);
  const double length = step * static_cast<double>(curve.x.size() - 1);
  double from = 0.1 / length, to = kShockStep / step, per_octave = 12;
  if (choice.srs_range.size() > 1) from = choice.srs_range[0], to = choice.srs_range[1];
  if (choice.srs_range.size() > 2) per_octave = choice.srs_range[2];
  if (!(from > 0 && to > from && per_octave > 0))
    throw InputError("cli.bad-range", {}, fmt::format("shock response spectrum from {:g} to {:g} is empty", from, to),
                     "give --srs-range F1,F2 with F2 above F1 above 0");
  if (to * step > kShockStep * (1 + 1e-9))
    diagnostics.warning(
        "cli.coarse-shock", {},
        fmt::format("{} has {:.3g} samples per period at {:.6g} Hz: its largest values are between them",
                    curve.label.empty() ? "the curve" : curve.label, 1 / (to * step), to),
        "sample ten times per period or more, or lower F2 of --srs-range");
  const auto num = std::max<Eigen::Index>(2, 1 + std::lround(std::log2(to / from) * per_octave));
  VectorXd hz(num);
  for (Eigen::Index i = 0; i < num; ++i)
    hz[i] = from * std::pow(to / from, static_cast<double>(i) / static_cast<double>(num - 1));
  curve.y = report::calc_shock_spectrum(curve.y, step, hz, choice.quality, report::find_shock_kind(choice.srs),
                                        report::find_shock_part(choice.srs_part));
  curve.x = std::move(hz);
  if (choice.srs != "absolute-acceleration" && choice.srs != "static-acceleration") curve.unit.clear();
}

/// Dimensions of a column of choose_columns(); empty: not in the file.
std::string find_dims(const hdf5::ResultsFile& results, const std::string& column) {
  std::string path = "/" + column;
  if (results.channels.count(path) == 0) path = path.substr(0, path.rfind(':'));
  const auto found = results.dims.find(path);
  return found == results.dims.end() ? std::string() : found->second;
}

/// "tip:y" of "sensors/tip:y", as --sensor takes it; channels of other groups keep theirs.
std::string shorten(const std::string& column) { return column.starts_with("sensors/") ? column.substr(8) : column; }

/// Values of "name" or "name:2" in the table of a campaign.
VectorXd find_outcome(const hdf5::OutcomeTable& table, const std::string& file, const std::string& name) {
  std::vector<std::string> known;
  for (const auto& column : table.columns) {
    const auto last = column.path.substr(column.path.rfind('/') + 1);
    for (Eigen::Index c = 0; c < column.numbers.cols(); ++c) {
      const auto own = column.numbers.cols() > 1 ? last + ":" + std::to_string(c + 1) : last;
      known.push_back(own);
      if (name == own || name == column.path + own.substr(last.size())) return column.numbers.col(c);
    }
  }
  if (name == "case")
    return Eigen::Map<const Eigen::VectorXi>(table.cases.data(), std::ssize(table.cases)).cast<double>();
  const auto nearest = find_nearest(name, known);
  throw InputError("cli.unknown-channel", {file}, "no column of numbers \"" + name + "\"",
                   !nearest.empty() ? "did you mean \"" + nearest + "\""
                                    : fmt::format("the columns are {}", fmt::join(known, ", ")));
}

}  // namespace

void warn_of_shock_input(const std::string& file, const std::string& curve, const std::string& is,
                         Diagnostics& diagnostics) {
  diagnostics.warning("cli.shock-input", {file},
                      fmt::format("{} is {}, found no acceleration: --srs takes its values as the acceleration of a "
                                  "base",
                                  curve, is),
                      "give the acceleration of the same point");
}

report::Plot make_history_plot(const std::vector<std::string>& files, const std::vector<std::string>& sensors,
                               const CurveChoice& choice, Diagnostics& diagnostics) {
  report::Plot plot;
  std::vector<report::Curve> first;
  for (std::size_t f = 0; f < files.size(); ++f) {
    const auto& file = files[f];
    demand_file(file);
    warn_incomplete(file, diagnostics);
    const auto results = hdf5::read_results(file);
    const VectorXd x = choice.x.empty() ? results.time : read_abscissa(results, file, choice.x, plot.x_label);
    if (choice.x.empty()) plot.x_label = report::make_label("time", get_unit(results, "/time"));
    const auto time_unit = get_unit(results, "/time");
    const bool is_spectrum = choice.x.empty() && (choice.psd || choice.spectrum || !choice.srs.empty());
    if (is_spectrum) plot.x_label = report::label_frequency(time_unit);
    std::size_t number = 0;
    bool is_interpolated = false;
    for (const auto& sensor : sensors) {
      for (auto& column : choose_columns(results, file, sensor)) {
        if (const auto dims = find_dims(results, column.name);
            !choice.srs.empty() && !dims.empty() && dims.find("/T^2") == std::string::npos)
          warn_of_shock_input(file, column.name, "of dimensions " + dims, diagnostics);
        const bool one_curve_a_file = sensors.size() == 1 && sensor.find(':') != std::string::npos;
        std::string label = files.size() > 1 ? fs::path(file).stem().string() : "";
        if (files.size() == 1 || !one_curve_a_file) label += (label.empty() ? "" : " ") + shorten(column.name);
        report::Curve curve{label, x, std::move(column.values), false};
        curve.unit = is_spectrum && choice.psd ? report::make_density_unit(column.unit, time_unit) : column.unit;
        if (!choice.window.empty()) cut_to_window(curve, results.time, choice.window);
        if (!choice.difference) {
          plot.curves.push_back(std::move(curve));
        } else if (f == 0) {
          first.push_back(std::move(curve));
        } else if (number < first.size()) {
          is_interpolated = subtract(first[number++], curve, file) || is_interpolated;
          curve.label += " less " + fs::path(files.front()).stem().string();
          plot.curves.push_back(std::move(curve));
        }
      }
    }
    if (is_interpolated)
      diagnostics.note("cli.interpolated", {file},
                       "its samples are at other times than those of " + files.front() +
                           ": the difference is taken at the times of that one, linear between samples",
                       "run both with one output_step");
  }
  return plot;
}

report::Plot make_campaign_plot(const std::vector<std::string>& files, const std::vector<std::string>& names,
                                const CurveChoice& choice, Diagnostics& diagnostics) {
  report::Plot plot;
  plot.x_label = choice.x.empty() ? "cases below, %" : choice.x;
  for (const auto& file : files) {
    demand_file(file);
    const auto table = hdf5::read_outcomes(file);
    for (const auto& name : names) {
      VectorXd y = find_outcome(table, file, name);
      VectorXd x = choice.x.empty() ? y : find_outcome(table, file, choice.x);
      std::vector<Eigen::Index> kept;
      for (Eigen::Index i = 0; i < y.size(); ++i)
        if (std::isfinite(x[i]) && std::isfinite(y[i])) kept.push_back(i);
      if (std::ssize(kept) < y.size())
        diagnostics.note("cli.cases-left-out", {file},
                         fmt::format("{} of {} cases have no value of {}: left out", y.size() - std::ssize(kept),
                                     y.size(), choice.x.empty() ? name : name + " or " + choice.x),
                         "look at their errors in the table of the campaign");
      x = x(kept).eval();
      y = y(kept).eval();
      const std::string label = (files.size() > 1 ? fs::path(file).stem().string() + " " : "") +
                                (names.size() > 1 || files.size() == 1 ? name : "");
      if (!choice.x.empty()) {
        plot.curves.push_back({label, std::move(x), std::move(y), true});
        continue;
      }
      std::sort(y.begin(), y.end());
      const auto n = y.size();
      plot.curves.push_back({label,
                             n > 1 ? VectorXd(VectorXd::LinSpaced(n, 0, 100)) : VectorXd(VectorXd::Constant(n, 50)),
                             std::move(y), n == 1});
    }
  }
  return plot;
}

std::vector<report::Plot> shape_plots(std::vector<report::Plot> plots, const CurveChoice& choice, bool is_over_time,
                                      Diagnostics& diagnostics) {
  for (auto& plot : plots) {
    for (auto& curve : plot.curves) {
      if (is_over_time && (choice.psd || choice.spectrum)) take_spectrum(curve, choice, diagnostics);
      if (is_over_time && !choice.srs.empty()) take_shock_spectrum(curve, choice, diagnostics);
    }
    if (is_over_time && !choice.srs.empty()) {
      plot.x_label = "natural " + (plot.x_label.starts_with("frequency") ? plot.x_label : report::label_frequency({}));
      plot.y_label = fmt::format("{}, {}, Q {:g}", choice.srs, choice.srs_part, choice.quality);
      plot.has_log_x = plot.has_log_y = true;
    }
    if (is_over_time && (choice.psd || choice.spectrum) && !plot.x_label.starts_with("frequency"))
      plot.x_label = report::label_frequency({});
    plot.has_log_x = plot.has_log_x || choice.log_x;
    plot.has_log_y = plot.has_log_y || (is_over_time && (choice.log_y || choice.psd));
  }
  if (!choice.subplots) return plots;
  std::vector<report::Plot> single;
  for (auto& plot : plots)
    for (auto& curve : plot.curves) {
      auto one = plot;
      one.y_label = curve.label;
      one.curves = {std::move(curve)};
      one.curves.front().label.clear();
      one.x_label.clear();
      if (!single.empty()) one.title.clear();
      single.push_back(std::move(one));
    }
  if (!single.empty()) single.back().x_label = plots.back().x_label;
  return single;
}

}  // namespace bough::analysis
