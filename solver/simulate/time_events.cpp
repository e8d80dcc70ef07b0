#include "solver/simulate/time_events.hpp"

#include <algorithm>
#include <cmath>

#include "base/diagnostic.hpp"

namespace bough::solver {

TimeEvents::TimeEvents(const RunPlan& plan, std::vector<double> jumps, std::vector<double> mesh_times)
    : plan_(plan), close_(1e-12 * (plan.end - plan.start)) {
  num_outputs_ = 1 + std::max(1L, std::lround(std::ceil((plan.end - plan.start) / plan.output_step - 1e-9)));
  const auto is_inside = [&](double t) { return t > plan.start + close_ && t < plan.end - close_; };
  std::sort(jumps.begin(), jumps.end());
  for (size_t i = 0; i < jumps.size(); ++i) {
    if (!is_inside(jumps[i])) continue;
    const double first = jumps[i];
    while (i + 1 < jumps.size() && jumps[i + 1] - first <= close_) ++i;
    stops_.push_back({jumps[i], std::nextafter(first, plan.start), true});
  }
  const bool jumps_at_end =
      std::any_of(jumps.begin(), jumps.end(), [&](double t) { return std::abs(t - plan.end) <= close_; });
  stops_.push_back({plan.end, jumps_at_end ? std::nextafter(plan.end, plan.start) : plan.end, true});
  const auto earlier = [](const TimeEvent& a, const TimeEvent& b) { return a.time < b.time; };
  std::vector<TimeEvent> passed;
  for (const double t : mesh_times) {
    if (is_inside(t) && std::abs(snap_to_stop(t) - t) == 0) passed.push_back({t, t, false});
  }
  std::sort(passed.begin(), passed.end(), earlier);
  const auto starts_nothing = [&](const TimeEvent& s) {
    return std::binary_search(stops_.begin(), stops_.end(), s, earlier);  // by time
  };
  passed.erase(std::remove_if(passed.begin(), passed.end(), starts_nothing), passed.end());
  stops_.insert(stops_.end(), passed.begin(), passed.end());
  std::sort(stops_.begin(), stops_.end(), earlier);
  next_ = calc_output(0);
}

double TimeEvents::snap(double t) const {
  const double at_stop = snap_to_stop(t);
  if (at_stop != t) return at_stop;
  for (const auto& s : samples_) {
    const double at = s.first + std::round((t - s.first) / s.period) * s.period;
    if (at >= s.first && std::abs(at - t) <= close_) return snap_to_stop(at);
  }
  return t;
}

double TimeEvents::snap_to_stop(double t) const {
  const auto at = std::lower_bound(stops_.begin(), stops_.end(), t - close_,
                                   [](const TimeEvent& s, double x) { return s.time < x; });
  return at != stops_.end() && at->time <= t + close_ ? at->time : t;
}

double TimeEvents::calc_output(long i) const {
  if (i >= num_outputs_) return std::numeric_limits<double>::infinity();
  if (i == num_outputs_ - 1) return plan_.end;
  return snap(plan_.start + static_cast<double>(i) * plan_.output_step);
}

void TimeEvents::take_output() { next_ = calc_output(++index_); }

void TimeEvents::skip_outputs(double t) {
  index_ = std::clamp(std::lround(std::floor((t - plan_.start) / plan_.output_step)) - 1, 0L, num_outputs_);
  while (index_ < num_outputs_ && calc_output(index_) <= t + close_) ++index_;
  next_ = calc_output(index_);
}

std::optional<TimeEvent> TimeEvents::find_at(double t) const {
  const auto at = std::lower_bound(stops_.begin(), stops_.end(), t - close_,
                                   [](const TimeEvent& s, double x) { return s.time < x; });
  if (at != stops_.end() && at->time <= t + close_) return *at;
  for (const auto& s : samples_) {
    const double time = s.first + std::round((t - s.first) / s.period) * s.period;
    if (time >= s.first && std::abs(time - t) <= close_) return TimeEvent{t, t, false};
  }
  return {};
}

bool TimeEvents::is_restart(double t) const {
  const auto stop = find_at(t);
  return stop && stop->is_jump;
}

TimeEvent TimeEvents::find_next(double t) const {
  const auto at =
      std::upper_bound(stops_.begin(), stops_.end(), t, [](double x, const TimeEvent& s) { return x < s.time; });
  BOUGH_DEMAND(at != stops_.end());
  TimeEvent found = *at;
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
