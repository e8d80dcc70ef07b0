#include "solver/functions/curve.hpp"

#include <algorithm>
#include <cmath>

#include "solver/functions/function.hpp"

namespace bough::solver {

std::unique_ptr<const Curve> Curve::make(const records::FunctionRecord& record, const SourceLocation& where,
                                         const std::string& user, Diagnostics& diagnostics) {
  if (record.type != "table") {
    diagnostics.error("system.not-a-table", where,
                      user + " takes function '" + record.name + "' as a table, but its type is " + record.type,
                      "name a [[function]] of type table, with the force as y");
    return nullptr;
  }
  Diagnostics own;  // said where the function is built
  const auto function = make_time_function(record, own);
  if (!function) return nullptr;
  auto curve = std::make_unique<Curve>();
  curve->x_ = record.x;
  curve->y_ = record.y;
  curve->integral_ = {0};
  for (size_t i = 0; i + 1 < record.x.size(); ++i) {
    const double h = record.x[i + 1] - record.x[i];
    const double chord = (record.y[i + 1] - record.y[i]) / h;
    double left = chord, right = chord;
    if (record.interpolation == "cubic") {  // a cubic is known by its slopes at the ends of the interval
      left = function->calc(record.x[i]).f_dot;
      right = function->calc(std::nextafter(record.x[i + 1], record.x[i])).f_dot;
    }
    curve->slope_left_.push_back(left);
    curve->slope_right_.push_back(right);
    curve->integral_.push_back(curve->integral_[i] + h * (record.y[i] + record.y[i + 1]) / 2 +
                               h * h * (left - right) / 12);
  }
  curve->at_zero_ = curve->calc_from_start(0).integral;
  return curve;
}

Curve::Value Curve::calc(double x) const {
  Value value = calc_from_start(x);
  value.integral -= at_zero_;
  return value;
}

double Curve::calc_slope(double x, bool from_below) const {
  const auto next = from_below ? std::lower_bound(x_.begin(), x_.end(), x) : std::upper_bound(x_.begin(), x_.end(), x);
  if (next == x_.begin() || next == x_.end()) return 0;
  const auto i = static_cast<size_t>(next - x_.begin() - 1);
  const double h = x_[i + 1] - x_[i], s = x - x_[i], chord = (y_[i + 1] - y_[i]) / h;
  const double c2 = (3 * chord - 2 * slope_left_[i] - slope_right_[i]) / h;
  const double c3 = (slope_left_[i] + slope_right_[i] - 2 * chord) / (h * h);
  return slope_left_[i] + s * (2 * c2 + 3 * c3 * s);
}

Curve::Value Curve::calc_from_start(double x) const {
  if (x <= x_.front()) return {y_.front(), 0, y_.front() * (x - x_.front())};
  if (x >= x_.back()) return {y_.back(), 0, integral_.back() + y_.back() * (x - x_.back())};
  const auto next = std::upper_bound(x_.begin(), x_.end(), x);
  const auto i = static_cast<size_t>(next - x_.begin() - 1);
  const double h = x_[i + 1] - x_[i], s = x - x_[i], chord = (y_[i + 1] - y_[i]) / h;
  // y_i + m s + c2 s² + c3 s³ with both end slopes
  const double c2 = (3 * chord - 2 * slope_left_[i] - slope_right_[i]) / h;
  const double c3 = (slope_left_[i] + slope_right_[i] - 2 * chord) / (h * h);
  return {y_[i] + s * (slope_left_[i] + s * (c2 + s * c3)), slope_left_[i] + s * (2 * c2 + 3 * c3 * s),
          integral_[i] + s * (y_[i] + s * (slope_left_[i] / 2 + s * (c2 / 3 + s * c3 / 4)))};
}

}  // namespace bough::solver
