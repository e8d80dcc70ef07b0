#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "analysis/common/body_files.hpp"
#include "analysis/common/converter.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/text_file.hpp"
#include "analysis/export/export_matrices.hpp"
#include "cli/common/console.hpp"
#include "cli/common/options.hpp"
#include "cli/plot/history_plots.hpp"
#include "cli/plot/linear_plots.hpp"
#include "cli/plot/response_plots.hpp"
#include "formats/export/csv.hpp"
#include "formats/report/label.hpp"
#include "formats/report/shock_spectrum.hpp"
#include "formats/report/svg_plot.hpp"
#include "formats/report/terminal_plot.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

namespace {

struct PlotOptions : CommonOptions {
  std::vector<std::string> files;
  std::vector<std::string> sensors;
  std::vector<std::string> labels;
  std::vector<std::string> points;
  std::string title, x_label, y_label;
  double y_min = 0, y_max = 0;
  bool has_limits = false;
  LinearPlotChoice linear;
  CurveChoice curves;
  bool term = false;
  std::string csv;
};

/// Two numeric columns of a CSV file; lines that start with # or a letter are skipped.
report::Curve read_points(const std::string& path) {
  analysis::demand_file(path);
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

/// The library of rsvg-convert draws the same picture as points or as pages.
void write_picture(const std::string& path, const std::string& svg) {
  const std::string format = analysis::has_suffix(path, ".png")   ? "png"
                             : analysis::has_suffix(path, ".pdf") ? "pdf"
                                                                  : "svg";
  if (format == "svg") return analysis::write_text_file(path, svg);
  analysis::write_converted(
      path, svg,
      {"rsvg-convert", "librsvg2-bin", "write .svg",
       [&](const std::string& source, const std::string& output) -> std::vector<std::string> {
         return {"--zoom=2", "--background-color=white", "--format=" + format, "--output=" + output, "--", source};
       }});
}

/// The file to write: as given, or `otherwise` with .svg.
std::string choose_picture(const PlotOptions& o, std::string otherwise) {
  if (const auto ending = fs::path(o.output).extension().string();
      !ending.empty() && !analysis::has_suffix(o.output, ".svg") && !analysis::has_suffix(o.output, ".png") &&
      !analysis::has_suffix(o.output, ".pdf"))
    throw InputError("cli.picture-format", {o.output}, "no picture format " + ending, "choose .svg, .png or .pdf");
  if (!o.output.empty()) return o.output;
  for (char& c : otherwise)
    if (c == '/' || c == ':') c = '_';
  return otherwise + ".svg";
}

/// Columns of the terminal; of a pipe as COLUMNS says, or 80.
int choose_width() {
  if (const auto width = get_terminal_width(); width > 0) return static_cast<int>(width);
  const char* columns = std::getenv("COLUMNS");
  const int width = columns != nullptr ? std::atoi(columns) : 0;
  return width > 0 ? std::min(width, 1000) : 80;
}

void print_plots(const std::vector<report::Plot>& plots, const Console& console) {
  const bool has_color = get_terminal_width() > 0 && std::getenv("NO_COLOR") == nullptr;
  const int height = plots.size() > 1 ? 10 : 16;
  std::string text;
  for (const auto& plot : plots) {
    auto named = plot;
    if (named.title.empty()) named.title = named.y_label;
    text += report::draw_text(named, choose_width(), height, has_color);
  }
  console.print_data(text);
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
        text += fmt::format("{},{:.17g},{:.17g}\n", name, curve.x[i], curve.y[i]);
    }
  return text;
}

/// Applies the options to the first plot, and adds the reference points; then draws the picture.
int draw_plots(const PlotOptions& o, std::vector<report::Plot> plots, const std::string& otherwise,
               const Diagnostics& diagnostics, const Console& console) {
  if (!o.title.empty()) plots.front().title = o.title;
  std::size_t number = 0;
  for (auto& plot : plots) {
    for (auto& curve : plot.curves)
      if (number < o.labels.size() && (&plot == &plots.front() || o.curves.subplots)) {
        (o.curves.subplots ? plot.y_label : curve.label) = o.labels[number++];
      }
    if (o.has_limits && &plot == &plots.front()) plot.y_min = o.y_min, plot.y_max = o.y_max;
  }
  if (!o.y_label.empty()) plots.front().y_label = o.y_label;
  if (!o.x_label.empty()) plots.back().x_label = o.x_label;
  for (const auto& path : o.points) {
    plots.front().curves.push_back(read_points(path));
    if (number < o.labels.size()) plots.front().curves.back().label = o.labels[number++];
  }
  const auto csv = o.csv.empty() ? "" : make_curves_csv(plots);
  for (auto& plot : plots)
    if (o.y_label.empty() || &plot != &plots.front()) report::label_units(plot);
  Diagnostics all = diagnostics;
  if (number < o.labels.size())
    all.warning("cli.labels-left", {},
                fmt::format("there are {} and {}: the last ones are not used", count(o.labels.size(), "label"),
                            count(number, "curve")),
                "give one --label a curve, in the order of the files and sensors, then of --points");
  const bool has_picture = !o.output.empty() || (!o.term && o.csv.empty());
  const auto output = has_picture ? choose_picture(o, otherwise) : "";
  auto inputs = o.files;
  inputs.insert(inputs.end(), o.points.begin(), o.points.end());
  check_outputs(o, {output, o.csv}, inputs);
  if (o.term) {
    console.print(all);
    print_plots(plots, console);
  }
  if (!o.csv.empty()) {
    analysis::write_text_file(o.csv, csv);
    console.print("written: " + o.csv + "\n");
  }
  if (!has_picture) {
    if (!o.term) console.print(all);
    return kSuccess;
  }
  write_picture(output, plots.size() == 1 ? report::draw_svg(plots.front()) : report::draw_svg(plots));
  if (!o.term) console.print(all);
  console.print("written: " + output + "\n");
  return kSuccess;
}

void check_choices(const PlotOptions& o) {
  if (o.has_limits && !(o.y_min < o.y_max))
    throw InputError("cli.bad-range", {}, fmt::format("the axis from {:g} to {:g} is empty", o.y_min, o.y_max),
                     "give --y-max above --y-min");
  const auto& c = o.curves;
  if (!c.window.empty() && !(c.window[0] < c.window[1]))
    throw InputError("cli.bad-range", {},
                     fmt::format("the window from {:g} to {:g} is empty", c.window[0], c.window[1]),
                     "give --window T0,T1 with T1 above T0");
  if (c.difference && o.files.size() < 2)
    throw InputError("cli.nothing-to-plot", {}, "--difference takes two files", "name the run to take off first");
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

int run_plot(const PlotOptions& o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  Diagnostics diagnostics;
  check_choices(o);
  if (!o.linear.kind.empty())
    return draw_plots(o, make_linear_plots(o.files, o.linear),
                      fs::path(o.files.front()).stem().string() + "-" + o.linear.kind, diagnostics, console);
  if (o.sensors.empty())
    throw InputError("cli.nothing-to-plot", {}, "neither --sensor nor --kind says what to draw",
                     "give --sensor NAME of results, or --kind bode of a linear model");
  if (is_deck_response(o.files)) {
    const auto& c = o.curves;
    const bool is_over_time = analysis::read_file_format(o.files.front()) == "bough-transient";
    demand_unused(o.files.front(), "a response of a deck", {{"--x", !c.x.empty()}, {"--difference", c.difference}});
    if (!is_over_time)
      demand_unused(o.files.front(), "curves over frequency", {{"--spectrum", c.spectrum}, {"--srs", !c.srs.empty()}});
    auto plots = c.psd && !is_over_time ? make_density_plots(o.files, o.sensors, c.window)
                                        : make_response_plots(o.files, o.sensors, c.window, c.log_y);
    plots = shape_plots(std::move(plots), c, is_over_time, diagnostics);
    return draw_plots(o, std::move(plots), o.sensors.front(), diagnostics, console);
  }
  analysis::demand_file(o.files.front());
  const bool is_campaign = analysis::read_file_format(o.files.front()) == "bough-outcomes";
  if (is_campaign)
    demand_unused(o.files.front(), "a campaign",
                  {{"--psd", o.curves.psd},
                   {"--spectrum", o.curves.spectrum},
                   {"--srs", !o.curves.srs.empty()},
                   {"--difference", o.curves.difference},
                   {"--window", !o.curves.window.empty()}});
  auto plot = is_campaign ? make_campaign_plot(o.files, o.sensors, o.curves, diagnostics)
                          : make_history_plot(o.files, o.sensors, o.curves, diagnostics);
  plot.title = fmt::format("{}", fmt::join(o.sensors, ", "));
  if (o.sensors.size() == 1) plot.y_label = o.sensors.front();
  const bool is_over_time = !is_campaign && o.curves.x.empty();
  if (is_over_time && o.curves.psd) plot.y_label += plot.y_label.empty() ? "PSD" : ", PSD";
  plot.has_log_y = o.curves.log_y;
  const auto plots = shape_plots({std::move(plot)}, o.curves, is_over_time, diagnostics);
  return draw_plots(o, plots, o.sensors.front(), diagnostics, console);
}

}  // namespace

void add_plot(CLI::App& app, Action& action) {
  auto o = std::make_shared<PlotOptions>();
  auto* verb = add_verb(app, "plot", "Curves of results against time, or a linear model, as a picture");
  verb->add_option("files", o->files, "HDF5 files: results, or with --kind linear models or sweeps")->required();
  verb->add_option("--sensor,--channel", o->sensors,
                   "Sensor NAME or NAME:component, or a path such as /energy/strain; of responses of decks "
                   "displacement:12:3; of outcomes.h5 a column; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--kind", o->linear.kind,
                   "Of linear models: bode, nichols, sigma (singular values) or poles; of what linearize --sweep or "
                   "--each wrote: campbell (frequencies over the parameter) or locus")
      ->check(CLI::IsMember(list_plot_kinds()))
      ->excludes("--sensor");
  verb->add_option("--inputs", o->linear.inputs, "With --kind: only these inputs")->delimiter(',')->needs("--kind");
  verb->add_option("--outputs", o->linear.outputs, "With --kind: only these outputs")->delimiter(',')->needs("--kind");
  auto& c = o->curves;
  verb->add_option("--x", c.x, "Against this channel instead of the time; of outcomes.h5 a point a case")
      ->excludes("--kind");
  verb->add_option("--window", c.window, "Only times from T0 to T1, as T0,T1")
      ->delimiter(',')
      ->expected(2)
      ->excludes("--kind");
  auto* psd =
      verb->add_flag(
              "--psd", c.psd,
              "Power spectral density (Welch, Hann's window, overlap of a half); of random responses of decks theirs")
          ->excludes("--kind");
  verb->add_flag("--spectrum", c.spectrum, "Amplitudes over frequency (Hann's window, straight line removed)")
      ->excludes(psd)
      ->excludes("--x")
      ->excludes("--kind");
  psd->excludes("--x");
  auto* srs = verb->add_option("--srs", c.srs,
                               "Shock response spectrum of a base acceleration: " +
                                   fmt::format("{}", fmt::join(report::list_shock_kinds(), ", ")))
                  ->check(CLI::IsMember(report::list_shock_kinds()))
                  ->excludes("--kind")
                  ->excludes("--x")
                  ->excludes("--spectrum")
                  ->excludes(psd);
  verb->add_option("--srs-part", c.srs_part, fmt::format("{}", fmt::join(report::list_shock_parts(), ", ")))
      ->check(CLI::IsMember(report::list_shock_parts()))
      ->needs(srs)
      ->capture_default_str();
  verb->add_option("--srs-range", c.srs_range, "F1,F2,N: from F1 to F2, N frequencies per octave (12)")
      ->delimiter(',')
      ->expected(2, 3)
      ->needs(srs);
  verb->add_option("--q", c.quality, "Q = 1/(2 damping ratio) of --srs")
      ->check(CLI::Range(0.51, 1e9))
      ->needs(srs)
      ->capture_default_str();
  verb->add_option("--segment", c.segment, "--psd: samples of a segment")
      ->check(CLI::Range(2, 1 << 30))
      ->needs(psd)
      ->capture_default_str();
  verb->add_flag("--difference", c.difference, "Each further file less the first one")
      ->excludes("--x")
      ->excludes("--kind");
  verb->add_flag("--subplots", c.subplots, "Each curve in a plot of its own, one above the other")->excludes("--kind");
  verb->add_flag("--log-x", c.log_x, "Decades below")->excludes("--kind");
  verb->add_flag("--log-y", c.log_y,
                 "Decades upward; --psd has them; of a deck's response over frequency instead of dB")
      ->excludes("--kind");
  verb->add_flag("--term", o->term, "Print the curves in the terminal; a picture too only with -o");
  verb->add_option("--csv", o->csv, "Write name and points of the curves, as curve,x,y; a picture too only with -o");
  verb->add_option("--points", o->points, "CSV file of x,y drawn as markers: reference points; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--label", o->labels, "Label of each curve in turn, then of each --points; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--title", o->title, "Title");
  verb->add_option("--x-label", o->x_label, "Label of the axis below");
  verb->add_option("--y-label", o->y_label, "Label of the other axis");
  auto* low = verb->add_option("--y-min", o->y_min, "Lower end of the y axis; curves are clipped");
  auto* high = verb->add_option("--y-max", o->y_max, "Upper end of the y axis");
  low->needs(high)->each([o](const std::string&) { o->has_limits = true; });
  high->needs(low);
  add_common_options(*verb, *o, kOutput, "Picture: .svg, .png or .pdf (default: the sensor's name with .svg, here)");
  verb->footer(
      "Example:\n  bough plot spinup.h5 --sensor tip_deflection:y -o tip.svg\n"
      "  bough plot spinup.h5 spinup-no-kg.h5 --sensor tip_deflection:y --y-min -1.2 --y-max 0.2 -o tip.svg\n"
      "  bough plot spinup.h5 --sensor /bodies/boom/eta:1 --psd --term\n"
      "  bough plot a.h5 b.h5 --sensor tip:y --difference --window 0,10 -o difference.svg\n"
      "  bough plot outcomes.h5 --sensor tip_max --x density -o scatter.svg\n"
      "  bough plot arm-linear.h5 --kind bode --outputs tip:y -o bode.svg\n"
      "  bough plot campbell.h5 --kind campbell -o campbell.svg");
  verb->callback([&action, o] { action = [o] { return run_plot(*o); }; });
}

}  // namespace bough::cli
