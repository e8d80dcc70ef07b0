#include "analysis/plot/response_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "analysis/common/body_files.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/export/export_matrices.hpp"
#include "base/diagnostic.hpp"
#include "formats/export/random_text.hpp"
#include "formats/export/response_text.hpp"
#include "formats/hdf5/response_file.hpp"
#include "formats/hdf5/sweep_file.hpp"

namespace bough::analysis {
namespace {

using exports::NamedCurve;

void add_response_curve(const NamedCurve& curve, const Eigen::VectorXd& x, const std::string& label, bool has_decades,
                        std::vector<report::Plot>& plots) {
  if (curve.imag.size() == 0) {
    plots[0].curves.push_back({label, x, curve.real});
    return;
  }
  Eigen::VectorXd magnitude(x.size()), degrees(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const auto [size, phase] = exports::to_polar(curve.real(i), curve.imag(i));
    magnitude(i) = has_decades ? size : size > 0 ? 20 * std::log10(size) : std::nan("");
    degrees(i) = size > 0 ? phase : std::nan("");
    if (i > 0 && std::isfinite(degrees(i - 1))) degrees(i) -= 360 * std::round((degrees(i) - degrees(i - 1)) / 360);
  }
  plots[0].curves.push_back({label, x, magnitude});
  plots[1].curves.push_back({"", x, degrees});
}

bool is_named(const std::string& curve, const std::string& name) {
  return curve == name || curve.substr(0, curve.rfind(':')) == name;
}

std::string list_start(const std::vector<std::string>& known) {
  constexpr std::size_t kMax = 8;
  const auto count = std::min(known.size(), kMax);
  std::string list = known.empty() ? "the file has none" : "choose one of ";
  for (std::size_t i = 0; i < count; ++i) list += (i > 0 ? ", " : "") + known[i];
  return list + (known.size() > kMax ? ", ..." : "");
}

/// Draws the curves of the file that have the name; without one, error cli.unknown-channel.
template <class Curves, class Draw>
void draw_named(const std::string& file, const std::string& name, const Curves& curves, const Draw& draw) {
  bool is_found = false;
  std::vector<std::string> known;
  for (const auto& curve : curves) {
    known.push_back(curve.name);
    if (!is_named(curve.name, name)) continue;
    is_found = true;
    draw(curve);
  }
  if (is_found) return;
  const auto nearest = find_nearest(name, known);
  throw InputError("cli.unknown-channel", {file}, "no curve \"" + name + "\"",
                   nearest.empty() ? list_start(known) : "did you mean \"" + nearest + "\"");
}

/// Beginning of the labels of the curves of a file: its name, where there are several.
std::string name_file(const std::vector<std::string>& files, const std::string& file) {
  return files.size() > 1 ? std::filesystem::path(file).stem().string() + " " : "";
}

void cut_window(const std::string& file, const std::vector<double>& window, std::vector<report::Plot>& plots) {
  if (window.empty()) return;
  for (auto& plot : plots)
    for (auto& curve : plot.curves) {
      const auto inside = (curve.x.array() >= window[0] && curve.x.array() <= window[1]).eval();
      if (!inside.any())
        throw InputError("cli.bad-range", {file}, "no sample lies in the window", "give another --window");
      Eigen::Index first = 0, last = curve.x.size() - 1;  // x ascends
      while (!inside[first]) ++first;
      while (!inside[last]) --last;
      curve.x = curve.x.segment(first, last - first + 1).eval();
      curve.y = curve.y.segment(first, last - first + 1).eval();
    }
}

struct Density {
  std::string prefix, name;
  Eigen::VectorXd hz, psd;
  double rms = 0;
};

/// Lists the densities of a deck (`frequency`) or of a linear model (`response --psd`).
std::vector<Density> list_densities(const std::string& file) {
  demand_file(file);
  std::vector<Density> found;
  if (read_file_format(file) == "bough-response") {
    const auto read = hdf5::read_model_response(file);
    const auto& random = read.random;
    for (Eigen::Index i = 0; i < random.psd.cols(); ++i)
      found.push_back({"", random.outputs.name[static_cast<std::size_t>(i)], random.frequency_hz, random.psd.col(i),
                       random.rms[i]});
    if (found.empty())
      throw InputError("cli.no-random", {file}, "--psd: the file has no random response",
                       "write it by bough response MODEL --psd INPUT=NUMBER -o FILE");
    return found;
  }
  const auto response = hdf5::read_response(file);
  if (response.random.empty())
    throw InputError("cli.no-random", {file}, "--psd: the file has no random response",
                     "write RANDOM with RANDPS in the deck, or leave --psd out");
  for (const auto& random : response.random)
    for (const auto& output : exports::list_random_outputs(random))
      found.push_back({response.random.size() > 1 ? "random " + std::to_string(random.set) + " " : "", output.name,
                       random.hz, output.curves->psd.col(output.column), output.curves->rms(output.column)});
  return found;
}

}  // namespace

bool is_deck_response(const std::vector<std::string>& files) {
  if (files.empty() || !has_suffix(files.front(), ".h5")) return false;
  demand_file(files.front());
  const auto format = read_file_format(files.front());
  return format == "bough-frequency" || format == "bough-transient";
}

std::vector<report::Plot> make_response_plots(const std::vector<std::string>& files,
                                              const std::vector<std::string>& names, const std::vector<double>& window,
                                              bool has_decades) {
  std::vector<report::Plot> plots(1);
  for (const auto& file : files) {
    demand_file(file);
    const auto response = hdf5::read_response(file);
    const bool is_over_time = response.is_over_time;
    plots.resize(is_over_time ? 1 : 2);
    for (auto& plot : plots) plot.x_label = is_over_time ? "time" : "frequency [Hz]";
    plots[0].y_label = is_over_time ? "" : has_decades ? "magnitude" : "magnitude [dB]";
    plots[0].has_log_y = has_decades;
    if (!is_over_time) {
      plots[1].y_label = "phase [degrees]";
      plots[1].y_step = 45;
      plots[0].x_label.clear();
    }
    for (const auto& subcase : response.subcases) {
      const auto curves = exports::list_curves(subcase);
      const auto& x = subcase.x;
      const bool is_wide = !is_over_time && x.size() > 1 && x(0) > 0 && x(x.size() - 1) > 30 * x(0);
      for (auto& plot : plots) plot.has_log_x = is_wide;
      for (const auto& name : names)
        draw_named(file, name, curves, [&](const auto& curve) {
          std::string label = name_file(files, file);
          if (response.subcases.size() > 1) label += "subcase " + std::to_string(subcase.id) + " ";
          add_response_curve(curve, x, label + curve.name, has_decades, plots);
        });
    }
  }
  cut_window(files.front(), window, plots);
  return plots;
}

std::vector<report::Plot> make_density_plots(const std::vector<std::string>& files,
                                             const std::vector<std::string>& names, const std::vector<double>& window) {
  std::vector<report::Plot> plots(1);
  plots[0].x_label = "frequency [Hz]";
  plots[0].y_label = "spectral density [unit²/Hz]";
  plots[0].has_log_x = plots[0].has_log_y = true;
  for (const auto& file : files) {
    const auto densities = list_densities(file);
    for (const auto& name : names)
      draw_named(file, name, densities, [&](const auto& density) {
        const std::string label =
            name_file(files, file) + fmt::format("{}{}, RMS {:.4g}", density.prefix, density.name, density.rms);
        plots[0].curves.push_back({label, density.hz, density.psd});
      });
  }
  cut_window(files.front(), window, plots);
  return plots;
}

}  // namespace bough::analysis
