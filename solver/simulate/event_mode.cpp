// Samples and switches of controllers, sensors and actuators (docs/theory/control.md).
#include <algorithm>

#include "solver/simulate/run.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {
namespace {
/// Limit of the switches at one time; more do not end.
constexpr int kMaxSwitches = 100;
/// A block chatters if it switches this often within this share of the run.
constexpr int kChatterSwitches = 500;
constexpr double kShortTime = 1e-2;
/// Passes over lags in series at the start.
constexpr int kMaxLags = 50;
}  // namespace

void Run::take_samples(double t) {
  const SignalGraph& signals = ode_.system().signals;
  if (sampled_ == t || signals.places.empty()) return;
  sampled_ = t;
  if (signals.has_samples()) {
    evaluate(t, true);
    guard([&] {
      if (signals.sample(get_motion(ode_.system(), ode_.data()), ode_.data().signals, time_events_.resolution()))
        has_switched_ = true;
    });
  }
  iterate_switches(t);
}

void Run::initialize_lags(double t) {
  const SignalGraph& signals = ode_.system().signals;
  if (signals.num_states == 0) return;
  VectorXd before;
  for (int i = 0; i < kMaxLags; ++i) {
    bool is_done = true;
    evaluate(t, true);
    guard([&] {
      before = ode_.data().signals.z;
      is_done = !signals.settle(get_motion(ode_.system(), ode_.data()), ode_.data().signals) ||
                ode_.data().signals.z == before;
    });
    y_.segment(ode_.num_coordinates(), signals.num_states) = ode_.data().signals.z;
    if (is_done) return;
  }
}

void Run::iterate_switches(double t) {
  const SignalGraph& signals = ode_.system().signals;
  if (signals.num_event_functions == 0) return;
  std::vector<BlockSwitch> switched;
  for (int i = 0; i < kMaxSwitches; ++i) {
    bool is_open = false;
    calc_switches(t);
    switched.clear();
    guard([&] {
      const Motion motion = get_motion(ode_.system(), ode_.data());
      is_open = signals.switch_over(motion, ode_.data().signals, events_.switches, switched);
      for (const auto& [block, function] : switched) {
        const std::string what = block->describe_switch(motion, function);
        if (what.empty()) continue;
        sink_.write_event({t, what, block->label});
        if (block->tank >= 0) end_at_reserve(*block);
      }
    });
    last_events_.switches = events_.switches;
    if (!is_open) return;
    has_switched_ = true;
    for (const BlockSwitch& s : switched) count_switch(s.block->label, t);
  }
  finish_failed(t, "control.chatter", switched.back().block->label + " switches without end at t = " + short_text(t),
                "give it a hysteresis, or a lag on the way round its loop");
}

void Run::end_at_reserve(const Block& block) {
  const auto index = static_cast<size_t>(block.tank);
  const Tank& tank = ode_.system().tree.tanks[index];
  const double past = tank.reserve - ode_.data().tree.tanks[index].mass;
  for (const auto& p : ode_.system().signals.places) {
    if (p.block.get() != &block || past <= 0) continue;
    const int row = p.state + block.sizes.states - 1;
    double& used = y_[ode_.num_coordinates() + row];
    used = tank.used_rows.size() == 1 ? tank.initial - tank.reserve : used - past;
    ode_.data().signals.z[row] = used;
    ode_.data().tree.tanks[index].mass = tank.reserve;
  }
}

void Run::count_switch(const std::string& label, double t) {
  Switching& s = switching_[label];
  const double window = kShortTime * (time_events_.end() - time_events_.start());
  if (s.count++ == 0) s.since = t;
  if (s.count < kChatterSwitches) return;
  s.count = 0;
  if (s.is_told || t - s.since > window) return;
  s.is_told = true;
  const auto& places = ode_.system().signals.places;
  const auto place = std::find_if(places.begin(), places.end(), [&](const auto& p) { return p.block->label == label; });
  diagnostics_.warning("control.sliding", place == places.end() ? SourceLocation{} : place->block->at,
                       label + " has switched " + std::to_string(kChatterSwitches) + " times from t = " +
                           short_text(s.since) + " to " + short_text(t) + ": it slides along its switching line",
                       "give it more hysteresis (relay: on and off further apart), or sample its inputs by a gain of 1 "
                       "with sample_time");
}

void Run::get_control_memory(VectorXd& memory) const {
  const VectorXd& own = ode_.data().signals.memory;
  memory[0] = sampled_;
  memory.tail(own.size()) = own;
}

void Run::set_control_memory(const VectorXd& memory) {
  sampled_ = memory[0];
  ode_.data().signals.memory = memory.tail(memory.size() - 1);
}

}  // namespace bough::solver
