#include "analysis/plot/plot.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>

#include "analysis/common/inputs.hpp"
#include "analysis/common/text_file.hpp"
#include "cli/common/console_events.hpp"
#include "cli/common/number_checks.hpp"
#include "cli/common/options.hpp"
#include "cli/common/usage_text.hpp"
#include "report/shock_spectrum.hpp"
#include "report/terminal_plot.hpp"

namespace bough::cli {

namespace {

struct PlotOptions : CommonOptions {
  analysis::PlotRequest request;
  bool term = false;
  std::string csv;
};

/// The file to write: as given, or `otherwise` with .svg.
std::string choose_picture(const PlotOptions& o, std::string otherwise) {
  if (const auto ending = std::filesystem::path(o.output).extension().string();
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
    // No axis has room for its label here.
    if (!named.y_label.empty() && named.title != named.y_label)
      named.title += (named.title.empty() ? "" : ": ") + named.y_label;
    text += report::draw_text(named, choose_width(), height, has_color);
  }
  console.print_data(text);
}

int run_plot(const PlotOptions& o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  auto request = o.request;
  request.has_csv = !o.csv.empty();
  ConsoleEvents events(console);
  const auto answer = analysis::make_plots(request, events);
  const auto& plots = answer.plots;
  const bool has_picture = !o.output.empty() || (!o.term && o.csv.empty());
  const auto output = has_picture ? choose_picture(o, answer.name) : "";
  auto inputs = request.files;
  inputs.insert(inputs.end(), request.points.begin(), request.points.end());
  check_outputs(o, {output, o.csv}, inputs);
  if (o.term) {
    console.print(events.get_messages());
    print_plots(plots, console);
  }
  if (!o.csv.empty()) {
    analysis::write_text_file(o.csv, answer.csv);
    print_written_files(o, console, {o.csv});
  }
  if (!has_picture) {
    if (!o.term) console.print(events.get_messages());
    return kSuccess;
  }
  analysis::write_picture(output, plots.size() == 1 ? report::draw_svg(plots.front()) : report::draw_svg(plots));
  if (!o.term) console.print(events.get_messages());
  return print_written_files(o, console, {output});
}

}  // namespace

void add_plot(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_plot, "plot");
  verb->add_option("files", o->request.files, "HDF5 files: results, or with --kind linear models or sweeps")
      ->required();
  verb->add_option("--sensor,--channel", o->request.sensors,
                   "Sensor NAME or NAME:component, or a path such as /energy/strain; of responses of decks "
                   "displacement:12:3; of outcomes.h5 a column; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--kind", o->request.linear.kind,
                   "Of linear models: bode, nichols, sigma (singular values) or poles; of what linearize --sweep or "
                   "--each wrote: campbell (frequencies over the parameter) or locus")
      ->check(CLI::IsMember(analysis::list_plot_kinds()))
      ->excludes("--sensor");
  verb->add_option("--inputs", o->request.linear.inputs, "With --kind: only these inputs")
      ->delimiter(',')
      ->needs("--kind");
  verb->add_option("--outputs", o->request.linear.outputs, "With --kind: only these outputs")
      ->delimiter(',')
      ->needs("--kind");
  verb->add_option("--per-rev", o->request.linear.per_rev,
                   "--kind campbell: lines of 1 to N times the parameter, a rate of rotation in rad per unit of time "
                   "(default: if a speed of the system is the parameter)")
      ->check(is_within(1, 100))
      ->needs("--kind");
  auto& c = o->request.curves;
  verb->add_option("--x", c.x, "Against this channel instead of the time; of outcomes.h5 a point a case")
      ->excludes("--kind");
  verb->add_option("--window", c.window, "Only times from T0 to T1, as T0,T1")
      ->delimiter(',')
      ->expected(2)
      ->excludes("--kind");
  auto* psd =
      verb->add_flag("--psd", c.psd,
                     "Power spectral density (Welch, Hann's window, overlap of a half); of random responses their own")
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
      ->check(is_within(0.51, 1e9))
      ->check(make_finite())
      ->needs(srs)
      ->capture_default_str();
  verb->add_option("--segment", c.segment, "--psd: samples of a segment")
      ->check(is_within(2, 1 << 30))
      ->needs(psd)
      ->capture_default_str();
  verb->add_flag("--difference", c.difference, "Each further file minus the first one")
      ->excludes("--x")
      ->excludes("--kind");
  verb->add_flag("--subplots", c.subplots, "Each curve in a separate plot, one above the other")->excludes("--kind");
  verb->add_flag("--log-x", c.log_x, "Decades below")->excludes("--kind");
  verb->add_flag("--log-y", c.log_y,
                 "Decades upward; --psd has them; of a deck's response over frequency instead of dB")
      ->excludes("--kind");
  verb->add_flag("--term", o->term, "Print the curves in the terminal; a picture too only with -o");
  verb->add_option("--csv", o->csv, "Write name and points of the curves, as curve,x,y; a picture too only with -o");
  verb->add_option("--points", o->request.points, "CSV file of x,y drawn as markers: reference points; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--label", o->request.labels, "Label of each curve in turn, then of each --points; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--title", o->request.title, "Title");
  verb->add_option("--x-label", o->request.x_label, "Label of the axis below");
  verb->add_option("--y-label", o->request.y_label, "Label of the other axis");
  auto* low = verb->add_option("--y-min", o->request.y_min, "Lower end of the y axis; curves are clipped")
                  ->check(make_finite());
  auto* high = verb->add_option("--y-max", o->request.y_max, "Upper end of the y axis")->check(make_finite());
  low->needs(high)->each([o = o](const std::string&) { o->request.has_limits = true; });
  high->needs(low);
  add_common_options(*verb, *o, kOutput, "Picture: .svg, .png or .pdf (default: the sensor's name with .svg, here)");
}

}  // namespace bough::cli
