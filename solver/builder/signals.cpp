#include "solver/builder/signals.hpp"

#include <algorithm>

#include "formats/records/dims.hpp"
#include "formats/records/signal_name.hpp"
#include "solver/actuators/driven_force.hpp"
#include "solver/builder/actuators.hpp"
#include "solver/builder/lagged_stiffening.hpp"
#include "solver/builder/sensors.hpp"
#include "solver/builder/signal_units.hpp"
#include "solver/builder/sources.hpp"
#include "solver/control/controller.hpp"
#include "solver/sensors/sensor_block.hpp"
#include "solver/signals/input_block.hpp"

namespace bough::solver {
namespace {

class FunctionBlock final : public Block {
 public:
  explicit FunctionBlock(const TimeFunction* f) : f_(f) { sizes.has_feedthrough = false; }
  void calc_outputs(const BlockInput& in, double* y) const override {
    y[0] = in.motion->data.functions[*f_].calc(in.t).f;
  }

 private:
  const TimeFunction* f_;
};

class Builder {
 public:
  Builder(const records::SystemSpec& spec, System& system, const FunctionMap& functions, Diagnostics& diagnostics)
      : spec_(spec), system_(system), functions_(functions), diagnostics_(diagnostics) {}

  void build(const SignalUses& uses, const FlexMap& flex) {
    const int errors = diagnostics_.num_errors();
    system_.signals.start = system_.start;
    add_sensors();
    add_inputs();
    declare();
    wire_controllers(uses);
    add_actuators(uses);
    add_forces(uses);
    add_stiffening(flex);
    set_activities();
    system_.signals_are_valid = diagnostics_.num_errors() == errors;
    if (system_.signals_are_valid) {
      const bool is_whole = lay_out();
      if (is_whole && diagnostics_.num_errors() == errors) system_.signals.arrange(diagnostics_);
      if (is_whole && diagnostics_.num_errors() == errors) check_names();
      if (is_whole && diagnostics_.num_errors() == errors) check_units();
      system_.signals_are_valid = is_whole;
    }
    system_.signals_are_valid = system_.signals_are_valid && diagnostics_.num_errors() == errors;
    if (!system_.signals_are_valid) system_.signals = SignalGraph();
  }

 private:
  void add_sensors() {
    const auto sensors = build_sensors(system_, spec_, diagnostics_);
    for (size_t i = 0; i < sensors.size(); ++i) {
      const Sensor& entry = sensors[i];
      sources_.list.push_back({entry.name, get_folder(BlockKind::Sensor) + entry.name, entry.size,
                               add(make_sensor_block(entry, spec_.sensors[i], diagnostics_), {}), spec_.sensors[i].at});
    }
  }

  void add_inputs() {
    for (const auto& r : spec_.inputs) {
      if (!r.dims.empty() && !records::parse_dims(r.dims))
        diagnostics_.warning("control.units", r.at,
                             "input '" + r.name + "': dims \"" + r.dims + "\" is no dimension that can be read",
                             "write powers of M, L, T and F, as \"F L\" or \"L/T^2\"");
      sources_.list.push_back(
          {r.name, get_folder(BlockKind::Input) + r.name, 1, add(std::make_unique<InputBlock>(r), {}), r.at});
    }
  }

  void declare() {
    for (const auto& r : spec_.controllers)
      sources_.list.push_back({r.name, get_folder(BlockKind::Controller) + r.name, find_outputs(r), -1, r.at});
    for (const auto& r : spec_.actuators)
      sources_.list.push_back(
          {r.name, get_folder(BlockKind::Actuator) + r.name, find_actuator_outputs(r.type), -1, r.at});
    for (const auto& r : spec_.functions)
      sources_.list.push_back({r.name, get_folder(BlockKind::Function) + r.name, 1, -1, r.at});
  }

  int add(std::unique_ptr<const Block> block, std::vector<Wire> wires) {
    BlockSlot place;
    place.block = std::move(block);
    system_.signals.places.push_back(std::move(place));
    wires_.push_back(std::move(wires));
    return static_cast<int>(system_.signals.places.size()) - 1;
  }

