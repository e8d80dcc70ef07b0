#pragma once
/// \file A run that is advanced from outside: inputs set, outputs read, its state saved and restored between pieces.
#include <memory>
#include <span>

#include "solver/simulate/simulate.hpp"

namespace bough::solver {

class Run;
class InputBlock;

/// Belongs to one thread; the System may be shared by many. simulate() is a Simulator that is advanced to its end at
/// once: the numbers are the same, bit for bit where the step is fixed, in any slices that end on steps.
class Simulator {
 public:
  /// Begins the run: loops closed, controllers sampled, the first sample written. Throws what simulate() throws. All
  /// arguments must outlive it.
  Simulator(const System& system, const records::SystemSpec& spec, records::ResultSink& sink,
            const SimulateOptions& options, Diagnostics& diagnostics);
  ~Simulator();

  /// Goes on to t, or to the end or the event that ends the run where that comes first. What is due at t has come then.
  void advance_to(double t);
  /// Time [T] reached.
  double time() const;
  /// Times closer together than that are one.
  double resolution() const;
  /// Numbers by which save() may grow where a pause is within a step.
  std::size_t max_step_size() const;
  /// Outcome of a run that has ended; none before.
  const std::optional<SimulateOutcome>& outcome() const;

  /// Number of [[input]] tables, each a scalar.
  int num_inputs() const { return static_cast<int>(inputs_.size()); }
  /// The [[input]] block of input i.
  const InputBlock& input(int i) const { return *inputs_[static_cast<std::size_t>(i)].block; }
  /// Value of input i at time(), from which on it is held; a linear one gets there at the time advanced to next.
  void set_inputs(int first, std::span<const double> values);
  /// At time().
  double get_input(int i) const;

  /// Channels of the results, time first.
  const std::vector<records::Channel>& channels() const;
  /// The components of all channels at time(), one after another. No allocation.
  const Eigen::VectorXd& calc_outputs();
  /// Components of all channels, of which `rows` are up to date: those that need no accelerations cost no evaluation of
  /// the equations of motion. No allocation.
  const Eigen::VectorXd& calc_outputs(std::span<const int> rows);

  // Interface for an integrator of the host, in place of advance_to()
  /// Number of rows of the state.
  int num_states() const;
  /// Present state x = [q; u; z; work; dissipated], at time().
  const Eigen::VectorXd& state() const;
  /// Name of a row of the state.
  std::string name_state(int row) const;
  /// Puts it at (t, x), t not past next_event_time().
  void set_continuous(double t, const Eigen::Ref<const Eigen::VectorXd>& x);
  /// Time derivatives of the state at the present (t, x).
  void calc_derivatives(Eigen::Ref<Eigen::VectorXd> x_dot);
  /// An event is where an event function changes its sign.
  int num_event_functions() const;
  /// Values of the event functions at the present (t, x).
  void calc_event_functions(Eigen::Ref<Eigen::VectorXd> g);
  /// Names of the event functions, in their order.
  std::vector<std::string> list_event_functions() const;
  /// Derivative of [ẋ; components of all channels] along a direction of states and inputs, at (t, x) of
  /// set_continuous(). Modes and samples are held, as in linear models; at a kink the mean of both slopes.
  /// \param dx  num_states(). \param du  num_inputs(). \pre an integrator of the host leads.
  /// \throws ComputationError where the system has no derivative.
  Eigen::VectorXd differentiate(const Eigen::VectorXd& dx, std::span<const double> du);
  /// Returns true if constraints have drifted apart, so that update_discrete() is called for.
  bool needs_projection();
  /// Event mode at (t, x): what is due, what has crossed, and what follows, until nothing changes. Whether x has
  /// jumped. The run may have ended then.
  bool update_discrete();
  /// Time [T] of the next time event, which no step of the host may pass.
  double next_event_time();

  /// Everything that it goes on from, also in another process: bit for bit where the step is fixed.
  records::Checkpoint save() const;
  /// Throws InputError "run.bad-checkpoint" where the state is not of this system and plan.
  void restore(const records::Checkpoint& saved);

 private:
  struct Input {
    const InputBlock* block = nullptr;
    int memory = 0;  ///< first row of its memory
  };
  void hold_inputs(double t);
  void apply_inputs();
  /// Inputs at once, as an integrator of the host varies them.
  void put_inputs();

  std::unique_ptr<Run> run_;
  std::vector<Input> inputs_;
  std::vector<double> next_;  ///< of inputs, as set
  std::vector<std::pair<int, double>> rows_;
  bool is_set_ = false;      ///< since the last advance
  bool has_slopes_ = false;  ///< an input moves along a line in the last advance
};

}  // namespace bough::solver
