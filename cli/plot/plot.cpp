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

int run_plot(const PlotOptions& o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  Diagnostics diagnostics;
  if (o.has_limits && !(o.y_min < o.y_max))
    throw InputError("cli.bad-range", {}, fmt::format("the axis from {:g} to {:g} is empty", o.y_min, o.y_max),
                     "give --y-max above --y-min");
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
  std::string output = o.output;
  if (const auto ending = fs::path(output).extension().string();
      !ending.empty() && !has_suffix(output, ".svg") && !has_suffix(output, ".png") && !has_suffix(output, ".pdf"))
    throw InputError("cli.picture-format", {output}, "no picture format " + ending, "choose .svg, .png or .pdf");
  if (output.empty()) {
    output = o.sensors.front() + ".svg";
    for (char& c : output)
      if (c == '/' || c == ':') c = '_';
  }
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
  auto* verb = app.add_subcommand("plot", "Curves of one or several results files against time, as a picture");
  verb->add_option("files", o->files, "Results HDF5 files")->required();
  verb->add_option("--sensor", o->sensors,
                   "Sensor NAME or NAME:component, or a path such as /energy/strain; may be repeated")
      ->required()
      ->allow_extra_args(false);
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
      "  bough plot spinup.h5 spinup-no-kg.h5 --sensor tip_deflection:y --y-min -1.2 --y-max 0.2 -o tip.svg");
  verb->callback([&action, o] { action = [o] { return run_plot(*o); }; });
}

}  // namespace bough::cli
