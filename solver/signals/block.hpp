#pragma once
/// \file One block of the signal graph: sensors, controllers, actuators, functions. The calls are those of the C
/// interface for controllers of the user (solver/control/bough_controller.h); a Block has no state.
#include <memory>
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "base/rotation.hpp"
#include "solver/motion/motion.hpp"
#include "solver/state/law_tangents.hpp"

namespace bough::solver {

using Eigen::Vector3d;

/// Scratch memory of a block for one thread; holds no state.
struct BlockScratch {
  virtual ~BlockScratch() = default;
};

/// Inputs of a computation of a block. The pointers are valid during one call.
struct BlockInput {
  double t = 0;
  const double* u = nullptr;        ///< inputs
  const double* z = nullptr;        ///< continuous states
  const double* d = nullptr;        ///< memory: what changes at samples and switches only
  long sample = 0;                  ///< sampled blocks: number of this sample, counted from time zero
  const Motion* motion = nullptr;   ///< at t, for sensors and actuators
  BlockScratch* scratch = nullptr;  ///< of make_scratch
  LawTangents* tangents = nullptr;  ///< while a linear model is made
};

struct BlockSizes {
  int inputs = 0, outputs = 1, states = 0, memory = 0;
  int event_functions = 0;          ///< functions that switch the block where they become positive
  bool has_feedthrough = true;      ///< the outputs depend on the inputs (or on the motion) at the same moment
  bool reads_acceleration = false;  ///< sensors: of u̇
  double sample_time = 0;           ///< > 0: outputs are computed then and held
  double delay = 0;                 ///< sampled: between the sample and its appearance at the outputs
};

/// Kind of a block; the results file has a folder for the outputs of each kind.
enum class BlockKind : unsigned char { Function, Input, Sensor, Controller, Actuator, Force, Stiffening };

/// The folder of a kind, as "/sensors/".
const char* get_folder(BlockKind kind);

class Block {
 public:
  virtual ~Block() = default;
  /// Owner of the tangents of this block (LawTangents); valid as long as the block.
  LawOwner as_owner() const { return {this, "", label}; }
  /// Sets kind, name and path.
  void set_name(BlockKind block_kind, const std::string& block_name);

  BlockKind kind = BlockKind::Function;
  std::string name, path;         ///< as "pid", "/controllers/pid"
  std::string label;              ///< "controller 'pid'", for messages
  std::string description, dims;  ///< of the outputs, for the results
  std::string input_dims;         ///< what the first input is expected to have; empty: anything
  SourceLocation at;
  BlockSizes sizes;
  int tank = -1;  ///< thrusters: in Tree::tanks; the last state is the mass used of it

  /// For each thread, whose SystemData keeps it; nullptr: none.
  virtual std::shared_ptr<BlockScratch> make_scratch() const { return nullptr; }
  /// Initial states and memory; zero on entry.
  virtual void start(double* z, double* d) const;
  /// At the start of a run: lags that are to start at rest take the value of what they follow. False without any.
  virtual bool settle(const BlockInput& in, double* z) const;
  /// Computes the outputs y [sizes.outputs] from inputs, states and memory; sensors and actuators from the motion too.
  virtual void calc_outputs(const BlockInput& in, double* y) const = 0;
  /// Sampled: the outputs as if they were not, without noise; for linear models.
  virtual void calc_ideal(const BlockInput& in, double* y) const;
  /// Rates of the states z_dot [sizes.states]; without states nothing is written.
  virtual void calc_rates(const BlockInput& in, double* z_dot) const;
  /// Sampled: the memory after this sample; d holds what in.d holds. After calc_outputs of the same sample.
  virtual void update(const BlockInput& in, double* d) const;
  /// Event functions g [sizes.event_functions], which switch the block where they become positive.
  virtual void calc_event_functions(const BlockInput& in, double* g) const;
  /// The memory after event function `function` has become positive; the event function must not be positive any
  /// more.
  virtual void switch_over(const BlockInput& in, int function, double* d) const;
  /// The line of this switch among the events of the results; empty: none.
  virtual std::string describe_switch(const Motion& motion, int function) const;

  /// Sensors and actuators: marks the rows of q and u that outputs, rates and loads depend on, apart from what
  /// reads_acceleration stands for. All by default.
  virtual void mark_motion(const Tree& tree, std::vector<bool>& q, std::vector<bool>& u) const;

  /// Returns true if the outputs depend on t itself: a step longer than a short event of theirs would miss it.
  virtual bool depends_on_time() const { return false; }

  /// Returns true if the memory is not a set of numbers; its samples then have no linear model.
  virtual bool is_opaque() const { return false; }

  /// Number of inputs among which an event may choose; 0: none.
  virtual int num_choices() const { return 0; }
  /// The memory with input `choice` (from 0) passed on.
  virtual void choose(int choice, double* d) const;

  // Actuators
  /// Returns true if the block acts on bodies.
  virtual bool is_actuator() const { return false; }
  /// Adds what the actuator does to the bodies; y: its outputs.
  virtual void add_load(const BlockInput& in, const double* y, TreeData& data) const;
  /// Power that no wrench on a body has: along hinges, into rotors.
  virtual double calc_power(const BlockInput& in, const double* y) const;
  /// Kinetic energy and angular momentum (in W) that the actuator itself holds.
  virtual double calc_energy(const BlockInput& in) const;
  virtual Vector3d calc_momentum(const BlockInput& in) const;
  /// Propellant used up, by body.
  virtual void add_consumption(const BlockInput& in, Eigen::Ref<Eigen::VectorXd> by_body) const;
};

}  // namespace bough::solver
