#include <algorithm>

#include "solver/integrate/locate.hpp"
#include "solver/integrate/run.hpp"

namespace bough::solver {

std::optional<Firing> Run::watch_signals(const Stop& stop, double to) {
  if (!setup_.triggers.has_signals()) return {};
  const double from = stepper_->last_time();
  guard([&] { stepper_->calc_state(to, y_); });
  calc_gaps(std::min(to, stop.latest));
  std::vector<size_t> crossed;
  setup_.triggers.find_crossed(gaps_, crossed);
  std::vector<Firing> firings;
  for (const size_t i : crossed) {
    const auto row = static_cast<Eigen::Index>(i);
    const auto calc_gap = [&](double t) {
      guard([&] { stepper_->calc_state(t, y_); });
      setup_.triggers.calc_gaps(calc_sample(std::min(t, stop.latest), y_), trial_gaps_);
      return trial_gaps_[row];
    };
    const double asked = setup_.triggers.get(i).tolerance;
    firings.push_back(
        {locate_crossing(calc_gap, from, last_gaps_[row], to, gaps_[row], asked > 0 ? asked : timeline_.resolution()),
         i});
  }
  last_gaps_ = gaps_;
  return fire(firings);
}

std::optional<Firing> Run::pass(const Stop& stop) {
  std::vector<Firing> firings;
  passed_ = stop.time;
  setup_.triggers.find_due(stop.time, timeline_.resolution(), firings);
  if ((stop.restarts || has_switched_) && stop.time < timeline_.end()) {
    observe(stop.time);
    std::vector<size_t> crossed;
    setup_.triggers.find_crossed(calc_gaps(stop.time), crossed);
    for (const size_t i : crossed) firings.push_back({stop.time, i});
    last_gaps_ = gaps_;
  }
  return fire(firings);
}

std::optional<Firing> Run::fire(std::vector<Firing>& firings) {
  std::stable_sort(firings.begin(), firings.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  for (const Firing& f : firings) {
    sink_.write_event({f.time, setup_.triggers.describe(f.trigger)});
    if (setup_.triggers.get(f.trigger).action == records::EventAction::Stop) return f;
  }
  return {};
}

SimulateOutcome Run::finish(const Firing& firing) {
  if (is_started_) guard([&] { stepper_->calc_state(firing.time, y_); });
  if (last_sample_ < firing.time) {
    observe(firing.time);
    sink_.write_sample(setup_.recorder.keep_sample());
  }
  save(firing.time);
  return close(firing.time,
               "stopped by " + setup_.triggers.describe(firing.trigger) + " at t = " + short_text(firing.time));
}

}  // namespace bough::solver
