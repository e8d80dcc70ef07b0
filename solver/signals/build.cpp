#include "solver/signals/build.hpp"

#include <algorithm>

#include "formats/records/signal_name.hpp"
#include "solver/actuators/actuator.hpp"
#include "solver/control/controller.hpp"
#include "solver/sensors/sensor_block.hpp"

namespace bough::solver {
namespace {

class FunctionBlock final : public Block {
 public:
  explicit FunctionBlock(const TimeFunction* f) : f_(f) { sizes.has_feedthrough = false; }
  void calc_outputs(const BlockInput& in, double* y) const override { y[0] = f_->calc(in.t).f; }

 private:
  const TimeFunction* f_;
};

/// Whatever may be named as an input.
struct Source {
  std::string name, path;
  int size = 0;  ///< 0: not known yet
  int place = -1;
};

/// One component of a source, or all of it.
struct Wire {
  size_t source = 0;
  int component = -1;  ///< -1: all
  std::string text;    ///< the component as written
};

class Builder {
 public:
  Builder(const records::SystemSpec& spec, const System& system, const FunctionMap& functions, System::Impl& impl,
          Diagnostics& diagnostics)
      : spec_(spec), system_(system), functions_(functions), impl_(impl), diagnostics_(diagnostics) {}

  void build() {
    const int errors = diagnostics_.num_errors();
    impl_.signals.start = impl_.start;
    add_sensors();
    declare();
    wire_controllers();
    add_actuators();
    impl_.signals_are_sound = diagnostics_.num_errors() == errors;
    if (impl_.signals_are_sound) {
      lay_out();
      if (diagnostics_.num_errors() == errors) impl_.signals.arrange(diagnostics_);
    }
    impl_.signals_are_sound = diagnostics_.num_errors() == errors;
    if (!impl_.signals_are_sound) impl_.signals = SignalGraph();
  }

 private:
  void add_sensors() {
    const Sensors sensors = Sensors::build(system_, spec_, diagnostics_);
    for (size_t i = 0; i < sensors.entries().size(); ++i) {
      const auto& entry = sensors.entries()[i];
      sources_.push_back({entry.name, "/sensors/" + entry.name, entry.size,
                          add(make_sensor_block(entry, spec_.sensors[i], diagnostics_))});
      wires_.emplace_back();
    }
  }

  void declare() {
    for (const auto& r : spec_.controllers) sources_.push_back({r.name, "/controllers/" + r.name, find_outputs(r), -1});
    for (const auto& r : spec_.actuators)
      sources_.push_back({r.name, "/actuators/" + r.name, find_actuator_outputs(r.type), -1});
    for (const auto& r : spec_.functions) sources_.push_back({r.name, "/signals/" + r.name, 1, -1});
  }

  int add(std::unique_ptr<const Block> block) {
    BlockPlace place;
    place.block = std::move(block);
    impl_.signals.places.push_back(std::move(place));
    return static_cast<int>(impl_.signals.places.size()) - 1;
  }

  /// Of "name", "name:component", "/path:component". Reports what is wrong and returns false.
  bool find(const std::string& text, const std::string& user, const SourceLocation& at, Wire& wire) {
    const auto colon = text.rfind(':');
    std::string name = text, component;
    const auto matches = [&](const Source& s) { return s.name == name || s.path == name; };
    if (std::none_of(sources_.begin(), sources_.end(), matches) && colon != std::string::npos) {
      name = text.substr(0, colon);
      component = text.substr(colon + 1);
    }
    const auto first = std::find_if(sources_.begin(), sources_.end(), matches);
    if (first == sources_.end()) {
      std::vector<std::string> known;
      for (const auto& s : sources_) known.push_back(s.name);
      const std::string near = find_nearest(name, known);
      diagnostics_.error("control.unknown-signal", at, user + " names the signal '" + text + "', which does not exist",
                         near.empty() ? "name a sensor, controller, actuator or function, as pid or tip:x"
                                      : "did you mean '" + near + "'?");
      return false;
    }
    if (const auto second = std::find_if(first + 1, sources_.end(), matches); second != sources_.end()) {
      diagnostics_.error("control.unknown-signal", at,
                         user + " names the signal '" + text + "', which may be " + first->path + " or " + second->path,
                         "write the one you mean");
      return false;
    }
    wire.source = static_cast<size_t>(first - sources_.begin());
    wire.text = component;
    wire.component = component.empty() ? -1 : 0;
    return true;
  }

  int size_of(const Wire& wire) const { return wire.component >= 0 ? 1 : sources_[wire.source].size; }

