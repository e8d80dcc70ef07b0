#pragma once
/// \file Signals as one vector, computed in topological order: functions, sensors of (q, u), controllers, actuators |
/// the accelerations | sensors of u̇ and what follows from them (docs/theory/control.md).
#include <algorithm>
#include <memory>
#include <vector>

#include "formats/records/system_spec.hpp"
#include "solver/signals/block.hpp"

namespace bough::solver {

using Eigen::VectorXd;

/// Where a block lies in the vectors of SignalData.
struct BlockSlot {
  std::unique_ptr<const Block> block;
  std::vector<int> sources;   ///< rows of values, one an input
  std::vector<double> gains;  ///< of the sources
  int in = 0, out = 0, state = 0, memory = 0, held = 0, queue = 0, event_row = 0;
  int queue_length = 0;             ///< samples on their way, where there is a delay
  int actuator = -1;                ///< counts commands of actuators; -1: none
  int activity = -1;                ///< row of the memory: 1 while it works, 0 while it is off; -1: it always works
  bool is_active = true;            ///< at the start
  bool drives_motion = false;       ///< the motion depends on it
  bool needs_acceleration = false;  ///< depends on u̇ at the same moment

  /// Returns true if the outputs are computed at samples and held.
  bool is_sampled() const { return block->sizes.sample_time > 0; }
};

/// Signals of one system in motion. Part of SystemData.
struct SignalData {
  VectorXd values;  ///< every output of every block
  VectorXd z;       ///< continuous states
  VectorXd memory;  ///< what blocks keep between samples, and what is held or on its way
  VectorXd inputs, scratch, fresh;
  std::vector<std::shared_ptr<BlockScratch>> block_scratch;  ///< of each block, in the order of places
  /// For linear models: addition to the command of each actuator; with is_open, the command is that and the one held.
  VectorXd bias, command;
  bool is_open = false;
  VectorXd shift;                      ///< likewise: more on each value, as all that read it see it; empty: none
  bool is_ideal = false;               ///< likewise: samples of sensors are those of calc_ideal
  bool is_after_acceleration = false;  ///< calc_after_acceleration is done at the present state
};

/// Instants first, first + period, ...
struct SampleTimes {
  double first = 0, period = 0;
};

/// An event function of a block that has become positive.
struct BlockSwitch {
  const Block* block = nullptr;
  int function = 0;
};

class SignalGraph {
 public:
  std::vector<BlockSlot> places;  ///< in the order of the file: sensors, controllers, actuators, functions
  std::vector<int> order;         ///< of evaluation
  int num_values = 0, num_states = 0, num_memory = 0, num_inputs = 0, num_event_functions = 0;
  int num_actuators = 0;  ///< their commands
  double start = 0;

  /// The order, what is needed and what is late, from sources and sizes. Reports "control.algebraic-loop".
  void arrange(Diagnostics& diagnostics);
  /// Vectors of the signals, the scratch of each block among them. Allocates.
  SignalData make_data() const;
  /// After calc_all, at the start of a run: lags that are to start at rest follow what is there. False without any.
  bool settle(const Motion& motion, SignalData& signals) const;
  /// Block by the path of its outputs; nullptr if it is absent.
  const BlockSlot* find(const std::string& path) const;
  /// Computes the blocks that the motion needs and that do not need accelerations. After kinematics, before loads.
  void calc_before_acceleration(const Motion& motion, SignalData& signals) const;
  /// Computes the needed blocks that depend on accelerations. After accelerations.
  void calc_after_acceleration(const Motion& motion, SignalData& signals) const;
  /// The blocks that calc_before_acceleration and calc_after_acceleration have left out. After accelerations.
  void calc_all(const Motion& motion, SignalData& signals) const;
  /// Computes those of the blocks `chosen` (by place) that need no accelerations, and what they depend on, which
  /// is chosen then too. After kinematics. No allocation.
  void calc_some(const Motion& motion, SignalData& signals, std::vector<bool>& chosen) const;
  /// After calc_all: outputs y of one sensor for linear models.
  void calc_ideal(const BlockSlot& place, const Motion& motion, SignalData& signals, double* y) const;
  /// Adds the loads of all actuators to the bodies. After their outputs.
  void add_loads(const Motion& motion, const SignalData& signals, TreeData& data) const;
  /// After calc_after_acceleration. z_dot: num_states.
  void calc_rates(const Motion& motion, SignalData& signals, Eigen::Ref<VectorXd> z_dot) const;
  /// Power of the actuators that no wrench on a body has.
  double calc_power(const Motion& motion, const SignalData& signals) const;
  /// Kinetic energy of the actuators themselves, as of rotors.
  double calc_energy(const Motion& motion, const SignalData& signals) const;
  /// Angular momentum of the actuators themselves, in W.
  Vector3d calc_momentum(const Motion& motion, const SignalData& signals) const;
  /// Propellant used up on each body.
  VectorXd calc_consumption(const Motion& motion, const SignalData& signals) const;

  /// Returns true if a block is sampled.
  bool has_samples() const {
    return std::any_of(places.begin(), places.end(), [](const BlockSlot& p) { return p.is_sampled(); });
  }
  /// Instants of all sampled blocks, each kind once.
  std::vector<SampleTimes> collect_samples() const;
  /// Takes the samples due within `close` of data's time, after calc_all there: each block reads the outputs of those
  /// before it in the order at this instant, and the accelerations before it. True if the motion has changed.
  bool sample(const Motion& motion, SignalData& signals, double close) const;
  /// After calc_all: one sample of every sampled block whatever the time, nothing delayed, sensors without noise.
  void sample_all(const Motion& motion, SignalData& signals) const;
  /// After calc_all. g: num_event_functions.
  void calc_event_functions(const Motion& motion, SignalData& signals, Eigen::Ref<VectorXd> g) const;
  /// Switches every block with a positive event function, and adds it to `switched`; false when there is none.
  bool switch_over(const Motion& motion, SignalData& signals, const VectorXd& g,
                   std::vector<BlockSwitch>& switched) const;
  /// "controller 'pid' (state 1)".
  std::string name_state(int row) const;

 private:
  /// A controller that an event has switched off.
  static bool is_off(const BlockSlot& place, const SignalData& signals) {
    return place.activity >= 0 && signals.memory[place.activity] == 0;
  }
  BlockInput look(const BlockSlot& place, const Motion& motion, SignalData& signals) const;
  BlockInput view_inputs(const BlockSlot& place, const Motion& motion, const SignalData& signals) const;
  void calc(const BlockSlot& place, const Motion& motion, SignalData& signals) const;
  void find_needed();
};

}  // namespace bough::solver
