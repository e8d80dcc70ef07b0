#include "analysis/plot/plot.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "analysis/common/body_files.hpp"
#include "analysis/common/choices.hpp"
#include "analysis/common/converter.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/text_file.hpp"
#include "analysis/plot/response_plots.hpp"
#include "base/words.hpp"
#include "formats/export/csv.hpp"
#include "report/label.hpp"
#include "report/shock_spectrum.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;

namespace {

/// Two numeric columns of a CSV file; lines that start with # or a letter are skipped.
report::Curve read_points(const std::string& path) {
  demand_file(path);
  std::ifstream in(path);
  std::vector<double> x, y;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty() || line[0] == '#' || std::isalpha(static_cast<unsigned char>(line[0]))) continue;
    char* end = nullptr;
    const double a = std::strtod(line.c_str(), &end);
    char* last = nullptr;
    const double b = *end == ',' ? std::strtod(end + 1, &last) : 0;
    if (end == line.c_str() || *end != ',' || last == end + 1) {
      throw InputError("cli.bad-points", {path, number}, "expected two numbers separated by a comma",
                       "write x,y on each line");
    }
    x.push_back(a);
    y.push_back(b);
  }
  const auto n = static_cast<Eigen::Index>(x.size());
  return {fs::path(path).stem().string(), Eigen::Map<Eigen::VectorXd>(x.data(), n),
          Eigen::Map<Eigen::VectorXd>(y.data(), n), true};
}

/// The name in a legend; of the curve below it that has none, as phases have, that of the first plot.
std::string name_curve(const std::vector<report::Plot>& plots, std::size_t plot, std::size_t curve) {
  const auto& own = plots[plot];
  std::string name = own.curves[curve].label;
  if (name.empty() && curve < plots.front().curves.size()) name = plots.front().curves[curve].label;
  if (plots.size() > 1 || name.empty())
    name += (name.empty() || own.y_label.empty() ? "" : ", ") + (own.y_label.empty() ? own.title : own.y_label);
  return name;
}

/// curve,x,y: name and points of every curve as it is drawn, all digits.
std::string make_curves_csv(const std::vector<report::Plot>& plots) {
  std::string text = "curve,x,y\n";
  for (std::size_t p = 0; p < plots.size(); ++p)
    for (std::size_t c = 0; c < plots[p].curves.size(); ++c) {
      const auto& curve = plots[p].curves[c];
      const auto name = exports::write_csv_field(name_curve(plots, p, c));
      for (Eigen::Index i = 0; i < curve.x.size(); ++i)
        if (!std::isnan(curve.y[i]))  // not drawn
          text += fmt::format("{},{:.17g},{:.17g}\n", name, curve.x[i], curve.y[i]);
    }
  return text;
}

/// Applies the options to the first plot, and adds the reference points.
void finish_plots(const PlotRequest& request, PlotAnswer& answer, Diagnostics& diagnostics) {
  auto& plots = answer.plots;
  if (!request.title.empty()) plots.front().title = request.title;
  std::size_t number = 0;
  for (auto& plot : plots) {
    for (auto& curve : plot.curves)
      if (number < request.labels.size() && (&plot == &plots.front() || request.curves.subplots)) {
        (request.curves.subplots ? plot.y_label : curve.label) = request.labels[number++];
      }
    if (request.has_limits && &plot == &plots.front()) plot.y_min = request.y_min, plot.y_max = request.y_max;
  }
  if (!request.y_label.empty()) plots.front().y_label = request.y_label;
  if (!request.x_label.empty()) plots.back().x_label = request.x_label;
  for (const auto& path : request.points) {
    plots.front().curves.push_back(read_points(path));
    if (number < request.labels.size()) plots.front().curves.back().label = request.labels[number++];
  }
  if (request.has_csv) answer.csv = make_curves_csv(plots);
  for (auto& plot : plots)
    if (request.y_label.empty() || &plot != &plots.front()) report::label_units(plot);
  if (number < request.labels.size())
    diagnostics.warning("cli.labels-left", {},
                        fmt::format("there are {} and {}: the last ones are not used",
                                    count(request.labels.size(), "label"), count(number, "curve")),
                        "give one --label a curve, in the order of the files and sensors, then of --points");
}