  void wire_controllers() {
    struct Pending {
      const records::ControllerRecord* record;
      std::vector<Wire> wires;  // inputs, then reference and rate
      bool is_good = true;
    };
    std::vector<Pending> pending;
    for (const auto& r : spec_.controllers) {
      Pending p{&r, {}, true};
      std::vector<std::string> texts = r.inputs;
      if (!r.reference.empty()) texts.push_back(r.reference);
      if (!r.rate.empty()) texts.push_back(r.rate);
      for (const auto& text : texts) {
        Wire wire;
        p.is_good = find(text, "controller '" + r.name + "'", r.at, wire) && p.is_good;
        p.wires.push_back(wire);
      }
      if (p.is_good) pending.push_back(std::move(p));
    }
    // Sizes follow the arrows.
    for (bool is_new = true; is_new;) {
      is_new = false;
      for (size_t i = 0; i < pending.size();) {
        const auto is_known = [&](const Wire& w) { return size_of(w) > 0; };
        if (!std::all_of(pending[i].wires.begin(), pending[i].wires.end(), is_known)) {
          ++i;
          continue;
        }
        place_controller(*pending[i].record, pending[i].wires);
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

  void place_controller(const records::ControllerRecord& r, const std::vector<Wire>& wires) {
    ControllerWiring wiring;
    for (size_t i = 0; i < r.inputs.size(); ++i) wiring.inputs.push_back(size_of(wires[i]));
    if (!r.reference.empty()) wiring.reference = size_of(wires[r.inputs.size()]);
    if (!r.rate.empty()) wiring.rate = size_of(wires.back());
    auto block = make_controller(r, wiring, diagnostics_);
    if (!block) return;
    const auto source = std::find_if(sources_.begin(), sources_.end(),
                                     [&](const Source& s) { return s.path == "/controllers/" + r.name; });
    source->size = block->sizes.outputs;
    source->place = add(std::move(block));
    wires_.push_back(wires);
  }

  void add_actuators() {
    for (const auto& r : spec_.actuators) {
      Wire wire;
      bool is_good = true;
      if (!r.input.empty()) is_good = find(r.input, "actuator '" + r.name + "'", r.at, wire);
      if (is_good && !r.input.empty() && size_of(wire) > 1) {
        diagnostics_.error(
            "control.bad-size", r.at,
            "actuator '" + r.name + "' takes one number, '" + r.input + "' has " + std::to_string(size_of(wire)),
            "name a component, as " + r.input + ":1");
        is_good = false;
      }
      auto block = make_actuator(r, system_, impl_.tree, diagnostics_);
      if (!block || !is_good) continue;
      const auto source = std::find_if(sources_.begin(), sources_.end(),
                                       [&](const Source& s) { return s.path == "/actuators/" + r.name; });
      source->place = add(std::move(block));
      wires_.push_back(r.input.empty() ? std::vector<Wire>() : std::vector<Wire>{wire});
      impl_.signals.places.back().actuator = impl_.signals.num_actuators++;
    }
  }

  /// The function's block, made when it is first named.
  int get_place(Source& source) {
    if (source.place >= 0) return source.place;
    const TimeFunction* f = functions_.at(source.name);
    if (f == nullptr) return -1;
    auto block = std::make_unique<FunctionBlock>(f);
    block->name = source.name;
    block->path = source.path;
    block->label = "function '" + source.name + "'";
    block->description = "function of time";
    block->dims = "by the function";
    const auto add_times = [](std::vector<double>& to, const std::vector<double>& times) {
      to.insert(to.end(), times.begin(), times.end());
    };
    add_times(impl_.breakpoints, f->corners());
    add_times(impl_.landmarks, f->landmarks());
    wires_.emplace_back();
    return source.place = add(std::move(block));
  }

  void lay_out() {
    SignalGraph& g = impl_.signals;
    for (size_t i = 0; i < wires_.size(); ++i) {  // grows by functions, which have no wires
      for (size_t k = 0; k < wires_[i].size(); ++k) {
        if (get_place(sources_[wires_[i][k].source]) < 0) return;
      }
    }
    for (BlockPlace& p : g.places) {
      const BlockSizes& s = p.block->sizes;
      p.in = g.num_inputs;
      p.out = g.num_values;
      p.state = g.num_states;
      p.memory = g.num_memory;
      p.guard = g.num_guards;
      g.num_inputs += s.inputs;
      g.num_values += s.outputs;
      g.num_states += s.states;
      g.num_memory += s.memory;
      g.num_guards += s.guards;
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
  }

  void connect(BlockPlace& to, const Wire& wire) {
    const Source& source = sources_[wire.source];
    const BlockPlace& from = impl_.signals.places[static_cast<size_t>(source.place)];
    if (wire.component < 0) {
      for (int i = 0; i < from.block->sizes.outputs; ++i) to.sources.push_back(from.out + i);
      return;
    }
    const int n = from.block->sizes.outputs;
    const int component = records::find_component({source.path, wire.text}, n);
    if (component >= 0) {
      to.sources.push_back(from.out + component);
      return;
    }
    std::string list;
    for (const auto& name : records::get_component_names(source.path, n)) list += (list.empty() ? "" : ", ") + name;
    diagnostics_.error(
        "control.unknown-signal", to.block->at,
        to.block->label + " names component '" + wire.text + "' of '" + source.name + "', which does not exist",
        list.empty() ? "it is a scalar: leave the component out" : "its components are " + list);
  }

  const records::SystemSpec& spec_;
  const System& system_;
  const FunctionMap& functions_;
  System::Impl& impl_;
  Diagnostics& diagnostics_;
  std::vector<Source> sources_;
  std::vector<std::vector<Wire>> wires_;  ///< by place
};

}  // namespace

void build_signals(const records::SystemSpec& spec, const System& system, const FunctionMap& functions,
                   System::Impl& impl, Diagnostics& diagnostics) {
  Builder(spec, system, functions, impl, diagnostics).build();
}

}  // namespace bough::solver
