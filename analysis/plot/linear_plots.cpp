#include "analysis/plot/linear_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>

#include "analysis/common/body_files.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/export/export_matrices.hpp"
#include "analysis/linearize/choose_channels.hpp"
#include "formats/hdf5/complex_modes_file.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/hdf5/linear_file.hpp"
#include "formats/hdf5/sweep_file.hpp"
#include "report/bode_plot.hpp"
#include "report/label.hpp"
#include "report/pole_plot.hpp"
#include "solver/statespace/frequency_response.hpp"

namespace bough::analysis {

namespace {

using Eigen::Index;
using Eigen::VectorXd;
using report::Plot;

bool is_of_sweeps(const std::string& kind) { return kind == "campbell" || kind == "locus"; }

/// More curves than this cannot be told apart: the pairs with the largest peaks are drawn, unless some are chosen.
constexpr std::size_t kMaxPairs = 8;

/// Keeps the pairs with the largest peaks, in their order.
void keep_largest(std::vector<report::BodePair>& pairs, std::size_t max_pairs) {
  const auto calc_peak = [](const report::BodePair& pair) {
    return pair.decibel.unaryExpr([](double v) { return std::isfinite(v) ? v : -HUGE_VAL; }).maxCoeff();
  };
  std::vector<double> peaks;
  for (const auto& pair : pairs) peaks.push_back(pair.decibel.size() > 0 ? calc_peak(pair) : -HUGE_VAL);
  std::vector<std::size_t> order(pairs.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return peaks[a] > peaks[b]; });
  order.resize(std::min(order.size(), max_pairs));
  std::sort(order.begin(), order.end());
  std::vector<report::BodePair> kept;
  for (const auto k : order) kept.push_back(std::move(pairs[k]));
  pairs = std::move(kept);
}

/// \param is_chosen  some inputs or outputs are requested: all of their pairs are drawn
/// \return what of the model is drawn, for the title; empty: all
std::string add_response(const records::LinearModel& model, const std::string& kind, const std::string& prefix,
                         bool is_chosen, std::vector<Plot>& plots) {
  const bool is_loop = records::is_cut_loop(model);
  statespace::FrequencyRange range;
  if (is_loop) range = statespace::widen_for_loop(model, range);
  const auto response = statespace::calc_frequency_response(model, range);
  if (kind == "sigma") {
    auto plot = report::make_sigma_plot(response, prefix);
    plot.curves.insert(plot.curves.begin(), plots[0].curves.begin(), plots[0].curves.end());
    plots[0] = std::move(plot);
    return {};
  }
  auto pairs = report::make_bode_pairs(response, std::numeric_limits<std::size_t>::max());
  const auto num_pairs = pairs.size();
  if (!is_chosen) keep_largest(pairs, kMaxPairs);
  for (const auto& pair : pairs) {
    if (kind == "nichols")
      plots[0].curves.push_back({prefix + pair.name, pair.degrees, pair.decibel});
    else
      report::add_bode_curve(pair, response.frequency_hz, prefix + pair.name, plots);
  }
  if (is_loop && kind == "bode" && pairs.size() == 1)
    report::add_margins(statespace::calc_margins(model, response), pairs.front(), response, plots);
  return pairs.size() < num_pairs ? fmt::format(", {} of {} pairs", pairs.size(), num_pairs) : "";
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
  if (sweep.models.empty() || sweep.models.front().sample_time == 0) return locus;
  for (Index k = 0; k < sweep.real.rows(); ++k)
    for (Index b = 0; b < sweep.real.cols(); ++b) {
      const auto z = records::calc_z(sweep, k, b);
      locus.x(k, b) = z.real();
      locus.y(k, b) = z.imag();
    }
  return locus;
}

/// Returns true if the parameter is the rate of a rotation: a speed of the operating points equals it at each value.
bool is_spin_rate(const records::LinearSweep& sweep) {
  if (sweep.models.empty()) return sweep.whirl.size() > 0;
  const double tolerance = 1e-6 * sweep.value.cwiseAbs().maxCoeff();
  if (tolerance == 0) return false;
  const auto& first = sweep.models.front();
  for (Index i = 0; i < first.u.size(); ++i) {
    bool is_equal = first.u_names.dims[static_cast<std::size_t>(i)] == "1/T";
    for (std::size_t k = 0; k < sweep.models.size() && is_equal; ++k)
      is_equal = std::abs(std::abs(sweep.models[k].u[i]) - std::abs(sweep.value[static_cast<Index>(k)])) <= tolerance;
    if (is_equal) return true;
  }
  return false;
}

/// Lines of once, twice, ... the rate of rotation: `num_lines`, or 0 for those among the curves.
void add_per_rev(const records::LinearSweep& sweep, int num_lines, Plot& plot) {
  const double first = sweep.value[0], last = sweep.value[sweep.value.size() - 1];
  double top = 0;
  for (const auto& curve : plot.curves)
    for (const double y : curve.y)
      if (y > top) top = y;  // not NaN
  const double rate = std::max(std::abs(first), std::abs(last)) / (2 * std::numbers::pi);
  const auto is_drawn = [&](int n) {
    return num_lines > 0 ? n <= num_lines : n <= 8 && n * std::abs(last) / (2 * std::numbers::pi) <= 3 * top;
  };
  for (int n = 1; rate > 0 && is_drawn(n); ++n)
    plot.guides.push_back({fmt::format("{}/rev", n), Eigen::Vector2d(first, last),
                           Eigen::Vector2d(std::abs(first), std::abs(last)) * n / (2 * std::numbers::pi)});
}

/// A curve of each direction of whirl that a branch has: forward solid, backward dashed, along a line dotted.
void add_whirl(const records::LinearSweep& sweep, Index b, const std::string& name, int color, Plot& plot) {
  static const char* const kWords[] = {"forward", "backward", "line"};
  const Index np = sweep.value.size();
  const auto find_direction = [&](Index k) {
    const std::string word = records::name_whirl(sweep.whirl(k, b));
    return word == kWords[0] ? 0 : word == kWords[1] ? 1 : 2;
  };
  for (int direction = 0; direction < 3; ++direction) {
    // The first value gets the whirl direction of the next: rotors at rest have none.
    VectorXd y = VectorXd::Constant(np, std::nan(""));
    bool is_drawn = false;
    for (Index k = np > 1 ? 1 : 0; k < np; ++k) {
      if (find_direction(k) != direction) continue;
      for (Index i = std::max<Index>(k - 1, 0); i <= k; ++i) y[i] = sweep.frequency_hz(i, b);
      is_drawn = true;
    }
    const int style = color % static_cast<int>(report::kNumColors) + direction * static_cast<int>(report::kNumColors);
    if (is_drawn) plot.curves.push_back({name + " " + kWords[direction], sweep.value, y, false, style});
  }
}

/// The y axis from 0 to above the highest curve: slopes of lines per revolution are read against zero.
void start_at_zero(Plot& plot) {
  double highest = 0;
  for (const auto& curve : plot.curves)
    for (const double y : curve.y)
      if (std::isfinite(y)) highest = std::max(highest, y);
  if (highest > 0) plot.y_min = 0, plot.y_max = 1.05 * highest;
}

void add_sweep(const records::LinearSweep& sweep, const LinearPlotChoice& choice, const std::string& prefix,
               Plot& plot) {
  const auto& kind = choice.kind;
  if (kind == "campbell") plot.x_label = sweep.models.empty() ? sweep.parameter + " [rad/s]" : sweep.parameter;
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
  int num_whirls = 0;
  for (std::size_t k = 0; k < upper.size(); ++k) {
    if (stands_at_zero(upper[k])) continue;
    if (kind == "campbell" && sweep.whirl.size() > 0) {
      add_whirl(sweep, upper[k], make_name(upper[k]), num_whirls++, plot);
      continue;
    }
    curve_of[k] = static_cast<int>(plot.curves.size());
    draw(upper[k], make_name(upper[k]), -1);
  }
  for (const Index b : lower) {
    // A pair has one color, one name and one frequency.
    const int partner = find_conjugate(sweep, b, upper);
    if (partner >= 0 && kind == "campbell" && sweep.whirl.size() > 0) continue;
    const int style = partner < 0 ? -1 : curve_of[static_cast<std::size_t>(partner)];
    const bool is_drawn =
        style >= 0 && kind == "campbell" &&
        (sweep.frequency_hz.col(b) - sweep.frequency_hz.col(upper[static_cast<std::size_t>(partner)])).norm() <=
            1e-9 * largest;
    if (!is_drawn && !stands_at_zero(b)) draw(b, style >= 0 ? "" : make_name(b), style);
  }
  if (kind == "campbell" && (choice.per_rev > 0 || is_spin_rate(sweep))) add_per_rev(sweep, choice.per_rev, plot);
  if (kind != "locus") return;
  // A locus starts at the poles of the first value and shows the zeros there.
  std::vector<Index> shown;
  for (Index b = 0; b < sweep.real.cols(); ++b)
    if (!records::is_gone(sweep, b)) shown.push_back(b);
  const VectorXd x = locus.x.row(0), y = locus.y.row(0);
  plot.curves.push_back({fmt::format("{}{} = {:g}", prefix, sweep.parameter, sweep.value[0]), x(shown), y(shown), true,
                         -1, report::Mark::Cross});
  const auto& first = sweep.models.front();
  if (first.sample_time == 0 && first.zeros_real.size() > 0)
    plot.curves.push_back({prefix + "zeros", first.zeros_real, first.zeros_imag, true, -1, report::Mark::Ring});
  first.sample_time > 0 ? report::make_z_plane(plot) : report::add_s_grid(plot);
}

}  // namespace

