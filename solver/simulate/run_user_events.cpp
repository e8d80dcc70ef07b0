#include <algorithm>

#include "solver/simulate/run.hpp"

namespace bough::solver {
namespace {

/// Changes at one time, or closer together than a billionth of the run, that are too many.
constexpr int kMostRounds = 20, kMostQuick = 200;
constexpr double kQuick = 1e-9;

bool is_same(const Discrete& a, const Discrete& b) {
  const auto closes_alike = [](const Closing& x, const Closing& y) { return x.is_closed == y.is_closed; };
  return a.mode == b.mode && a.memory.size() == b.memory.size() && a.memory == b.memory &&
         std::equal(a.closings.begin(), a.closings.end(), b.closings.begin(), closes_alike);
}

}  // namespace

std::optional<Firing> Run::find_firing(const Stop& stop, double to) {
  if (!setup_.triggers.has_signals()) return {};
  std::vector<size_t> crossed;
  signs_ = setup_.triggers.signs;
  setup_.triggers.find_crossed(events_.signals, crossed);
  std::vector<Firing> firings;
  for (const size_t i : crossed) {
    const auto row = static_cast<Eigen::Index>(i);
    const double own = setup_.triggers.get(i).tolerance, tolerance = own > 0 ? own : timeline_.resolution();
    firings.push_back({locate(&EventValues::signals, row, last_events_.signals[row], to, tolerance, stop), i});
  }
  std::stable_sort(firings.begin(), firings.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  for (auto f = firings.begin(); f != firings.end(); ++f) {
    if (setup_.triggers.get(f->trigger).action == records::EventAction::Log) {
      write_event(*f);
      continue;
    }
    const Firing turn = *f;
    for (++f; f != firings.end(); ++f) {
      const auto row = static_cast<Eigen::Index>(f->trigger);
      setup_.triggers.signs[row] = signs_[row];
    }
    return turn;
  }
  return {};
}

void Run::calc_signal_events(double t) {
  if (setup_.triggers.has_signals()) setup_.triggers.calc_gaps(calc_sample(t), events_.signals);
}

std::vector<size_t> Run::find_crossed(double t) {
  std::vector<size_t> crossed;
  calc_signal_events(t);
  setup_.triggers.find_crossed(events_.signals, crossed);
  last_events_.signals = events_.signals;
  return crossed;
}

std::optional<Firing> Run::pass(const Stop& stop) {
  std::vector<Firing> firings = std::move(waiting_);
  waiting_.clear();
  passed_ = stop.time;
  setup_.triggers.find_due(stop.time, timeline_.resolution(), firings);
  if ((stop.restarts || has_switched_) && (stop.latest < stop.time || stop.time < timeline_.end())) {
    observe(stop.time);
    for (const size_t i : find_crossed(stop.time)) firings.push_back({stop.time, i});
  }
  return fire(std::move(firings));
}

std::optional<Firing> Run::fire(std::vector<Firing> firings) {
  for (int round = 0; !firings.empty(); ++round) {
    bool changes = false;
    for (const Firing& f : firings) {
      write_event(f);
      if (setup_.triggers.get(f.trigger).action == records::EventAction::Stop) return f;
      if (setup_.triggers.get(f.trigger).action == records::EventAction::Log) continue;
      change(f);
      changes = true;
    }
    if (!changes) return {};
    const Firing last = firings.back();
    if (round > kMostRounds || num_quick_ > kMostQuick) fail_cycle(last);
    firings.clear();
    for (const size_t i : find_crossed(last.time)) firings.push_back({last.time, i});
  }
  return {};
}

std::string Run::get_source(const Firing& firing) const { return "event " + setup_.triggers.get(firing.trigger).name; }

void Run::write_event(const Firing& firing) {
  sink_.write_event({firing.time, setup_.triggers.describe(firing.trigger), get_source(firing)});
}

void Run::change(const Firing& firing) {
  guard([&] {
    ode_.project(firing.time, y_);
    const Discrete before = get_discrete(ode_.data());
    const Discrete next = setup_.changes.apply(firing.trigger, ode_, firing.time, y_);
    sink_.write_event({firing.time,
                       setup_.changes.describe(firing.trigger) + (is_same(next, before) ? ": it was so already" : ""),
                       get_source(firing)});
    for (const auto& what : ode_.change(firing.time, next, y_))
      sink_.write_event({firing.time, what, get_source(firing)});
    latches_.demand_inside(ode_, firing.time, 4 * timeline_.resolution(), y_);
  });
  const bool is_quick = firing.time - changed_ < kQuick * (timeline_.end() - timeline_.start());
  num_quick_ = is_quick ? num_quick_ + 1 : 0;
  changed_ = firing.time;
  has_changed_ = true;
}

SimulateOutcome Run::finish(const Firing& firing) {
  if (last_sample_ < firing.time) {
    observe(firing.time);
    sink_.write_sample(setup_.recorder.keep_sample());
  }
  ended_by_ = static_cast<int>(firing.trigger);
  save(firing.time);
  return close(firing.time, describe_end(firing));
}

std::string Run::describe_end(const Firing& firing) const {
  return "stopped by " + setup_.triggers.describe(firing.trigger) + " at t = " + short_text(firing.time);
}

}  // namespace bough::solver
