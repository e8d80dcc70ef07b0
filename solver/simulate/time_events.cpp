#include "solver/simulate/time_events.hpp"

#include <algorithm>
#include <cmath>

#include "base/diagnostic.hpp"

namespace bough::solver {

Timeline::Timeline(const RunPlan& plan, std::vector<double> restarts, std::vector<double> landmarks)
    : plan_(plan), close_(1e-12 * (plan.end - plan.start)) {
  num_outputs_ = 1 + std::max(1L, std::lround(std::ceil((plan.end - plan.start) / plan.output_step - 1e-9)));
  const auto is_inside = [&](double t) { return t > plan.start + close_ && t < plan.end - close_; };
  std::sort(restarts.begin(), restarts.end());
  for (size_t i = 0; i < restarts.size(); ++i) {
    if (!is_inside(restarts[i])) continue;
    const double first = restarts[i];
    while (i + 1 < restarts.size() && restarts[i + 1] - first <= close_) ++i;
    stops_.push_back({restarts[i], std::nextafter(first, plan.start), true});
  }
  const bool jumps_at_end =
      std::any_of(restarts.begin(), restarts.end(), [&](double t) { return std::abs(t - plan.end) <= close_; });
  stops_.push_back({plan.end, jumps_at_end ? std::nextafter(plan.end, plan.start) : plan.end, true});
  const auto earlier = [](const Stop& a, const Stop& b) { return a.time < b.time; };
  std::vector<Stop> passed;
  for (const double t : landmarks) {
    if (is_inside(t) && std::abs(snap_to_stop(t) - t) == 0) passed.push_back({t, t, false});
  }
  std::sort(passed.begin(), passed.end(), earlier);
  const auto is_jump = [&](const Stop& s) {
    return std::binary_search(stops_.begin(), stops_.end(), s, earlier);  // by time
  };
  passed.erase(std::remove_if(passed.begin(), passed.end(), is_jump), passed.end());
  stops_.insert(stops_.end(), passed.begin(), passed.end());
  std::sort(stops_.begin(), stops_.end(), earlier);
  next_ = calc_output(0);
}

double Timeline::snap(double t) const {
  const double at_stop = snap_to_stop(t);
  if (at_stop != t) return at_stop;
  for (const auto& s : samples_) {
    const double at = s.first + std::round((t - s.first) / s.period) * s.period;
    if (at >= s.first && std::abs(at - t) <= close_) return snap_to_stop(at);
  }
  return t;
}

double Timeline::snap_to_stop(double t) const {
  const auto at =
      std::lower_bound(stops_.begin(), stops_.end(), t - close_, [](const Stop& s, double x) { return s.time < x; });
  return at != stops_.end() && at->time <= t + close_ ? at->time : t;
}

double Timeline::calc_output(long i) const {
  if (i >= num_outputs_) return std::numeric_limits<double>::infinity();
  if (i == num_outputs_ - 1) return plan_.end;
  return snap(plan_.start + static_cast<double>(i) * plan_.output_step);
}

void Timeline::take_output() { next_ = calc_output(++index_); }

void Timeline::skip_outputs(double t) {
  index_ = std::clamp(std::lround(std::floor((t - plan_.start) / plan_.output_step)) - 1, 0L, num_outputs_);
  while (index_ < num_outputs_ && calc_output(index_) <= t + close_) ++index_;
  next_ = calc_output(index_);
}

std::optional<Stop> Timeline::find_stop_at(double t) const {
  const auto at =
      std::lower_bound(stops_.begin(), stops_.end(), t - close_, [](const Stop& s, double x) { return s.time < x; });
  if (at != stops_.end() && at->time <= t + close_) return *at;
  for (const auto& s : samples_) {
    const double time = s.first + std::round((t - s.first) / s.period) * s.period;
    if (time >= s.first && std::abs(time - t) <= close_) return Stop{t, t, false};
  }
  return {};
}

bool Timeline::is_restart(double t) const {
  const auto stop = find_stop_at(t);
  return stop && stop->restarts;
}

Stop Timeline::find_stop(double t) const {
  const auto at = std::upper_bound(stops_.begin(), stops_.end(), t, [](double x, const Stop& s) { return x < s.time; });
  BOUGH_DEMAND(at != stops_.end());
  Stop found = *at;
  for (const auto& s : samples_) {
    // The first instant past t that is not t by rounding.
    double i = std::max(0.0, std::floor((t - s.first) / s.period));
    double time = snap(s.first + i * s.period);
    while (time <= t + close_) time = snap(s.first + ++i * s.period);
    if (time < found.time) found = {time, time, false};
  }
  return found;
}

}  // namespace bough::solver
