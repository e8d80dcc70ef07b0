#include "solver/functions/table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bough::solver {
namespace {

/// Interval i with x[i] <= t < x[i+1], for t inside the table.
size_t find_interval(const std::vector<double>& x, double t) {
  const auto it = std::upper_bound(x.begin(), x.end(), t);
  return static_cast<size_t>(std::clamp<std::ptrdiff_t>(it - x.begin() - 1, 0, std::ssize(x) - 2));
}

/// Range of the finite numbers, max - min; 0 for a constant with round-off.
double calc_range(const std::vector<double>& y) {
  double min_value = std::numeric_limits<double>::infinity(), max_value = -min_value;
  for (const double v : y) {
    if (!std::isfinite(v)) continue;
    min_value = std::min(min_value, v);
    max_value = std::max(max_value, v);
  }
  return max_value - min_value > 1e-13 * std::max(std::abs(max_value), std::abs(min_value)) ? max_value - min_value : 0;
}

}  // namespace

std::vector<double> find_mesh_times(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> found;
  const double min_value = 0.25 * calc_range(y);
  if (!(min_value > 0)) return found;
  const auto first = std::find_if(y.begin(), y.end(), [](double v) { return std::isfinite(v); });
  double last = *first;
  for (auto i = static_cast<size_t>(first - y.begin()) + 1; i < x.size(); ++i) {
    if (!(std::abs(y[i] - last) >= min_value)) continue;
    if (found.empty() || found.back() < x[i - 1]) found.push_back(x[i - 1]);
    found.push_back(x[i]);
    last = y[i];
  }
  return found;
}

std::vector<double> LinearTable::force_jump_times() const {
  std::vector<double> found = {x_.front()};
  const double min_value = 0.01 * calc_range(y_);
  for (size_t i = 1; i + 1 < x_.size(); ++i) {
    const double before = x_[i] - x_[i - 1], after = x_[i + 1] - x_[i];
    const double bend = (y_[i + 1] - y_[i]) / after - (y_[i] - y_[i - 1]) / before;
    if (std::abs(bend) * std::min(before, after) > min_value) found.push_back(x_[i]);
  }
  found.push_back(x_.back());
  return found;
}

std::vector<double> LinearTable::mesh_times() const { return find_mesh_times(x_, y_); }
std::vector<double> CubicTable::mesh_times() const { return find_mesh_times(x_, y_); }

TimeFunction::Value LinearTable::calc(double t) const {
  if (t < x_.front()) return {y_.front(), 0, 0};
  if (t >= x_.back()) return {y_.back(), 0, 0};
  const size_t i = find_interval(x_, t);
  const double slope = (y_[i + 1] - y_[i]) / (x_[i + 1] - x_[i]);
  return {y_[i] + slope * (t - x_[i]), slope, 0};
}

CubicTable::CubicTable(std::vector<double> x, std::vector<double> y) : x_(std::move(x)), y_(std::move(y)) {
  const int n = static_cast<int>(x_.size());
  second_.assign(x_.size(), 0.0);
  const auto step = [this](int i) { return x_[i + 1] - x_[i]; };
  const auto slope = [this, step](int i) { return (y_[i + 1] - y_[i]) / step(i); };
  if (n == 2) return;
  if (n == 3) {
    std::fill(second_.begin(), second_.end(), 2 * (slope(1) - slope(0)) / (x_[2] - x_[0]));
    return;
  }
  // h_{i-1} m_{i-1} + 2 (h_{i-1} + h_i) m_i + h_i m_{i+1} = 6 (s_i - s_{i-1}), for the second derivatives m. The ends
  // ask for one cubic over the first (last) two intervals: m_0 = m_1 + (m_1 - m_2) h_0 / h_1, put into the first row.
  const int k = n - 2;
  std::vector<double> lower(k), diagonal(k), upper(k), rhs(k);
  for (int j = 0; j < k; ++j) {
    const int i = j + 1;
    lower[j] = step(i - 1);
    diagonal[j] = 2 * (step(i - 1) + step(i));
    upper[j] = step(i);
    rhs[j] = 6 * (slope(i) - slope(i - 1));
  }
  const double first = step(0) / step(1), last = step(n - 2) / step(n - 3);
  diagonal[0] += lower[0] * (1 + first);
  upper[0] -= lower[0] * first;
  diagonal[k - 1] += upper[k - 1] * (1 + last);
  lower[k - 1] -= upper[k - 1] * last;
  for (int j = 1; j < k; ++j) {
    const double w = lower[j] / diagonal[j - 1];
    diagonal[j] -= w * upper[j - 1];
    rhs[j] -= w * rhs[j - 1];
  }
  second_[k] = rhs[k - 1] / diagonal[k - 1];
  for (int j = k - 2; j >= 0; --j) second_[j + 1] = (rhs[j] - upper[j] * second_[j + 2]) / diagonal[j];
  second_[0] = second_[1] + (second_[1] - second_[2]) * first;
  second_[n - 1] = second_[n - 2] + (second_[n - 2] - second_[n - 3]) * last;
}

TimeFunction::Value CubicTable::calc(double t) const {
  if (t < x_.front()) return {y_.front(), 0, 0};
  if (t >= x_.back()) return {y_.back(), 0, 0};
  const size_t i = find_interval(x_, t);
  const double h = x_[i + 1] - x_[i], s = t - x_[i];
  const double c2 = second_[i] / 2, c3 = (second_[i + 1] - second_[i]) / (6 * h);
  const double c1 = (y_[i + 1] - y_[i]) / h - h * (2 * second_[i] + second_[i + 1]) / 6;
  return {y_[i] + s * (c1 + s * (c2 + s * c3)), c1 + s * (2 * c2 + 3 * c3 * s), 2 * c2 + 6 * c3 * s};
}

}  // namespace bough::solver
