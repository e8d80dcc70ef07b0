#include "cli/plot/linear_plots.hpp"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <filesystem>
#include <map>
#include <numbers>

#include "cli/common/options.hpp"
#include "cli/export/export_matrices.hpp"
#include "cli/linearize/linear_model_files.hpp"
#include "formats/hdf5/linear_file.hpp"
#include "formats/hdf5/sweep_file.hpp"
#include "formats/report/pole_plot.hpp"
#include "solver/statespace/frequency_response.hpp"

namespace bough::cli {

namespace {

using Eigen::Index;
using Eigen::VectorXd;
using records::FrequencyResponse;
using report::Plot;

bool is_of_sweeps(const std::string& kind) { return kind == "campbell" || kind == "locus"; }

struct Curves {
  std::string name;
  VectorXd decibel, degrees;
};

std::vector<Curves> make_curves(const FrequencyResponse& response, const std::string& prefix) {
  std::vector<Curves> all;
  const Index count = response.frequency_hz.size();
  for (int j = 0; j < response.inputs.size(); ++j)
    for (int i = 0; i < response.outputs.size(); ++i) {
      Curves c{prefix + response.outputs.name[static_cast<std::size_t>(i)] + " / " +
                   response.inputs.name[static_cast<std::size_t>(j)],
               VectorXd(count), VectorXd(count)};
      for (Index k = 0; k < count; ++k) {
        const std::complex<double> h = response.value[static_cast<std::size_t>(k)](i, j);
        c.decibel[k] = h == 0.0 ? std::nan("") : 20 * std::log10(std::abs(h));
        double phase = h == 0.0 ? std::nan("") : std::arg(h) * 180 / std::numbers::pi;
        if (k > 0 && std::isfinite(c.degrees[k - 1])) phase -= 360 * std::round((phase - c.degrees[k - 1]) / 360);
        c.degrees[k] = phase;
      }
      all.push_back(std::move(c));
    }
  return all;
}

void add_response(const FrequencyResponse& response, const std::string& kind, const std::string& prefix,
                  std::vector<Plot>& plots) {
  if (kind == "sigma") {
    for (Index s = 0; s < response.singular_values.cols(); ++s) {
      const VectorXd decibel = 20 * response.singular_values.col(s).array().max(1e-300).log10();
      plots[0].curves.push_back({prefix + "sigma " + std::to_string(s + 1), response.frequency_hz, decibel});
    }
    return;
  }
  for (const auto& c : make_curves(response, prefix)) {
    if (kind == "nichols") {
      plots[0].curves.push_back({c.name, c.degrees, c.decibel});
      continue;
    }
    plots[0].curves.push_back({c.name, response.frequency_hz, c.decibel});
    plots[1].curves.push_back({"", response.frequency_hz, c.degrees});
  }
}

/// The branch of `among` whose conjugate b is wherever the two are complex; -1: none. They may part on the real axis.
int find_conjugate(const records::LinearSweep& sweep, Index b, const std::vector<Index>& among) {
  const double tolerance = 1e-9 * (sweep.real.cwiseAbs().maxCoeff() + sweep.imag.cwiseAbs().maxCoeff());
  for (std::size_t k = 0; k < among.size(); ++k) {
    const auto a = among[k];
    bool is_conjugate = true;
    for (Index i = 0; i < sweep.imag.rows() && is_conjugate; ++i)
      is_conjugate =
          std::abs(sweep.imag(i, a) + sweep.imag(i, b)) <= tolerance &&
          (std::abs(sweep.imag(i, b)) <= tolerance || std::abs(sweep.real(i, a) - sweep.real(i, b)) <= tolerance);
    if (is_conjugate) return static_cast<int>(k);
  }
  return -1;
}

/// Points of the locus, values x branches: in the s plane, of sampled models in the z plane.
struct Locus {
  Eigen::MatrixXd x, y;
};

Locus make_locus(const records::LinearSweep& sweep) {
  Locus locus{sweep.real, sweep.imag};
  if (sweep.models.front().sample_time == 0) return locus;
  for (Index k = 0; k < sweep.real.rows(); ++k)
    for (Index b = 0; b < sweep.real.cols(); ++b) {
      const auto z = records::calc_z(sweep, k, b);
      locus.x(k, b) = z.real();
      locus.y(k, b) = z.imag();
    }
  return locus;
}

void add_sweep(const records::LinearSweep& sweep, const std::string& kind, const std::string& prefix, Plot& plot) {
  if (kind == "campbell") plot.x_label = sweep.parameter;
  const double largest = sweep.frequency_hz.size() > 0 ? sweep.frequency_hz.maxCoeff() : 0;
  std::map<std::string, int> count_of;
  const auto make_name = [&](Index b) {
    const auto k = static_cast<std::size_t>(b);
    const auto &from = sweep.mode.front()[k], &to = sweep.mode.back()[k];
    const std::string name = prefix + (from == to ? from : from + " -> " + to);
    const int number = ++count_of[name];
    return number > 1 ? fmt::format("{} ({})", name, number) : name;
  };
  const Locus locus = make_locus(sweep);
  const auto draw = [&](Index b, const std::string& name, int style) {
    if (kind == "locus")
      plot.curves.push_back({name, locus.x.col(b), locus.y.col(b), false, style});
    else
      plot.curves.push_back({name, sweep.value, sweep.frequency_hz.col(b), false, style});
  };
  const auto stands_at_zero = [&](Index b) {
    if (records::is_gone(sweep, b)) return true;
    return kind == "campbell" && sweep.frequency_hz.col(b).maxCoeff() <= 1e-9 * largest;
  };
  std::vector<Index> upper, lower;
  for (Index b = 0; b < sweep.real.cols(); ++b) (sweep.imag.col(b).sum() < 0 ? lower : upper).push_back(b);
  std::vector<int> curve_of(upper.size(), -1);
  for (std::size_t k = 0; k < upper.size(); ++k) {
    if (stands_at_zero(upper[k])) continue;
    curve_of[k] = static_cast<int>(plot.curves.size());
    draw(upper[k], make_name(upper[k]), -1);
  }
  for (const Index b : lower) {
    // A pair has one color, one name and one frequency.
    const int partner = find_conjugate(sweep, b, upper);
    const int style = partner < 0 ? -1 : curve_of[static_cast<std::size_t>(partner)];
    const bool is_drawn =
        style >= 0 && kind == "campbell" &&
        (sweep.frequency_hz.col(b) - sweep.frequency_hz.col(upper[static_cast<std::size_t>(partner)])).norm() <=
            1e-9 * largest;
    if (!is_drawn && !stands_at_zero(b)) draw(b, style >= 0 ? "" : make_name(b), style);
  }
  if (kind != "locus") return;
  plot.curves.push_back(
      {fmt::format("{}{} = {:g}", prefix, sweep.parameter, sweep.value[0]), locus.x.row(0), locus.y.row(0), true});
  if (sweep.models.front().sample_time > 0) report::make_z_plane(plot);
}

}  // namespace

const std::vector<std::string>& list_plot_kinds() {
  static const std::vector<std::string> kKinds{"bode", "nichols", "sigma", "poles", "campbell", "locus"};
  return kKinds;
}

std::vector<Plot> make_linear_plots(const std::vector<std::string>& files, const LinearPlotChoice& choice) {
  const auto& kind = choice.kind;
  std::vector<Plot> plots(kind == "bode" ? 2 : 1);
  const bool is_over_frequency = kind == "bode" || kind == "sigma";
  for (auto& plot : plots) {
    plot.has_log_x = is_over_frequency;
    plot.x_label = is_over_frequency ? "frequency [1/T]" : kind == "nichols" ? "phase [degrees]" : "real part [1/T]";
    plot.y_label = kind == "campbell"                   ? "frequency [1/T]"
                   : kind == "poles" || kind == "locus" ? "imaginary part [1/T]"
                                                        : "magnitude [dB]";
  }
  if (kind == "bode") plots[1].y_label = "phase [degrees]", plots[0].x_label.clear();
  std::vector<std::pair<std::string, records::LinearModel>> models;
  for (const auto& file : files) {
    demand_file(file);
    const std::string prefix = files.size() > 1 ? std::filesystem::path(file).stem().string() + " " : "";
    const auto format = read_file_format(file);
    const std::string expected = is_of_sweeps(kind) ? "bough-sweep" : "bough-linear";
    if (format != expected)
      throw InputError("cli.plot-kind", {file}, fmt::format("--kind {} draws no file of format \"{}\"", kind, format),
                       is_of_sweeps(kind) ? "give what bough linearize --sweep or --each wrote"
                                          : "give a linear model of bough linearize");
    if (is_of_sweeps(kind)) {
      add_sweep(hdf5::read_sweep(file), kind, prefix, plots[0]);
      continue;
    }
    auto all = hdf5::read_linear_model(file);
    if (kind == "poles") {
      models.emplace_back(files.size() > 1 ? std::filesystem::path(file).stem().string() : "", std::move(all));
      continue;
    }
    const auto model = choose_channels(all, choice.inputs, choice.outputs, file);
    if (model.inputs.size() == 0 || model.outputs.size() == 0)
      throw InputError("linear.no-channels", {file}, "the model has no input or no output",
                       "name some with --inputs and --outputs of bough linearize");
    add_response(statespace::calc_frequency_response(model), kind, prefix, plots);
  }
  if (kind == "poles") {
    std::vector<std::pair<std::string, const records::LinearModel*>> named;
    for (const auto& [name, model] : models) named.emplace_back(name, &model);
    plots[0] = report::make_pole_plot(named);
  }
  return plots;
}

}  // namespace bough::cli
