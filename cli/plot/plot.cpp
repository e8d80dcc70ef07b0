#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "cli/common/channels.hpp"
#include "cli/common/console.hpp"
#include "cli/common/converter.hpp"
#include "cli/common/options.hpp"
#include "cli/common/text_file.hpp"
#include "cli/plot/linear_plots.hpp"
#include "cli/plot/response_plots.hpp"
#include "formats/report/svg_plot.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

namespace {

struct PlotOptions : CommonOptions {
  std::vector<std::string> files;
  std::vector<std::string> sensors;
  std::vector<std::string> labels;
  std::vector<std::string> points;
  std::string title, x_label = "time", y_label;
  double y_min = 0, y_max = 0;
  bool has_limits = false;
  LinearPlotChoice linear;
};

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

/// The library behind rsvg-convert draws the same picture as points or as pages.
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

/// The file to write: as given, or `otherwise` with .svg.
std::string choose_picture(const PlotOptions& o, std::string otherwise) {
  if (const auto ending = fs::path(o.output).extension().string(); !ending.empty() && !has_suffix(o.output, ".svg") &&
                                                                   !has_suffix(o.output, ".png") &&
                                                                   !has_suffix(o.output, ".pdf"))
    throw InputError("cli.picture-format", {o.output}, "no picture format " + ending, "choose .svg, .png or .pdf");
  if (!o.output.empty()) return o.output;
  for (char& c : otherwise)
    if (c == '/' || c == ':') c = '_';
  return otherwise + ".svg";
}

/// Stacked plots of linear models, and of responses of decks.
int draw_plots(const PlotOptions& o, std::vector<report::Plot> plots, const std::string& otherwise,
               const Console& console) {
  plots.front().title = o.title;
  for (auto& plot : plots) {
    for (std::size_t i = 0; i < std::min(o.labels.size(), plot.curves.size()); ++i)
      if (&plot == &plots.front()) plot.curves[i].label = o.labels[i];
    if (&plot == &plots.front() && o.has_limits) plot.y_min = o.y_min, plot.y_max = o.y_max;
  }
  if (!o.y_label.empty()) plots.front().y_label = o.y_label;
  for (const auto& path : o.points) plots.front().curves.push_back(read_points(path));
  const auto output = choose_picture(o, otherwise);
  auto inputs = o.files;
  inputs.insert(inputs.end(), o.points.begin(), o.points.end());
  check_output(o, output, inputs);
  write_picture(output, plots.size() == 1 ? report::draw_svg(plots.front()) : report::draw_svg(plots));
  console.print("written: " + output + "\n");
  return kSuccess;
}

int run_plot(const PlotOptions& o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  Diagnostics diagnostics;
  if (o.has_limits && !(o.y_min < o.y_max))
    throw InputError("cli.bad-range", {}, fmt::format("the axis from {:g} to {:g} is empty", o.y_min, o.y_max),
                     "give --y-max above --y-min");
  if (!o.linear.kind.empty())
    return draw_plots(o, make_linear_plots(o.files, o.linear),
                      fs::path(o.files.front()).stem().string() + "-" + o.linear.kind, console);
  if (o.sensors.empty())
    throw InputError("cli.nothing-to-plot", {}, "neither --sensor nor --kind says what to draw",
                     "give --sensor NAME of results, or --kind bode of a linear model");
  if (is_deck_response(o.files))
    return draw_plots(o, make_response_plots(o.files, o.sensors), o.sensors.front(), console);
  report::Plot plot;
  plot.title = o.title.empty() ? fmt::format("{}", fmt::join(o.sensors, ", ")) : o.title;
  plot.x_label = o.x_label;
  plot.y_label = o.y_label.empty() && o.sensors.size() == 1 ? o.sensors.front() : o.y_label;
  plot.y_min = o.y_min;
  plot.y_max = o.y_max;
  for (const auto& file : o.files) {
    demand_file(file);
    warn_incomplete(file, diagnostics);
    const auto results = hdf5::read_results(file);
    for (const auto& sensor : o.sensors) {
      for (auto& column : choose_columns(results, file, sensor)) {
        const bool one_curve_a_file = o.sensors.size() == 1 && sensor.find(':') != std::string::npos;
        std::string label = o.files.size() > 1 ? fs::path(file).stem().string() : "";
        if (o.files.size() == 1 || !one_curve_a_file) label += (label.empty() ? "" : " ") + column.name;
        if (plot.curves.size() < o.labels.size()) label = o.labels[plot.curves.size()];
        plot.curves.push_back({label, results.time, std::move(column.values), false});
      }
    }
  }
  for (const auto& path : o.points) {
    plot.curves.push_back(read_points(path));
    if (plot.curves.size() <= o.labels.size()) plot.curves.back().label = o.labels[plot.curves.size() - 1];
  }
  if (o.labels.size() > plot.curves.size())
    diagnostics.warning("cli.labels-left", {},
                        fmt::format("there are {} and {}: the last ones are not used", count(o.labels.size(), "label"),
                                    count(plot.curves.size(), "curve")),
                        "give one --label a curve, in the order of the files and sensors, then of --points");
  const std::string output = choose_picture(o, o.sensors.front());
  auto inputs = o.files;
  inputs.insert(inputs.end(), o.points.begin(), o.points.end());
  check_output(o, output, inputs);
  write_picture(output, report::draw_svg(plot));
  console.print(diagnostics);
  console.print("written: " + output + "\n");
  return kSuccess;
}

}  // namespace