  void wire_controllers(const SignalUses& uses) {
    struct Pending {
      const records::ControllerRecord* record;
      const ControllerUses* uses;
      std::vector<Wire> wires;  // inputs, then reference and rate
      bool is_wired = true;
    };
    std::vector<Pending> pending;
    for (const auto& r : spec_.controllers) {
      Pending p{&r, &uses.controllers.at(r.name), {}, true};
      for (const auto* list : {&p.uses->inputs, &p.uses->reference, &p.uses->rate}) {
        for (const auto& use : *list) {
          Wire wire;
          p.is_wired = sources_.find(use, "controller '" + r.name + "'", wire, diagnostics_) && p.is_wired;
          p.wires.push_back(wire);
        }
      }
      if (p.is_wired) pending.push_back(std::move(p));
    }
    // Sizes follow the arrows.
    for (bool is_new = true; is_new;) {
      is_new = false;
      for (size_t i = 0; i < pending.size();) {
        const auto is_known = [&](const Wire& w) { return sources_.size_of(w) > 0; };
        if (!std::all_of(pending[i].wires.begin(), pending[i].wires.end(), is_known)) {
          ++i;
          continue;
        }
        place_controller(*pending[i].record, *pending[i].uses, pending[i].wires);
        pending.erase(pending.begin() + static_cast<std::ptrdiff_t>(i));
        is_new = true;
      }
    }
    if (diagnostics_.num_errors() > 0) return;  // what they wait for failed
    for (const auto& p : pending)
      diagnostics_.error("control.bad-size", p.record->at,
                         "controller '" + p.record->name + "': how many inputs it has depends on its own outputs",
                         "give outputs = NUMBER, or name single components");
  }

  void place_controller(const records::ControllerRecord& record, const ControllerUses& uses,
                        const std::vector<Wire>& wires) {
    records::ControllerRecord r = record;
    ControllerWiring wiring;
    for (size_t i = 0; i < uses.inputs.size(); ++i) wiring.inputs.push_back(sources_.size_of(wires[i]));
    if (!uses.reference.empty()) {
      wiring.reference = sources_.size_of(wires[uses.inputs.size()]);
      r.reference = uses.reference.front().text;
    }
    if (!uses.rate.empty()) {
      wiring.rate = sources_.size_of(wires.back());
      r.rate = uses.rate.front().text;
    }
    auto block = make_controller(r, wiring, diagnostics_);
    if (!block) return;
    Source& source = sources_.at_path(get_folder(BlockKind::Controller) + r.name);
    source.size = block->sizes.outputs;
    source.place = add(std::move(block), wires);
    records_.resize(wires_.size(), nullptr);
    records_.back() = &record;
  }

  void add_actuators(const SignalUses& uses) {
    for (const auto& r : spec_.actuators) {
      const std::string user = "actuator '" + r.name + "'";
      auto block = make_actuator(r, system_, system_.tree, diagnostics_);
      const int takes = block ? block->sizes.inputs : 0;  // 0: not known, after an error
      std::vector<Wire> wires;
      const auto use = uses.actuators.find(r.name);
      if (use != uses.actuators.end() && !wire_scalar(use->second, user, takes, wires)) continue;
      if (block)
        sources_.at_path(get_folder(BlockKind::Actuator) + r.name).place =
            add_driver(std::move(block), std::move(wires));
    }
  }

  /// Wires the input of `user`, which takes `takes` numbers (0: not known).
  bool wire_scalar(const SignalUse& use, const std::string& user, int takes, std::vector<Wire>& wires) {
    Wire wire;
    if (!sources_.find(use, user, wire, diagnostics_)) return false;
    wires.push_back(wire);
    const int size = sources_.size_of(wire);
    if (size == takes || size == 0 || takes == 0) return true;
    diagnostics_.error("control.bad-size", use.at,
                       user + " takes " + (takes == 1 ? "one number" : std::to_string(takes) + " numbers") + ", '" +
                           use.text + "' has " + std::to_string(size),
                       takes == 1 ? "name a component, as " + use.text + ":1" : "put them together, by a gain of 1");
    return false;
  }

