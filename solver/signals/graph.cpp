#include "solver/signals/graph.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace bough::solver {
namespace {

/// Index, from the first, of the instant within `close` of t; -1 if there is none.
long find_sample(double t, double first, double period, double close) {
  const long k = std::lround((t - first) / period);
  return k >= 0 && std::abs(t - (first + static_cast<double>(k) * period)) <= close ? k : -1;
}

/// Number of the first sample of a run from `start`, counted from time zero: the parts of a mission draw different
/// noise, and the same as one run where they meet at a sample.
long calc_first_number(double start, double period) {
  const double periods = start / period, nearest = std::round(periods);
  const bool is_sample = std::abs(periods - nearest) <= 1e-9 * std::max(1.0, std::abs(periods));
  return std::lround(is_sample ? nearest : std::ceil(periods));
}

void demand_finite(const BlockSlot& place, const double* y, double t) {
  for (int i = 0; i < place.block->sizes.outputs; ++i) {
    if (std::isfinite(y[i])) continue;
    std::ostringstream what;
    what << place.block->label << ": output " << i + 1 << " is " << y[i] << " at t = " << t;
    throw ComputationError("control.not-finite", place.block->at, what.str(),
                           "look at its inputs (bough plot) and its numbers");
  }
}

void add_shift(const BlockSlot& p, SignalData& s) {
  if (s.shift.size() > 0)
    s.values.segment(p.out, p.block->sizes.outputs) += s.shift.segment(p.out, p.block->sizes.outputs);
}

}  // namespace

SignalData SignalGraph::make_data() const {
  SignalData s;
  s.values = VectorXd::Zero(num_values);
  s.z = VectorXd::Zero(num_states);
  s.memory = s.scratch = VectorXd::Zero(num_memory);
  s.fresh = VectorXd::Zero(num_values);
  s.inputs = VectorXd::Zero(num_inputs);
  s.bias = s.command = VectorXd::Zero(num_actuators);
  for (const auto& p : places) {
    s.block_scratch.push_back(p.block->make_scratch());
    p.block->start(s.z.data() + p.state, s.memory.data() + p.memory);
    if (p.activity >= 0) s.memory[p.activity] = p.is_active ? 1 : 0;
  }
  return s;
}

const BlockSlot* SignalGraph::find(const std::string& path) const {
  for (const auto& p : places) {
    if (p.block->path == path) return &p;
  }
  return nullptr;
}

BlockInput SignalGraph::view_inputs(const BlockSlot& p, const Motion& motion, const SignalData& signals) const {
  const SignalData& s = signals;
  const auto place = static_cast<size_t>(&p - places.data());
  return {motion.data.t, s.inputs.data() + p.in,       s.z.data() + p.state, s.memory.data() + p.memory, 0,
          &motion,       s.block_scratch[place].get(), motion.data.tangents};
}

BlockInput SignalGraph::look(const BlockSlot& p, const Motion& motion, SignalData& signals) const {
  SignalData& s = signals;
  for (size_t i = 0; i < p.sources.size(); ++i)
    s.inputs[p.in + static_cast<Eigen::Index>(i)] = p.gains[i] * s.values[p.sources[i]];
  if (p.actuator >= 0) {
    const int n = p.block->sizes.inputs;
    auto given = s.inputs.segment(p.in, n);
    if (s.is_open)
      given = s.command.segment(p.actuator, n);
    else if (p.sources.empty())
      given.setZero();
    given += s.bias.segment(p.actuator, n);
  }
  return view_inputs(p, motion, signals);
}

void SignalGraph::calc(const BlockSlot& p, const Motion& motion, SignalData& signals) const {
  SignalData& s = signals;
  double* y = s.values.data() + p.out;
  if (is_off(p, s)) {
    s.values.segment(p.out, p.block->sizes.outputs).setZero();
    return;
  }
  if (p.is_sampled()) {
    s.values.segment(p.out, p.block->sizes.outputs) = s.memory.segment(p.held, p.block->sizes.outputs);
  } else {
    p.block->calc_outputs(look(p, motion, signals), y);
    demand_finite(p, y, motion.data.t);
  }
  add_shift(p, s);
}

void SignalGraph::calc_before_acceleration(const Motion& motion, SignalData& signals) const {
  signals.is_after_acceleration = false;
  for (const int i : order) {
    const auto& p = places[static_cast<size_t>(i)];
    if (p.drives_motion && !p.needs_acceleration) calc(p, motion, signals);
  }
}

void SignalGraph::calc_after_acceleration(const Motion& motion, SignalData& signals) const {
  signals.is_after_acceleration = true;
  for (const int i : order) {
    const auto& p = places[static_cast<size_t>(i)];
    if (p.drives_motion && p.needs_acceleration) calc(p, motion, signals);
  }
}

