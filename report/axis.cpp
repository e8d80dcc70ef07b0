#include "report/axis.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace bough::report {

namespace {

double get_round_step(double rough) {
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 2.5, 5.0}) {
    if (rough <= factor * power * (1 + 1e-9)) return factor * power;
  }
  return 10 * power;
}

}  // namespace

Axis make_axis(double min, double max, int num_ticks, bool widen, double base_step) {
  Axis axis;
  // Nothing here overflows.
  min = std::clamp(min, -1e300, 1e300);
  max = std::clamp(max, -1e300, 1e300);
  if (!(max > min)) {
    const double half = min == 0 ? 1 : 0.5 * std::abs(min);
    min -= half;
    max += half;
  } else if (widen) {
    const double margin = 0.04 * (max - min);
    // Data that start at zero keep zero as the end of the axis.
    if (min != 0) min -= margin;
    if (max != 0) max += margin;
  }
  axis.min = min;
  axis.max = max;
  double step = base_step > 0 ? base_step : get_round_step((max - min) / std::max(1, num_ticks));
  while (base_step > 0 && (max - min) / step > num_ticks + 1) step *= 2;
  const double largest = std::max(std::abs(min), std::abs(max));
  const int magnitude = static_cast<int>(std::floor(std::log10(largest)));
  if (base_step > 0)
    axis.exponent = 0;
  else if (magnitude >= 4 || magnitude < -2)
    axis.exponent = 3 * static_cast<int>(std::floor(magnitude / 3.0));
  const double scale = std::pow(10.0, axis.exponent);
  int decimals = 0;
  for (double s = step / scale; decimals < 9 && std::abs(s - std::round(s)) > 1e-6 * s; s *= 10) ++decimals;
  for (double k = std::ceil(min / step - 1e-9); k * step <= max + 1e-9 * step; k += 1) {
    axis.ticks.push_back(k * step);
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%.*f", decimals, k * step / scale);
    std::string label(std::abs(k) < 0.5 ? "0" : buffer);
    if (label[0] == '-') label.replace(0, 1, "\u2212");
    axis.labels.push_back(label);
  }
  return axis;
}

Axis make_log_axis(double min, double max) {
  if (!(max > min)) min -= 0.5, max += 0.5;
  Axis axis;
  axis.min = min;
  axis.max = max;
  const bool has_few = max - min<3, has_many = max - min> 9;
  for (int power = static_cast<int>(std::floor(min)); power <= max; ++power) {
    for (const int digit : {1, 2, 5}) {
      const double at = power + std::log10(digit);
      if (at < min - 1e-9 || at > max + 1e-9 || (digit > 1 && !has_few) || (has_many && power % 2 != 0)) continue;
      axis.ticks.push_back(at);
      char buffer[40];
      std::snprintf(buffer, sizeof buffer, "%g", digit * std::pow(10.0, power));
      axis.labels.push_back(buffer);
    }
  }
  return axis;
}

}  // namespace bough::report