  int add_driver(std::unique_ptr<const Block> block, std::vector<Wire> wires) {
    const int place = add(std::move(block), std::move(wires));
    SignalGraph& g = system_.signals;
    g.places.back().actuator = g.num_actuators;
    g.num_actuators += g.places.back().block->sizes.inputs;
    return place;
  }

  void add_forces(const SignalUses& uses) {
    for (const AppliedForce& force : system_.driven) {
      std::vector<Wire> wires;
      const SignalUse& use = uses.forces.at(force.name);
      if (!wire_scalar(use, "force '" + force.name + "'", 1, wires)) continue;
      add_driver(make_driven_force(force, use.at), std::move(wires));
    }
  }

  void add_stiffening(const FlexMap& flex) {
    if (spec_.simulation.stiffening != "lagged") return;
    for (auto& block : make_lagged_stiffening(spec_, system_, flex, diagnostics_)) add_driver(std::move(block), {});
  }

  /// Makes the controllers switchable that events enable or disable, and those that start disabled.
  void set_activities() {
    for (const auto& r : spec_.controllers) {
      const auto switches = [&](const records::UserEventRecord& e) {
        using records::EventAction;
        return e.target == r.name && (e.action == EventAction::Enable || e.action == EventAction::Disable);
      };
      const int place = sources_.at_path(get_folder(BlockKind::Controller) + r.name).place;
      if (place < 0 || (r.active && std::none_of(spec_.events.begin(), spec_.events.end(), switches))) continue;
      BlockSlot& p = system_.signals.places[static_cast<size_t>(place)];
      p.activity = 0;  // a row, once they are laid out
      p.is_active = r.active;
    }
  }

  /// The function's block, made when it is first named.
  int get_place(Source& source) {
    if (source.place >= 0) return source.place;
    const auto found = functions_.find(source.name);
    if (found == functions_.end() || found->second == nullptr) return -1;  // or a controller that could not be made
    const TimeFunction* f = found->second;
    auto block = std::make_unique<FunctionBlock>(f);
    block->set_name(BlockKind::Function, source.name);
    block->label = "function '" + source.name + "'";
    block->description = "function of time";
    block->dims = "by the function";
    const auto add_times = [](std::vector<double>& to, const std::vector<double>& times) {
      to.insert(to.end(), times.begin(), times.end());
    };
    add_times(system_.jump_times, f->force_jump_times());
    add_times(system_.mesh_times, f->mesh_times());
    return source.place = add(std::move(block), {});
  }

  /// Returns false if a named function is invalid, which has been reported.
  bool lay_out() {
    SignalGraph& g = system_.signals;
    for (size_t i = 0; i < wires_.size(); ++i) {  // grows by functions, which have no wires
      for (size_t k = 0; k < wires_[i].size(); ++k) {
        if (get_place(sources_.list[wires_[i][k].source]) < 0) return false;
      }
    }
    for (BlockSlot& p : g.places) {
      const BlockSizes& s = p.block->sizes;
      p.in = g.num_inputs;
      p.out = g.num_values;
      p.state = g.num_states;
      p.memory = g.num_memory;
      p.event_row = g.num_event_functions;
      g.num_inputs += s.inputs;
      g.num_values += s.outputs;
      g.num_states += s.states;
      g.num_memory += s.memory;
      g.num_event_functions += s.event_functions;
      if (p.block->tank >= 0)
        system_.tree.tanks[static_cast<std::size_t>(p.block->tank)].used_rows.push_back(p.state + s.states - 1);
      if (p.activity >= 0) p.activity = g.num_memory++;
      if (!p.is_sampled()) continue;
      p.held = g.num_memory;
      g.num_memory += s.outputs;
      if (s.delay <= 0) continue;
      p.queue_length = static_cast<int>(s.delay / s.sample_time * (1 + 1e-12)) + 2;
      p.queue = g.num_memory;
      g.num_memory += p.queue_length * s.outputs;
    }
    for (size_t i = 0; i < g.places.size(); ++i) {
      for (const Wire& wire : wires_[i]) connect(g.places[i], wire);
    }
    return true;
  }