void SignalGraph::calc_all(const Motion& motion, SignalData& signals) const {
  for (const bool needs_acceleration : {false, true}) {
    for (const int i : order) {
      const auto& p = places[static_cast<size_t>(i)];
      if (p.needs_acceleration == needs_acceleration &&
          !(p.drives_motion && (!needs_acceleration || signals.is_after_acceleration)))
        calc(p, motion, signals);
    }
  }
}

void SignalGraph::calc_some(const Motion& motion, SignalData& signals, std::vector<bool>& chosen) const {
  for (auto i = order.rbegin(); i != order.rend(); ++i) {
    const auto& p = places[static_cast<size_t>(*i)];
    if (!chosen[static_cast<size_t>(*i)] || p.is_sampled() || !p.block->sizes.has_feedthrough) continue;
    for (const int value : p.sources) {
      const auto next = std::upper_bound(places.begin(), places.end(), value,
                                         [](int row, const BlockSlot& place) { return row < place.out; });
      chosen[static_cast<size_t>(next - places.begin() - 1)] = true;
    }
  }
  for (const int i : order) {
    const auto& p = places[static_cast<size_t>(i)];
    if (chosen[static_cast<size_t>(i)] && !p.needs_acceleration) calc(p, motion, signals);
  }
}

void SignalGraph::calc_ideal(const BlockSlot& place, const Motion& motion, SignalData& signals, double* y) const {
  place.block->calc_ideal(look(place, motion, signals), y);
}

bool SignalGraph::settle(const Motion& motion, SignalData& signals) const {
  bool has_any = false;
  for (const auto& p : places) {
    if (p.block->sizes.states == 0) continue;
    const BlockInput in = look(p, motion, signals);
    has_any = p.block->settle(in, signals.z.data() + p.state) || has_any;
  }
  return has_any;
}

void SignalGraph::add_loads(const Motion& motion, const SignalData& signals, TreeData& data) const {
  if (places.empty()) return;
  for (const auto& p : places) {
    if (p.actuator >= 0) p.block->add_load(view_inputs(p, motion, signals), signals.values.data() + p.out, data);
  }
}

void SignalGraph::calc_rates(const Motion& motion, SignalData& signals, Eigen::Ref<VectorXd> z_dot) const {
  BOUGH_DEMAND(z_dot.size() == num_states);
  for (const auto& p : places) {
    if (p.block->sizes.states == 0) continue;
    if (is_off(p, signals))
      z_dot.segment(p.state, p.block->sizes.states).setZero();
    else
      p.block->calc_rates(look(p, motion, signals), z_dot.data() + p.state);
  }
}

double SignalGraph::calc_power(const Motion& motion, const SignalData& signals) const {
  double power = 0;
  if (places.empty()) return power;
  for (const auto& p : places) {
    if (p.actuator >= 0) power += p.block->calc_power(view_inputs(p, motion, signals), signals.values.data() + p.out);
  }
  return power;
}

double SignalGraph::calc_energy(const Motion& motion, const SignalData& signals) const {
  double energy = 0;
  if (places.empty()) return energy;
  for (const auto& p : places) {
    if (p.actuator >= 0) energy += p.block->calc_energy(view_inputs(p, motion, signals));
  }
  return energy;
}

Vector3d SignalGraph::calc_momentum(const Motion& motion, const SignalData& signals) const {
  Vector3d momentum = Vector3d::Zero();
  if (places.empty()) return momentum;
  for (const auto& p : places) {
    if (p.actuator >= 0) momentum += p.block->calc_momentum(view_inputs(p, motion, signals));
  }
  return momentum;
}

VectorXd SignalGraph::calc_consumption(const Motion& motion, const SignalData& signals) const {
  VectorXd used = VectorXd::Zero(motion.tree.size());
  for (const auto& p : places) {
    if (p.actuator >= 0) p.block->add_consumption(view_inputs(p, motion, signals), used);
  }
  return used;
}

std::vector<SampleTimes> SignalGraph::collect_samples() const {
  std::vector<SampleTimes> found;
  const auto add = [&](double first, double period) {
    for (const auto& s : found) {
      if (s.first == first && s.period == period) return;
    }
    found.push_back({first, period});
  };
  for (const auto& p : places) {
    if (!p.is_sampled()) continue;
    add(start, p.block->sizes.sample_time);
    if (p.queue_length > 0) add(start + p.block->sizes.delay, p.block->sizes.sample_time);
  }
  return found;
}

