#include "report/bode_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "formats/records/unit_names.hpp"
#include "report/label.hpp"

namespace bough::report {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

const double kNaN = std::nan("");

/// Linear in log10 of the frequency.
double interpolate(const VectorXd& frequency, const VectorXd& y, double at) {
  for (Index i = 1; i < frequency.size(); ++i)
    if (frequency[i] >= at && frequency[i - 1] > 0) {
      const double share = std::log(at / frequency[i - 1]) / std::log(frequency[i] / frequency[i - 1]);
      return y[i - 1] + share * (y[i] - y[i - 1]);
    }
  return kNaN;
}

/// Marker on the curve, and a line from it to the limit.
void add_margin(double frequency, double from, double to, const std::string& label, int style, Plot& plot) {
  plot.curves.push_back({label, VectorXd::Constant(1, frequency), VectorXd::Constant(1, from), true, style});
  plot.guides.push_back({"", VectorXd::Constant(2, frequency), Eigen::Vector2d(from, to)});
}

void add_level(double level, const VectorXd& frequency, Plot& plot) {
  if (frequency.size() > 1)
    plot.guides.push_back(
        {"", Eigen::Vector2d(frequency[0], frequency[frequency.size() - 1]), Eigen::Vector2d(level, level)});
}

/// Contour |L/(1+L)| = M: L = M e^(jφ) / (1 - M e^(jφ)), φ over a turn about a phase of -180 degrees, plus `shift`
/// degrees. It is closed about -1 for M > 1, otherwise a wave from one multiple of 360 degrees to the next.
Curve make_closed_loop_contour(double decibel, double shift) {
  constexpr int kPoints = 362;
  const double size = std::pow(10, decibel / 20);
  Curve contour{"", VectorXd(kPoints), VectorXd(kPoints)};
  for (int i = 0; i < kPoints; ++i) {
    const double share = static_cast<double>(i) / (kPoints - 1);
    const auto t = std::polar(size, 2 * std::numbers::pi * (share - (size > 1 ? 0.5 : 0)));
    const auto loop = t / (1.0 - t);
    double degrees = std::arg(loop) * 180 / std::numbers::pi;
    if (degrees > 0) degrees -= 360;
    if (size < 1 && (i == 0 || i == kPoints - 1)) degrees = i == 0 ? -360 : 0;  // L is real there
    contour.x[i] = shift + degrees;
    contour.y[i] = 20 * std::log10(std::abs(loop));
  }
  return contour;
}

/// "−30.8", "13000".
std::string format_short(double value) {
  const double size = std::abs(value);
  const int digits = size >= 1000 && size < 1e6 ? static_cast<int>(std::floor(std::log10(size))) + 1 : 3;
  auto text = fmt::format("{:.{}g}", value, digits);
  if (text.front() == '-') text.replace(0, 1, "\u2212");
  return text;
}

}  // namespace

double calc_response_floor(const VectorXd& frequency_hz, const VectorXd& largest) {
  const Index n = largest.size();
  if (n == 0) return 0;
  // Steps of the logarithmic axis at each frequency; without an axis each counts alike.
  VectorXd width = VectorXd::Ones(n);
  if (n > 1 && frequency_hz[0] > 0)
    for (Index k = 0; k < n; ++k)
      width[k] = std::log(frequency_hz[std::min(k + 1, n - 1)] / frequency_hz[std::max<Index>(k - 1, 0)]) / 2;
  std::vector<Index> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return largest[a] > largest[b]; });
  const double total = width.sum();
  double covered = 0;
  for (const Index k : order)
    if ((covered += width[k]) >= kPeakShare * total) return kResponseFloor * largest[k];
  return kResponseFloor * largest[order.back()];
}

std::vector<BodePair> make_bode_pairs(const records::FrequencyResponse& response, std::size_t max_pairs) {
  std::vector<BodePair> pairs;
  if (response.value.empty()) return pairs;
  const auto& first = response.value.front();
  const auto count = static_cast<Index>(response.value.size());
  VectorXd largest = VectorXd::Zero(count);
  for (Index k = 0; k < count; ++k)
    if (const auto& h = response.value[static_cast<std::size_t>(k)]; h.size() > 0) largest[k] = h.cwiseAbs().maxCoeff();
  const double floor = calc_response_floor(response.frequency_hz, largest);
  for (Index j = 0; j < first.cols(); ++j)
    for (Index i = 0; i < first.rows() && pairs.size() < max_pairs; ++i) {
      BodePair pair{i, j,
                    response.outputs.name[static_cast<std::size_t>(i)] + " / " +
                        response.inputs.name[static_cast<std::size_t>(j)],
                    VectorXd(count), VectorXd(count)};
      double last = kNaN;
      for (Index k = 0; k < count; ++k) {
        const std::complex<double> h = response.value[static_cast<std::size_t>(k)](i, j);
        const bool is_drawn = std::abs(h) > floor;
        pair.decibel[k] = is_drawn ? 20 * std::log10(std::abs(h)) : kNaN;
        pair.degrees[k] = kNaN;
        if (!is_drawn) continue;
        double phase = std::arg(h) * 180 / std::numbers::pi;
        if (std::isfinite(last)) phase -= 360 * std::round((phase - last) / 360);
        pair.degrees[k] = last = phase;
      }
      pairs.push_back(std::move(pair));
    }
  return pairs;
}