/// Rejects curves that are of two kinds, and words and numbers of curves that are none.
void check_curves(const CurveChoice& c) {
  std::vector<std::string> kinds;
  if (c.psd) kinds.emplace_back("--psd");
  if (c.spectrum) kinds.emplace_back("--spectrum");
  if (!c.srs.empty()) kinds.emplace_back("--srs");
  if (!kinds.empty() && !c.x.empty()) kinds.emplace_back("--x");
  if (kinds.size() > 1)
    throw InputError("cli.plot-option", {}, fmt::format("{} exclude each other", fmt::join(kinds, ", ")),
                     "give one of them");
  if (c.psd) demand_range("--segment", static_cast<long>(c.segment), 2L, 1L << 30);
  if (c.srs.empty()) return;
  demand_word("--srs", c.srs, report::list_shock_kinds());
  demand_word("--srs-part", c.srs_part, report::list_shock_parts());
  demand_range("--q", c.quality, 0.51, 1e9);
  for (const double end : c.srs_range) demand_positive("--srs-range", end);
}

void check_choices(const PlotRequest& request) {
  demand_files(request.files);
  const auto& linear = request.linear;
  if (!linear.kind.empty()) demand_word("--kind", linear.kind, list_plot_kinds());
  if (linear.per_rev != 0) demand_range("--per-rev", static_cast<long>(linear.per_rev), 1L, 100L);
  if (linear.per_rev != 0 && linear.kind != "campbell")
    throw InputError("cli.plot-option", {}, "--per-rev of --kind " + linear.kind + " is not drawn",
                     "leave it out, or give --kind campbell");
  check_curves(request.curves);
  if (request.has_limits && !(request.y_min < request.y_max))
    throw InputError("cli.bad-range", {},
                     fmt::format("the axis from {:g} to {:g} is empty", request.y_min, request.y_max),
                     "give --y-max above --y-min");
  const auto& c = request.curves;
  if (!c.window.empty() && (c.window.size() != 2 || !(c.window[0] < c.window[1])))
    throw InputError("cli.bad-range", {}, fmt::format("the window {:g} is empty", fmt::join(c.window, " to ")),
                     "give --window T0,T1 with T1 above T0");
  if (c.difference && request.files.size() < 2)
    throw InputError("cli.nothing-to-plot", {}, "--difference takes two files", "name the run to subtract first");
}

/// Rejects options for curves that a file of this kind does not have.
void demand_unused(const std::string& file, const std::string& kind,
                   const std::vector<std::pair<const char*, bool>>& options) {
  std::vector<std::string> used;
  for (const auto& [name, is_used] : options)
    if (is_used) used.push_back(name);
  if (!used.empty())
    throw InputError("cli.plot-option", {file}, fmt::format("{} of {} is not drawn", fmt::join(used, ", "), kind),
                     "leave it out, or give results of a run");
}

std::string make_title(const std::string& content, const std::vector<std::string>& files) {
  return content + (files.size() == 1 ? ": " + fs::path(files.front()).stem().string() : "");
}

