// Controllers that switch: relay with hysteresis, pulse modulator, selection. The run locates their switches as it
// locates events; between switches they are smooth.
#include <cmath>

#include "solver/control/makers.hpp"

namespace bough::solver {
namespace {

/// Memory, one for each component: -1, 0 or 1. Two event functions for each: it leaves its state upwards or downwards.
class SwitchingBlock : public Block {
 public:
  double on = 0, off = 0;
  bool has_rest = false;  ///< three states: value, 0, -value

  void calc_event_functions(const BlockInput& in, double* g) const override {
    for (int i = 0; i < sizes.outputs; ++i) {
      const double u = get_drive(in, i), state = in.d[i];
      if (has_rest) {
        g[2 * i] = state < 0 ? u + off : state > 0 ? -1 : u - on;
        g[2 * i + 1] = state > 0 ? off - u : state < 0 ? -1 : -u - on;
      } else {
        g[2 * i] = state > 0 ? -1 : u - on;
        g[2 * i + 1] = state > 0 ? off - u : -1;
      }
    }
  }
  void switch_over(const BlockInput& in, int function, double* d) const override {
    const int i = function / 2;
    const double step = function % 2 == 0 ? 1 : -1;
    if (has_rest)
      d[i] = in.d[i] + step;
    else
      d[i] = step > 0 ? 1 : 0;
  }

 protected:
  virtual double get_drive(const BlockInput& in, int i) const { return in.u[i]; }
};

class Relay final : public SwitchingBlock {
 public:
  double high = 1, low = 0;
  void calc_outputs(const BlockInput& in, double* y) const override {
    for (int i = 0; i < sizes.outputs; ++i) y[i] = in.d[i] > 0 ? high : has_rest && in.d[i] == 0 ? 0 : low;
  }
};

/// Pulse width and pulse frequency: τ ẋ = K (u - y) - x drives a switch with three states.
class Pwpf final : public SwitchingBlock {
 public:
  double gain = 1, lag = 1, value = 1;
  void calc_outputs(const BlockInput& in, double* y) const override {
    for (int i = 0; i < sizes.outputs; ++i) y[i] = value * in.d[i];
  }
  void calc_rates(const BlockInput& in, double* z_dot) const override {
    for (int i = 0; i < sizes.outputs; ++i) z_dot[i] = (gain * (in.u[i] - value * in.d[i]) - in.z[i]) / lag;
  }

 protected:
  double get_drive(const BlockInput& in, int i) const override { return in.z[i]; }
};

/// The first input below the threshold of the last one, the second above; of two inputs the one that events choose.
class Switch final : public Block {
 public:
  double threshold = 0, hysteresis = 0;
  void calc_outputs(const BlockInput& in, double* y) const override {
    const int first = in.d[0] > 0 ? sizes.outputs : 0;
    for (int i = 0; i < sizes.outputs; ++i) y[i] = in.u[first + i];
  }
  int num_choices() const override { return sizes.event_functions == 0 ? 2 : 0; }
  void choose(int choice, double* d) const override { d[0] = choice; }
  void calc_event_functions(const BlockInput& in, double* g) const override {
    const double selector = in.u[sizes.inputs - 1];
    g[0] = in.d[0] > 0 ? -1 : selector - threshold - hysteresis;
    g[1] = in.d[0] > 0 ? threshold - hysteresis - selector : -1;
  }
  void switch_over(const BlockInput&, int function, double* d) const override { d[0] = function == 0 ? 1 : 0; }
};

void read_levels(SettingsReader& keys, SwitchingBlock& t, int n) {
  t.on = keys.get("on");
  t.off = keys.get("off");
  keys.demand(t.off < t.on, "has an off that is not below on", "give off < on: between them it stays as it is");
  t.sizes.outputs = t.sizes.memory = n;
  t.sizes.event_functions = 2 * n;
}

}  // namespace

std::unique_ptr<Block> make_relay(SettingsReader& keys, const ControllerWiring& wiring) {
  auto made = std::make_unique<Relay>();
  made->high = keys.get("value", 1);
  made->has_rest = !keys.has("low");
  made->low = keys.get("low", -made->high);
  read_levels(keys, *made, wiring.size());
  made->sizes.has_feedthrough = false;  // by its memory only
  return made;
}

std::unique_ptr<Block> make_pwpf(SettingsReader& keys, const ControllerWiring& wiring) {
  auto made = std::make_unique<Pwpf>();
  made->value = keys.get_positive("value");
  made->gain = keys.get_positive("gain");
  made->lag = keys.get_positive("lag");
  made->has_rest = true;
  read_levels(keys, *made, wiring.size());
  keys.demand(made->off >= 0, "has a negative off", "give 0 <= off < on");
  made->sizes.states = wiring.size();
  made->sizes.has_feedthrough = false;
  return made;
}

std::unique_ptr<Block> make_switch(SettingsReader& keys, const ControllerWiring& wiring) {
  auto made = std::make_unique<Switch>();
  const auto& in = wiring.inputs;
  made->sizes.memory = 1;
  if (in.size() == 2 && in[0] == in[1]) {
    made->sizes.outputs = in[0];
    return made;
  }
  made->threshold = keys.get("threshold", 0);
  made->hysteresis = keys.get_size("hysteresis", 0);
  if (in.size() != 3 || in[0] != in[1] || in[2] != 1)
    keys.error("control.bad-size", "does not have two alike inputs and a scalar that selects",
               "give inputs = [\"below\", \"above\", \"selector\"], or two that events choose among");
  else
    made->sizes.outputs = in[0];
  made->sizes.event_functions = 2;
  return made;
}

}  // namespace bough::solver