bool SignalGraph::sample(const Motion& motion, SignalData& signals, double close) const {
  SignalData& s = signals;
  const double t = motion.data.t;
  bool has_changed = false;
  for (const int i : order) {
    const auto& p = places[static_cast<size_t>(i)];
    if (!p.is_sampled()) {
      if (!p.needs_acceleration) calc(p, motion, signals);
      continue;
    }
    const int n = p.block->sizes.outputs;
    const double period = p.block->sizes.sample_time;
    auto held = s.memory.segment(p.held, n);
    auto before = s.fresh.segment(p.out, n);
    before = held;
    if (is_off(p, s)) {
      held.setZero();
      s.memory.segment(p.queue, n * p.queue_length).setZero();
      has_changed = has_changed || (p.drives_motion && before != held);
      s.values.segment(p.out, n) = held;
      continue;
    }
    if (const long k = find_sample(t, start, period, close); k >= 0) {
      BlockInput in = look(p, motion, signals);
      in.sample = calc_first_number(start, period) + k;
      const int slot = p.queue_length > 0 ? p.queue + n * static_cast<int>(k % p.queue_length) : p.held;
      if (s.is_ideal && p.block->kind == BlockKind::Sensor)
        p.block->calc_ideal(in, s.memory.data() + slot);
      else
        p.block->calc_outputs(in, s.memory.data() + slot);
      demand_finite(p, s.memory.data() + slot, t);
      auto own = s.scratch.segment(p.memory, p.block->sizes.memory);
      own = s.memory.segment(p.memory, p.block->sizes.memory);
      p.block->update(in, own.data());
      s.memory.segment(p.memory, p.block->sizes.memory) = own;
    }
    if (p.queue_length > 0) {
      const long k = find_sample(t, start + p.block->sizes.delay, period, close);
      if (k >= 0) held = s.memory.segment(p.queue + n * static_cast<int>(k % p.queue_length), n);
    }
    has_changed = has_changed || (p.drives_motion && before != held);
    s.values.segment(p.out, n) = held;
    add_shift(p, s);
  }
  return has_changed;
}

void SignalGraph::sample_all(const Motion& motion, SignalData& signals) const {
  SignalData& s = signals;
  for (const int i : order) {
    const auto& p = places[static_cast<size_t>(i)];
    if (!p.is_sampled()) {
      if (!p.needs_acceleration) calc(p, motion, signals);
      continue;
    }
    auto held = s.memory.segment(p.held, p.block->sizes.outputs);
    if (is_off(p, s)) {
      held.setZero();
    } else {
      BlockInput in = look(p, motion, signals);
      in.sample = std::lround(motion.data.t / p.block->sizes.sample_time);
      if (p.block->kind == BlockKind::Sensor) {
        p.block->calc_ideal(in, held.data());  // its walk is noise
      } else {
        p.block->calc_outputs(in, held.data());
        auto own = s.scratch.segment(p.memory, p.block->sizes.memory);
        own = s.memory.segment(p.memory, p.block->sizes.memory);
        p.block->update(in, own.data());
        s.memory.segment(p.memory, p.block->sizes.memory) = own;
      }
    }
    s.values.segment(p.out, p.block->sizes.outputs) = held;
  }
}

void SignalGraph::calc_event_functions(const Motion& motion, SignalData& signals, Eigen::Ref<VectorXd> g) const {
  for (const auto& p : places) {
    if (p.block->sizes.event_functions == 0) continue;
    if (is_off(p, signals))
      g.segment(p.event_row, p.block->sizes.event_functions).setConstant(-1);
    else
      p.block->calc_event_functions(look(p, motion, signals), g.data() + p.event_row);
  }
}

bool SignalGraph::switch_over(const Motion& motion, SignalData& signals, const VectorXd& g,
                              std::vector<BlockSwitch>& switched) const {
  bool has_switched = false;
  SignalData& s = signals;
  for (const auto& p : places) {
    for (int i = 0; i < p.block->sizes.event_functions; ++i) {
      if (!(g[p.event_row + i] > 0)) continue;
      s.scratch.segment(p.memory, p.block->sizes.memory) = s.memory.segment(p.memory, p.block->sizes.memory);
      p.block->switch_over(look(p, motion, signals), i, s.scratch.data() + p.memory);
      s.memory.segment(p.memory, p.block->sizes.memory) = s.scratch.segment(p.memory, p.block->sizes.memory);
      has_switched = true;
      switched.push_back({p.block.get(), i});
      break;  // the others were of the memory before
    }
  }
  return has_switched;
}

std::string SignalGraph::name_state(int row) const {
  for (const auto& p : places) {
    if (row >= p.state && row < p.state + p.block->sizes.states)
      return p.block->label + " (state " + std::to_string(row - p.state + 1) + ")";
  }
  return "a state of the controllers";
}

}  // namespace bough::solver