void add_plot(CLI::App& app, Action& action) {
  auto o = std::make_shared<PlotOptions>();
  auto* verb = app.add_subcommand("plot", "Curves of results against time, or a linear model, as a picture");
  verb->add_option("files", o->files, "HDF5 files: results, or with --kind linear models or sweeps")->required();
  verb->add_option("--sensor", o->sensors,
                   "Sensor NAME or NAME:component, or a path such as /energy/strain; of responses of decks "
                   "displacement:12:3; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--kind", o->linear.kind,
                   "Of linear models: bode, nichols, sigma (singular values) or poles; of what linearize --sweep or "
                   "--each wrote: campbell (frequencies over the parameter) or locus")
      ->check(CLI::IsMember(list_plot_kinds()))
      ->excludes("--sensor");
  verb->add_option("--inputs", o->linear.inputs, "With --kind: only these inputs")->delimiter(',')->needs("--kind");
  verb->add_option("--outputs", o->linear.outputs, "With --kind: only these outputs")->delimiter(',')->needs("--kind");
  verb->add_option("--points", o->points, "CSV file of x,y drawn as markers: reference points; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--label", o->labels, "Label of each curve in turn, then of each --points; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--title", o->title, "Title");
  verb->add_option("--x-label", o->x_label, "Label of the time axis")->capture_default_str();
  verb->add_option("--y-label", o->y_label, "Label of the other axis");
  auto* low = verb->add_option("--y-min", o->y_min, "Lower end of the y axis; curves are clipped");
  auto* high = verb->add_option("--y-max", o->y_max, "Upper end of the y axis");
  low->needs(high)->each([o](const std::string&) { o->has_limits = true; });
  high->needs(low);
  add_common_options(*verb, *o, kOutput, "Picture: .svg, .png or .pdf (default: the sensor's name with .svg, here)");
  verb->footer(
      "Example:\n  bough plot spinup.h5 --sensor tip_deflection:y -o tip.svg\n"
      "  bough plot spinup.h5 spinup-no-kg.h5 --sensor tip_deflection:y --y-min -1.2 --y-max 0.2 -o tip.svg\n"
      "  bough plot arm-linear.h5 --kind bode --outputs tip:y -o bode.svg\n"
      "  bough plot campbell.h5 --kind campbell -o campbell.svg");
  verb->callback([&action, o] { action = [o] { return run_plot(*o); }; });
}

}  // namespace bough::cli
