#include <algorithm>

#include "solver/simulate/run.hpp"

namespace bough::solver {
namespace {

/// Limits of the changes at one time, and of those in a row closer together than kMinEventSpacing, relative to the run.
constexpr int kMaxEventRounds = 20, kMaxQuickEvents = 200;
constexpr double kMinEventSpacing = 1e-9;

bool is_same(const DiscreteState& a, const DiscreteState& b) {
  const auto closes_alike = [](const ConstraintState& x, const ConstraintState& y) {
    return x.is_closed == y.is_closed;
  };
  return a.variant == b.variant && a.mode == b.mode && a.memory.size() == b.memory.size() && a.memory == b.memory &&
         std::equal(a.constraints.begin(), a.constraints.end(), b.constraints.begin(), closes_alike);
}

}  // namespace

std::optional<Occurrence> Run::find_occurrence(const TimeEvent& stop, double to) {
  look_.logs.clear();
  if (!setup_.triggers.has_signals()) return {};
  // Signs after the handled crossings; those of later crossings do not change, and none before the step is accepted.
  VectorXd& signs = setup_.triggers.signs;
  std::vector<size_t> crossed;
  signs_ = signs;
  setup_.triggers.find_crossed(events_.signals, crossed);
  std::swap(signs_, signs);
  std::vector<Occurrence> firings;
  for (const size_t i : crossed) {
    const auto row = static_cast<Eigen::Index>(i);
    const double own = setup_.triggers.get(i).tolerance, tolerance = own > 0 ? own : time_events_.resolution();
    firings.push_back({locate(&EventValues::signals, row, last_events_.signals[row], to, tolerance, stop), i});
  }
  std::stable_sort(firings.begin(), firings.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  std::optional<Occurrence> turn;
  for (const Occurrence& f : firings) {
    const auto row = static_cast<Eigen::Index>(f.trigger);
    if (turn) {
      signs_[row] = signs[row];
    } else if (setup_.triggers.get(f.trigger).action == records::EventAction::Log) {
      look_.logs.push_back({f, signs_[row]});
    } else {
      turn = f;
    }
  }
  look_.signs = signs_;
  return turn;
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

std::optional<Occurrence> Run::pass(const TimeEvent& stop) {
  std::vector<Occurrence> firings = std::move(waiting_);
  waiting_.clear();
  passed_ = stop.time;
  setup_.triggers.find_due(stop.time, time_events_.resolution(), firings);
  if ((stop.is_jump || has_switched_) && (stop.left < stop.time || stop.time < time_events_.end())) {
    observe(stop.time);
    for (const size_t i : find_crossed(stop.time)) firings.push_back({stop.time, i});
  }
  return fire(std::move(firings));
}

std::optional<Occurrence> Run::fire(std::vector<Occurrence> firings) {
  for (int round = 0; !firings.empty(); ++round) {
    bool changes = false;
    for (const Occurrence& f : firings) {
      write_event(f);
      if (setup_.triggers.get(f.trigger).action == records::EventAction::Stop) return f;
      if (setup_.triggers.get(f.trigger).action == records::EventAction::Log) continue;
      change(f);
      changes = true;
    }
    if (!changes) return {};
    const Occurrence last = firings.back();
    if (round > kMaxEventRounds || num_quick_ > kMaxQuickEvents) fail_cycle(last);
    firings.clear();
    for (const size_t i : find_crossed(last.time)) firings.push_back({last.time, i});
  }
  return {};
}

std::string Run::get_source(const Occurrence& firing) const {
  return "event " + setup_.triggers.get(firing.trigger).name;
}

void Run::write_event(const Occurrence& firing) {
  sink_.write_event({firing.time, setup_.triggers.describe(firing.trigger), get_source(firing)});
}

void Run::change(const Occurrence& firing) {
  guard([&] {
    ode_.project(firing.time, y_);
    const DiscreteState before = get_discrete(ode_.data());
    const DiscreteState next = setup_.changes.apply(firing.trigger, ode_, firing.time, y_);
    sink_.write_event({firing.time,
                       setup_.changes.describe(firing.trigger) + (is_same(next, before) ? ": it was so already" : ""),
                       get_source(firing)});
    for (const auto& what : ode_.change(firing.time, next, y_))
      sink_.write_event({firing.time, what, get_source(firing)});
    if (next.variant >= 0) set_variant();
    joint_contacts_.demand_inside(ode_, firing.time, 4 * time_events_.resolution(), y_);
  });
  const bool is_quick = firing.time - changed_ < kMinEventSpacing * (time_events_.end() - time_events_.start());
  num_quick_ = is_quick ? num_quick_ + 1 : 0;
  changed_ = firing.time;
  has_changed_ = true;
}

SimulateOutcome Run::finish(const Occurrence& firing) {
  if (last_sample_ < firing.time) {
    observe(firing.time);
    sink_.write_sample(setup_.recorder.keep_sample());
  }
  ended_by_ = static_cast<int>(firing.trigger);
  save(firing.time);
  return close(firing.time, describe_end(firing));
}

std::string Run::describe_end(const Occurrence& firing) const {
  return "stopped by " + setup_.triggers.describe(firing.trigger) + " at t = " + short_text(firing.time);
}

}  // namespace bough::solver