std::vector<Plot> make_bode_axes(const std::string& time_unit) {
  std::vector<Plot> plots(2);
  for (auto& plot : plots) plot.has_log_x = true;
  plots[0].y_label = "magnitude [dB]";
  plots[1].y_label = "phase [degrees]";
  plots[1].x_label = label_frequency(time_unit);
  plots[1].y_step = 45;
  return plots;
}

Plot make_nichols_axes() {
  Plot plot{"", "open-loop phase [degrees]", "open-loop magnitude [dB]", {}};
  plot.x_step = 45;
  return plot;
}

void add_nichols_grid(Plot& plot) {
  double low = -180, high = -180;
  bool has_any = false;
  for (const auto& curve : plot.curves)
    for (const double x : curve.x) {
      if (!std::isfinite(x)) continue;
      low = has_any ? std::min(low, x) : x;
      high = has_any ? std::max(high, x) : x;
      has_any = true;
    }
  // The point -1 next to the middle of the curves always, others within a quarter of a turn of them.
  const double middle = 360 * std::round(((low + high) / 2 + 180) / 360);
  std::vector<double> shifts;
  for (double shift = 360 * std::floor(low / 360); shift < high + 360; shift += 360) shifts.push_back(shift);
  if (std::find(shifts.begin(), shifts.end(), middle) == shifts.end()) shifts.push_back(middle);
  std::vector<double> points;
  for (const double shift : shifts)
    if (shift == middle || (shift - 180 > low - 90 && shift - 180 < high + 90)) points.push_back(shift - 180);
  for (const double decibel : {12.0, 6.0, 3.0, 1.0, -1.0, -3.0, -6.0, -12.0, -20.0})
    for (const double shift : shifts) {
      plot.guides.push_back(make_closed_loop_contour(decibel, shift));
      if (shift == middle)
        plot.guides.back().label = (decibel < 0 ? "\u2212" : "") + fmt::format("{:g} dB", std::abs(decibel));
    }
  const auto count = static_cast<Index>(points.size());
  plot.curves.push_back(
      {"\u22121", Eigen::Map<VectorXd>(points.data(), count), VectorXd::Zero(count), true, 6, Mark::Cross});
  // Room above the point.
  plot.curves.push_back({"", VectorXd::Constant(1, middle - 180), VectorXd::Constant(1, 6), true, -1, Mark::None});
}

void add_bode_curve(const BodePair& pair, const VectorXd& frequency_hz, const std::string& label,
                    std::vector<Plot>& plots) {
  plots[0].curves.push_back({label, frequency_hz, pair.decibel});
  plots[1].curves.push_back({"", frequency_hz, pair.degrees});
}

void add_margins(const records::Margins& margins, const BodePair& pair, const records::FrequencyResponse& response,
                 std::vector<Plot>& plots) {
  const VectorXd& frequency_hz = response.frequency_hz;
  const auto unit = records::name_frequency_unit(response.units.time);
  constexpr int kGainStyle = 1, kPhaseStyle = 2;
  add_level(0, frequency_hz, plots[0]);
  for (const auto& c : margins.gain) {
    const double margin = 20 * std::log10(c.margin);
    if (frequency_hz.size() == 0 || c.frequency_hz < frequency_hz[0] ||
        c.frequency_hz > frequency_hz[frequency_hz.size() - 1])
      continue;
    add_margin(c.frequency_hz, -margin, 0,
               fmt::format("gain margin {} dB at {} {}", format_short(margin), format_short(c.frequency_hz), unit),
               kGainStyle, plots[0]);
  }
  for (const auto& c : margins.phase) {
    const double phase = interpolate(frequency_hz, pair.degrees, c.frequency_hz);
    if (!std::isfinite(phase)) continue;
    const double margin = c.margin * 180 / std::numbers::pi, limit = phase - margin;
    add_level(limit, frequency_hz, plots[1]);
    add_margin(
        c.frequency_hz, phase, limit,
        fmt::format("phase margin {} degrees at {} {}", format_short(margin), format_short(c.frequency_hz), unit),
        kPhaseStyle, plots[1]);
  }
}

Plot make_sigma_plot(const records::FrequencyResponse& response, const std::string& prefix) {
  Plot plot{"", label_frequency(response.units.time), "singular value [dB]", {}};
  plot.has_log_x = true;
  const auto& values = response.singular_values;
  const double floor = values.size() > 0 ? calc_response_floor(response.frequency_hz, values.rowwise().maxCoeff()) : 0;
  for (Index s = 0; s < values.cols(); ++s) {
    const VectorXd decibel = values.col(s).unaryExpr([&](double v) { return v > floor ? 20 * std::log10(v) : kNaN; });
    if (decibel.array().isFinite().any())
      plot.curves.push_back({fmt::format("{}σ{}", prefix, s + 1), response.frequency_hz, decibel});
  }
  return plot;
}

}  // namespace bough::report