/// Label of the unit of time of the files. \throws InputError "cli.plot-units" if two files have labels that differ.
static std::string read_time_unit(const std::vector<std::string>& files) {
  std::string unit;
  for (const auto& file : files) {
    demand_file(file);
    const auto attributes = hdf5::read_info(file).attributes;
    const auto found = attributes.find("time_unit");
    const std::string own = found == attributes.end() ? "" : found->second;
    if (!unit.empty() && !own.empty() && own != unit)
      throw InputError("cli.plot-units", {file},
                       fmt::format("its unit of time is {}, that of the files before {}", own, unit),
                       "draw the files one by one, or convert one with bough convert --units");
    if (!own.empty()) unit = own;
  }
  return unit;
}

const std::vector<std::string>& list_plot_kinds() {
  static const std::vector<std::string> kKinds{"bode", "nichols", "sigma", "poles", "campbell", "locus"};
  return kKinds;
}

std::vector<Plot> make_linear_plots(const std::vector<std::string>& files, const LinearPlotChoice& choice) {
  const auto& kind = choice.kind;
  std::vector<Plot> plots(1);
  // Curves of all kinds but nichols are over, or in, a unit of time that the files share.
  const auto time = kind == "nichols" ? "" : read_time_unit(files);
  std::string drawn;
  if (kind == "bode") plots = report::make_bode_axes(time);
  if (kind == "nichols") plots[0] = report::make_nichols_axes();
  if (kind == "campbell") plots[0].y_label = report::label_frequency(time);
  if (kind == "locus") {
    const auto unit = time.empty() ? "1/T" : "1/" + time;
    plots[0].x_label = report::make_label("real part", unit);
    plots[0].y_label = report::make_label("imaginary part", unit);
  }
  std::vector<std::pair<std::string, records::LinearModel>> models;
  for (const auto& file : files) {
    demand_file(file);
    const std::string prefix = files.size() > 1 ? std::filesystem::path(file).stem().string() + " " : "";
    const auto format = read_file_format(file);
    const std::string expected = is_of_sweeps(kind) ? "bough-sweep" : "bough-linear";
    if (kind == "campbell" && format == "bough-complex-modes") {
      const auto modes = hdf5::read_complex_modes(file);
      if (!modes.rotors || modes.rotors->sweep.value.size() < 2)
        throw InputError("cli.plot-kind", {file}, "the complex modes are of one speed, or have no rotors",
                         "give RSPEED on RGYRO, or ROTORD, more speeds than one");
      add_sweep(modes.rotors->sweep, choice, prefix, plots[0]);
      continue;
    }
    if (format != expected)
      throw InputError("cli.plot-kind", {file}, fmt::format("--kind {} draws no file of format \"{}\"", kind, format),
                       kind == "campbell"
                           ? "give what bough linearize --sweep or --each, or bough modes of rotors, wrote"
                       : is_of_sweeps(kind) ? "give what bough linearize --sweep or --each wrote"
                                            : "give a linear model of bough linearize");
    if (is_of_sweeps(kind)) {
      add_sweep(hdf5::read_sweep(file), choice, prefix, plots[0]);
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
    drawn += add_response(model, kind, prefix, !choice.inputs.empty() || !choice.outputs.empty(), plots);
  }
  if (kind == "nichols") report::add_nichols_grid(plots[0]);
  if (kind == "poles") {
    std::vector<std::pair<std::string, const records::LinearModel*>> named;
    for (const auto& [name, model] : models) named.emplace_back(name, &model);
    plots[0] = report::make_pole_plot(named);
  }
  static const std::map<std::string, std::string> kTitles{
      {"bode", "Bode diagram"},         {"nichols", "Nichols diagram"},
      {"sigma", "Singular values"},     {"poles", "Poles (x) and zeros (o)"},
      {"campbell", "Campbell diagram"}, {"locus", "Root locus"}};
  const auto stem = std::filesystem::path(files.front()).stem().string();
  plots[0].title = kTitles.at(kind) + (files.size() == 1 && stem != kind ? ": " + stem : std::string()) + drawn;
  if (kind == "campbell") start_at_zero(plots[0]);
  return plots;
}

}  // namespace bough::analysis