  void connect(BlockSlot& to, const Wire& wire) {
    const Source& source = sources_.list[wire.source];
    const BlockSlot& from = system_.signals.places[static_cast<size_t>(source.place)];
    const auto add_row = [&](int row) {
      to.sources.push_back(row);
      to.gains.push_back(wire.gain);
    };
    if (wire.component < 0) {
      for (int i = 0; i < from.block->sizes.outputs; ++i) add_row(from.out + i);
      return;
    }
    const int n = from.block->sizes.outputs;
    const int component = records::find_component({source.path, wire.text}, n, from.block->description);
    if (component >= 0) {
      add_row(from.out + component);
      return;
    }
    std::string list;
    for (const auto& name : records::get_component_names(source.path, n, from.block->description))
      list += (list.empty() ? "" : ", ") + name;
    diagnostics_.error(
        "control.unknown-signal", wire.at,
        to.block->label + " names component '" + wire.text + "' of '" + source.name + "', which does not exist",
        list.empty() ? "it is a scalar: leave the component out" : "its components are " + list);
  }

  /// Reports a name that is also that of a component of another source: "v:z" next to a vector "v".
  void check_names() {
    for (const Source& source : sources_.list) {
      const auto colon = source.name.rfind(':');
      if (colon == std::string::npos) continue;
      for (const Source& other : sources_.list) {
        if (other.name != source.name.substr(0, colon) || other.place < 0) continue;
        const Block& block = *system_.signals.places[static_cast<size_t>(other.place)].block;
        const records::SignalName name{other.path, source.name.substr(colon + 1)};
        if (records::find_component(name, block.sizes.outputs, block.description) < 0) continue;
        diagnostics_.error("control.ambiguous-name", source.at,
                           source.path + " has the name of a component of " + other.path + ", '" + source.name + "'",
                           "give it a name without a colon");
      }
    }
  }

  void check_units() {
    records_.resize(wires_.size(), nullptr);
    check_signal_units(system_.signals, records_, diagnostics_);
  }

  const records::SystemSpec& spec_;
  System& system_;
  const FunctionMap& functions_;
  Diagnostics& diagnostics_;
  Sources sources_;
  std::vector<std::vector<Wire>> wires_;                   ///< by place
  std::vector<const records::ControllerRecord*> records_;  ///< by place; nullptr: no controller
};

/// Magnetometers and torque rods in no magnetic field, which read and do nothing.
void warn_of_no_field(const records::SystemSpec& spec, Diagnostics& diagnostics) {
  for (const auto& force : spec.force_elements)
    if (!force.dipole.isZero(0)) return;
  const auto warn = [&](const SourceLocation& at, const std::string& label, const std::string& effect) {
    diagnostics.warning(
        "system.no-magnetic-field", at,
        label + " is in no magnetic field, since no [[force]] of type gravity_central has a dipole: " + effect,
        "give dipole of the planet");
  };
  for (const auto& sensor : spec.sensors)
    if (sensor.type == records::SensorType::Magnetometer)
      warn(sensor.at, "sensor '" + sensor.name + "'", "it reads zero");
  for (const auto& actuator : spec.actuators)
    if (actuator.type == "torque_rod") warn(actuator.at, "actuator '" + actuator.name + "'", "it gives no moment");
}

}  // namespace

void build_signals(const records::SystemSpec& spec, const FlexMap& flex, const FunctionMap& functions,
                   const SignalUses& uses, System& system, Diagnostics& diagnostics) {
  Builder(spec, system, functions, diagnostics).build(uses, flex);
  warn_of_no_field(spec, diagnostics);
}

}  // namespace bough::solver