PlotAnswer choose_plots(const PlotRequest& request, Diagnostics& diagnostics) {
  check_choices(request);
  if (!request.linear.kind.empty())
    return {make_linear_plots(request.files, request.linear),
            {},
            fs::path(request.files.front()).stem().string() + "-" + request.linear.kind};
  if (request.sensors.empty())
    throw InputError("cli.nothing-to-plot", {}, "neither --sensor nor --kind is given",
                     "give --sensor NAME of results, or --kind bode of a linear model");
  if (is_deck_response(request.files)) {
    const auto& c = request.curves;
    const bool is_over_time = read_file_format(request.files.front()) == "bough-transient";
    demand_unused(request.files.front(), "a response of a deck",
                  {{"--x", !c.x.empty()}, {"--difference", c.difference}});
    if (!is_over_time)
      demand_unused(request.files.front(), "curves over frequency",
                    {{"--spectrum", c.spectrum}, {"--srs", !c.srs.empty()}});
    auto plots = c.psd && !is_over_time ? make_density_plots(request.files, request.sensors, c.window)
                                        : make_response_plots(request.files, request.sensors, c.window, c.log_y);
    plots.front().title = make_title(is_over_time ? "Transient response"
                                     : c.psd      ? "Spectral density"
                                                  : "Frequency response",
                                     request.files);
    for (const auto& sensor : request.sensors)
      if (!c.srs.empty() && !sensor.starts_with("acceleration"))
        warn_of_shock_input(request.files.front(), sensor, "a " + sensor.substr(0, sensor.find(':')), diagnostics);
    plots = shape_plots(std::move(plots), c, is_over_time, diagnostics);
    return {std::move(plots), {}, request.sensors.front()};
  }
  demand_file(request.files.front());
  if (read_file_format(request.files.front()) == "bough-response") {
    const auto& c = request.curves;
    demand_unused(
        request.files.front(), "a response of a linear model",
        {{"--x", !c.x.empty()}, {"--difference", c.difference}, {"--spectrum", c.spectrum}, {"--srs", !c.srs.empty()}});
    if (!c.psd)
      throw InputError("cli.nothing-to-plot", {request.files.front()},
                       "a response of a linear model has no curves over time",
                       "add --psd for its spectral densities, or draw the model by --kind bode");
    auto plots = make_density_plots(request.files, request.sensors, c.window);
    plots.front().title = make_title("Spectral density", request.files);
    return {shape_plots(std::move(plots), c, false, diagnostics), {}, request.sensors.front()};
  }
  const bool is_campaign = read_file_format(request.files.front()) == "bough-outcomes";
  if (is_campaign)
    demand_unused(request.files.front(), "a campaign",
                  {{"--psd", request.curves.psd},
                   {"--spectrum", request.curves.spectrum},
                   {"--srs", !request.curves.srs.empty()},
                   {"--difference", request.curves.difference},
                   {"--window", !request.curves.window.empty()}});
  auto plot = is_campaign ? make_campaign_plot(request.files, request.sensors, request.curves, diagnostics)
                          : make_history_plot(request.files, request.sensors, request.curves, diagnostics);
  // Axes of --subplots are named after their channels already.
  const bool names_run = request.curves.subplots && !is_campaign && request.files.size() == 1;
  plot.title =
      names_run ? fs::path(request.files.front()).stem().string() : fmt::format("{}", fmt::join(request.sensors, ", "));
  if (request.sensors.size() == 1) plot.y_label = request.sensors.front();
  const bool is_over_time = !is_campaign && request.curves.x.empty();
  if (is_over_time && request.curves.psd) plot.y_label += plot.y_label.empty() ? "PSD" : ", PSD";
  plot.has_log_y = request.curves.log_y;
  return {shape_plots({std::move(plot)}, request.curves, is_over_time, diagnostics), {}, request.sensors.front()};
}

}  // namespace

PlotAnswer make_plots(const PlotRequest& request, Events& events) {
  Diagnostics diagnostics;
  auto answer = choose_plots(request, diagnostics);
  finish_plots(request, answer, diagnostics);
  add_messages(diagnostics, events);
  return answer;
}

/// The library of rsvg-convert draws the same picture as points or as pages.
void write_picture(const std::string& path, const std::string& svg) {
  const std::string format = has_suffix(path, ".png") ? "png" : has_suffix(path, ".pdf") ? "pdf" : "svg";
  if (format == "svg") return write_text_file(path, svg);
  write_converted(path, svg,
                  {"rsvg-convert", "librsvg2-bin", "write .svg",
                   [&](const std::string& source, const std::string& output) -> std::vector<std::string> {
                     return {"--zoom=2", "--background-color=white", "--format=" + format, "--output=" + output, "--",
                             source};
                   }});
}

}  // namespace bough::analysis
