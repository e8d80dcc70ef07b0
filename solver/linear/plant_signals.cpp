// Inputs and outputs of a plant, and its state changes at samples.
#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

#include "formats/records/signal_name.hpp"
#include "solver/linear/plant.hpp"
#include "solver/system/derivative.hpp"
#include "solver/system/law_difference.hpp"

namespace bough::solver {
namespace {

/// Limits of the iterations at the start, as of a run (solver/simulate/event_mode.cpp).
constexpr int kMaxStartLags = 50, kMaxStartSwitches = 100;

/// `name` with component i (from 0) of the block's outputs: names of its description, x y z of three, counts of others.
std::string name_component(const Block& block, const std::string& name, int i) {
  const int size = block.sizes.outputs;
  if (size == 1) return name;
  const auto names = records::get_component_names(block.path, size, block.description);
  if (names != records::get_component_names(block.path, size)) return name + ":" + names[static_cast<std::size_t>(i)];
  return name + ":" + (size == 3 ? std::string(1, "xyz"[i]) : std::to_string(i + 1));
}

}  // namespace

void Plant::add_inputs() {
  const auto& forces = system_.forces;
  for (size_t i = 0; i < forces.size(); ++i) {
    const bool is_moment = forces[i].pattern.size() == 0 && forces[i].kind == records::ForceKind::Moment;
    inputs_.push_back({forces[i].name, is_moment ? "F L" : "F", static_cast<int>(i)});
  }
  num_forces_ = static_cast<int>(inputs_.size());
  for (const auto& p : system_.signals.places) {
    const int n = p.actuator >= 0 ? p.block->sizes.inputs : 0;
    for (int i = 0; i < n; ++i)
      inputs_.push_back({n == 1 ? p.block->name : p.block->name + ":" + std::to_string(i + 1), "by the controller", -1,
                         p.actuator + i});
  }
  num_actuators_ = static_cast<int>(inputs_.size()) - num_forces_;
  for (size_t i = 0; i < dofs_.size(); ++i) {
    if (!dofs_[i].is_mode) inputs_.push_back({dofs_[i].name, dofs_[i].dims == "L" ? "F" : "F L", -1, -1, rows_[i]});
  }
  const auto is_taken = [&](const std::string& name) {
    return std::any_of(inputs_.begin(), inputs_.end(), [&](const PlantInput& input) {
      return input.name == name || input.name.starts_with(name + ":");
    });
  };
  std::vector<PlantInput> more;
  for (const auto& p : system_.signals.places) {
    const bool is_signal = p.block->kind == BlockKind::Sensor || p.block->kind == BlockKind::Input ||
                           p.block->kind == BlockKind::Controller;
    if (p.actuator >= 0 || !is_signal) continue;
    const std::string name = is_taken(p.block->name) ? p.block->path : p.block->name;
    const int size = p.block->sizes.outputs;
    for (int i = 0; i < size; ++i)
      more.push_back({name_component(*p.block, name, i), p.block->dims, -1, -1, -1, p.out + i});
  }
  inputs_.insert(inputs_.end(), more.begin(), more.end());
}

std::string Plant::find_frozen_law(int i) const {
  if (!is_open_) return "";
  int first = num_sensor_outputs_;
  for (const auto& p : system_.signals.places) {
    if (p.block->kind != BlockKind::Controller) continue;
    const int size = p.block->sizes.outputs;
    if (i >= first && i < first + size)
      return p.block->sizes.states + p.block->sizes.memory > 0 ? p.block->name : std::string();
    first += size;
  }
  return "";
}

void Plant::add_outputs() {
  for (const BlockKind kind : {BlockKind::Sensor, BlockKind::Controller, BlockKind::Actuator}) {
    for (const auto& p : system_.signals.places) {
      if (p.block->kind != kind) continue;
      for (int i = 0; i < p.block->sizes.outputs; ++i) {
        outputs_.name.push_back(name_component(*p.block, p.block->name, i));
        outputs_.dims.push_back(p.block->dims);
      }
    }
    if (kind == BlockKind::Sensor) num_sensor_outputs_ = outputs_.size();
  }
  for (const auto& p : system_.signals.places) {
    const int n = p.actuator >= 0 ? p.block->sizes.inputs : 0;
    for (int i = 0; i < n; ++i) {
      outputs_.name.push_back(p.block->name + ":command" + (n == 1 ? "" : std::to_string(i + 1)));
      outputs_.dims.push_back("by the controller");
    }
  }
}

Difference Plant::differentiate(const std::function<VectorXd(double)>& f, double step, std::vector<LawKink>* kinks) {
  // Dependent positions are those of the last iteration of the assembly. Stiff bodies turn its round-off into
  // accelerations that a short step would take for a slope.
  return differentiate_system(*data_, *tangents_, f, step, has_loops() || lies_far(system_.tree, data_->tree), kinks);
}

VectorXd Plant::evaluate(const OperatingPoint& point, const PlantInput* input, double value) {
  const int n = num_dofs(), nz = num_states();
  const SignalGraph& signals = system_.signals;
  VectorXd out(n + nz + outputs_.size()), u_dot(system_.num_u());
  compute(point, input, value, u_dot);
  out.head(n) = u_dot(rows_);
  VectorXd z_dot(system_.num_z());
  calc_z_dot(system_, *data_, z_dot);
  calc_signals(system_, *data_);
  out.segment(n, num_signal_states()) = z_dot(state_rows_);
  out.segment(n + num_signal_states(), num_paths()) = data_->tree.u(path_rows_);
  const SignalData& s = data_->signals;
  int at = n + nz;
  for (const auto& p : signals.places) {
    if (p.block->kind != BlockKind::Sensor) continue;
    signals.calc_ideal(p, get_motion(system_, *data_), data_->signals, out.data() + at);
    at += p.block->sizes.outputs;
  }
  for (const BlockKind kind : {BlockKind::Controller, BlockKind::Actuator}) {
    for (const auto& p : signals.places) {
      if (p.block->kind != kind) continue;
      for (int i = 0; i < p.block->sizes.outputs; ++i)
        out[at++] = s.values[p.out + i] - (s.shift.size() > 0 ? s.shift[p.out + i] : 0);
    }
  }
  for (const auto& p : signals.places) {
    const int n = p.actuator >= 0 ? p.block->sizes.inputs : 0;
    for (int i = 0; i < n; ++i) out[at++] = s.inputs[p.in + i] - s.bias[p.actuator + i];
  }
  return out;
}

void Plant::compute(const OperatingPoint& point, const PlantInput* input, double value, VectorXd& u_dot) {
  SignalData& s = data_->signals;
  s.memory = point.memory;
  s.bias.setZero();
  s.shift.resize(0);
  if (input && input->actuator >= 0) s.bias[input->actuator] = value;
  if (input && input->signal >= 0) s.shift = value * VectorXd::Unit(s.values.size(), input->signal);
  t_ = point.t;
  calc_motion(system_, *data_, point.t, point.q, calc_speeds(point), point.z, u_dot, [&] {
    if (input && input->force >= 0) {
      AppliedForce one = system_.forces[static_cast<size_t>(input->force)];
      one.function = nullptr;
      one.direction *= value;
      one.pattern *= value;
      one.pattern_K2 *= value;
      one.pattern_higher *= value;
      one.pattern_resultant *= value;
      one.pattern_moment *= value;
      add_applied_force(one, system_.tree, point.t, data_->tree);
    } else if (input && input->row >= 0) {
      data_->tree.hinge_force[input->row] += value;
    }
  });
}

std::vector<std::string> Plant::list_cuts() const {
  std::vector<std::string> names;
  for (const auto& input : inputs_)
    if (input.actuator >= 0 || input.signal >= 0) names.push_back(input.name);
  return names;
}

Plant::Cut Plant::find_cut(const std::string& name) const {
  Cut cut;
  for (size_t i = 0; i < inputs_.size(); ++i) {
    if (inputs_[i].name != name || (inputs_[i].actuator < 0 && inputs_[i].signal < 0)) continue;
    cut.input = static_cast<int>(i);
    break;
  }
  if (cut.input < 0) return cut;
  const PlantInput& input = inputs_[static_cast<size_t>(cut.input)];
  // Sensors, controllers and actuators each in the order of the file, as add_outputs has them.
  int at = 0;
  for (const BlockKind kind : {BlockKind::Sensor, BlockKind::Controller, BlockKind::Actuator}) {
    for (const auto& p : system_.signals.places) {
      if (p.block->kind != kind) continue;
      if (input.signal >= p.out && input.signal < p.out + p.block->sizes.outputs)
        cut.output = at + input.signal - p.out;
      at += p.block->sizes.outputs;
    }
  }
  if (input.actuator >= 0) cut.output = at + input.actuator;
  return cut;
}

/// For each block: true if its output influences the motion, also through sampled blocks (drives_motion excludes
/// these).
std::vector<bool> Plant::find_in_loop() const {
  const auto& places = system_.signals.places;
  std::vector<size_t> block_of;
  for (size_t i = 0; i < places.size(); ++i) {
    const auto end = static_cast<size_t>(places[i].out + places[i].block->sizes.outputs);
    block_of.resize(std::max(block_of.size(), end), i);
  }
  std::vector<bool> is_in_loop(places.size(), false);
  std::vector<size_t> open;
  for (size_t i = 0; i < places.size(); ++i)
    if (places[i].drives_motion) open.push_back(i);
  while (!open.empty()) {
    const size_t i = open.back();
    open.pop_back();
    if (is_in_loop[i]) continue;
    is_in_loop[i] = true;
    for (const int row : places[i].sources) open.push_back(block_of[static_cast<size_t>(row)]);
  }
  return is_in_loop;
}

void Plant::add_sampled() {
  is_felt_ = find_in_loop();
  const auto& places = system_.signals.places;
  for (size_t k = 0; k < places.size(); ++k) {
    const auto& p = places[k];
    if (!p.is_sampled() || !is_felt_[k]) continue;
    const auto add = [&](int first, int size, const char* what) {
      for (int i = 0; i < size; ++i) {
        sampled_rows_.push_back(first + i);
        sampled_names_.push_back(p.block->label + " (" + what + " " + std::to_string(i + 1) + ")");
      }
    };
    add(p.memory, p.block->sizes.memory, "memory");
    add(p.held, p.block->sizes.outputs, "held");
    if (p.queue_length > 0)
      queues_.push_back(
          {static_cast<int>(sampled_rows_.size()), p.block->sizes.outputs, p.queue_length, p.block->sizes.sample_time});
    if (!is_open_) {
      const auto rows = static_cast<size_t>(p.block->sizes.memory + p.block->sizes.outputs);
      steady_rows_.insert(steady_rows_.end(), sampled_rows_.end() - static_cast<std::ptrdiff_t>(rows),
                          sampled_rows_.end());
      steady_names_.insert(steady_names_.end(), sampled_names_.end() - static_cast<std::ptrdiff_t>(rows),
                           sampled_names_.end());
      steady_period_.insert(steady_period_.end(), rows, p.block->sizes.sample_time);
    }
    add(p.queue, p.block->sizes.outputs * p.queue_length, "on its way");
  }
}

std::vector<SampleTimes> Plant::collect_samples() const { return system_.signals.collect_samples(); }

std::vector<std::pair<double, int>> Plant::list_cycles() const {
  std::vector<std::pair<double, int>> cycles;
  const auto& places = system_.signals.places;
  for (size_t k = 0; k < places.size(); ++k) {
    const auto& p = places[k];
    if (p.is_sampled() && is_felt_[k]) cycles.emplace_back(p.block->sizes.sample_time, std::max(1, p.queue_length));
  }
  return cycles;
}

VectorXd Plant::sample(const OperatingPoint& point, const PlantInput* input, double before, double value) {
  VectorXd u_dot(system_.num_u());
  compute(point, input, before, u_dot);
  calc_signals(system_, *data_);
  SignalData& s = data_->signals;
  if (input && input->actuator >= 0) s.bias[input->actuator] = value;
  if (input && input->signal >= 0) s.shift[input->signal] = value;
  s.is_ideal = true;
  double shortest = 0;
  for (const auto& [period, queue] : list_cycles()) shortest = shortest > 0 ? std::min(shortest, period) : period;
  system_.signals.sample(get_motion(system_, *data_), data_->signals, 1e-9 * shortest);
  s.is_ideal = false;
  return s.memory;
}

SampleTimes Plant::find_hold(const PlantInput& input) const {
  const SignalGraph& signals = system_.signals;
  const auto find_place = [&](int row) -> const BlockSlot* {
    for (const auto& p : signals.places)
      if (row >= p.out && row < p.out + p.block->sizes.outputs) return &p;
    return nullptr;
  };
  const auto is_same = [](const SampleTimes& a, const SampleTimes& b) {
    return a.first == b.first && a.period == b.period;
  };
  // Samples that a row follows with direct feedthrough: period 0 if constant, period < 0 if continuous or of several.
  const std::function<SampleTimes(int)> look = [&](int row) -> SampleTimes {
    const BlockSlot* p = find_place(row);
    if (p == nullptr) return {0, -1};
    const BlockSizes& sizes = p->block->sizes;
    if (p->is_sampled()) return {signals.start + sizes.delay, sizes.sample_time};
    if (p->block->kind == BlockKind::Function) return {};
    if (p->block->kind == BlockKind::Sensor || p->block->kind == BlockKind::Actuator || sizes.states > 0)
      return {0, -1};
    SampleTimes all;
    for (const int source : p->sources) {
      const SampleTimes one = look(source);
      if (one.period == 0) continue;
      if (one.period < 0 || (all.period > 0 && !is_same(all, one))) return {0, -1};
      all = one;
    }
    return all;
  };
  SampleTimes found;
  if (input.signal >= 0) {
    found = look(input.signal);
  } else {
    for (const auto& p : signals.places) {
      const int i = input.actuator - p.actuator;
      if (p.actuator < 0 || i < 0 || i >= p.block->sizes.inputs || i >= static_cast<int>(p.sources.size())) continue;
      found = look(p.sources[static_cast<size_t>(i)]);
    }
  }
  return found.period > 0 ? found : SampleTimes{};
}

double Plant::calc_return(const OperatingPoint& point, const PlantInput& input, double value) {
  VectorXd u_dot(system_.num_u());
  compute(point, &input, value, u_dot);
  calc_signals(system_, *data_);
  const SignalData& s = data_->signals;
  if (input.signal >= 0) return s.values[input.signal] - s.shift[input.signal];
  for (const auto& p : system_.signals.places) {
    const int i = input.actuator - p.actuator;
    if (p.actuator >= 0 && i >= 0 && i < p.block->sizes.inputs) return s.inputs[p.in + i] - value;
  }
  return 0;
}

VectorXd Plant::sample_all(const OperatingPoint& point) {
  VectorXd u_dot(system_.num_u());
  compute(point, nullptr, 0, u_dot);
  calc_signals(system_, *data_);
  system_.signals.sample_all(get_motion(system_, *data_), data_->signals);
  return data_->signals.memory;
}

VectorXd Plant::calc_sample_rates(const OperatingPoint& point) {
  if (steady_rows_.empty()) return {};
  const VectorXd change = (sample_all(point) - point.memory)(steady_rows_);
  return change.cwiseQuotient(Eigen::Map<const VectorXd>(steady_period_.data(), change.size()));
}

Motion Plant::gather_signals(const OperatingPoint& point) {
  VectorXd u_dot(system_.num_u());
  compute(point, nullptr, 0, u_dot);
  calc_signals(system_, *data_);
  return get_motion(system_, *data_);
}

void Plant::initialize_lags(OperatingPoint& point) {
  const SignalGraph& signals = system_.signals;
  if (signals.num_states == 0) return;
  for (int i = 0; i < kMaxStartLags; ++i) {
    const Motion motion = gather_signals(point);
    const VectorXd before = data_->signals.z;
    const bool has_steady = signals.settle(motion, data_->signals);
    point.z.head(signals.num_states) = data_->signals.z;
    if (!has_steady || data_->signals.z == before) return;
  }
}

std::string Plant::iterate_switches(OperatingPoint& point) {
  const SignalGraph& signals = system_.signals;
  std::string label;
  if (signals.num_event_functions == 0) return label;
  VectorXd g(signals.num_event_functions);
  std::vector<BlockSwitch> switched;
  for (int i = 0; i < kMaxStartSwitches; ++i) {
    const Motion motion = gather_signals(point);
    signals.calc_event_functions(motion, data_->signals, g);
    switched.clear();
    if (!signals.switch_over(motion, data_->signals, g, switched)) return label;
    point.memory = data_->signals.memory;
    label = switched.back().block->label;
  }
  throw ComputationError("control.chatter", switched.back().block->at, label + " switches without end at one time",
                         "give it a hysteresis, or a lag on the way round its loop");
}

void Plant::initialize_signals(OperatingPoint& point) {
  const SignalGraph& signals = system_.signals;
  if (signals.places.empty()) return;
  SignalData& s = data_->signals;
  const bool was_open = std::exchange(s.is_open, false);
  initialize_lags(point);
  if (signals.has_samples()) {
    double shortest = std::numeric_limits<double>::infinity();
    for (const SampleTimes& times : signals.collect_samples()) shortest = std::min(shortest, times.period);
    const Motion motion = gather_signals(point);
    signals.sample(motion, s, 1e-9 * shortest);
    point.memory = s.memory;
  }
  iterate_switches(point);
  initialize_lags(point);  // lags that follow samples
  s.is_open = was_open;
}

void Plant::fill_queues(VectorXd& memory) const {
  for (const auto& p : system_.signals.places) {
    const int n = p.block->sizes.outputs;
    for (int k = 0; k < p.queue_length; ++k) memory.segment(p.queue + n * k, n) = memory.segment(p.held, n);
  }
}

}  // namespace bough::solver
