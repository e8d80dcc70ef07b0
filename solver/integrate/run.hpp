#pragma once
/// \file One run: the state of its loop and what it writes to. For simulate.cpp.
#include <chrono>
#include <limits>
#include <map>

#include "solver/integrate/energy_monitor.hpp"
#include "solver/integrate/latches.hpp"
#include "solver/integrate/linear_limit.hpp"
#include "solver/integrate/run_setup.hpp"
#include "solver/integrate/simulate.hpp"
#include "solver/integrate/system_ode.hpp"

namespace bough::solver {

/// Six digits, for messages.
std::string short_text(double value);

class Run {
 public:
  Run(const System& system, const records::SystemSpec& spec, RunSetup setup, records::ResultSink& sink,
      const SimulateOptions& options, Diagnostics& diagnostics);
  SimulateOutcome go();
  /// The beginning of go(), through its first step.
  void start();

 private:
  bool is_stop_asked() const { return options_.stop && options_.stop->load(std::memory_order_relaxed); }

  // The loop (run.cpp)
  /// The first sample, or where a checkpoint left off. The time reached; `outcome_` when an event ends the run there.
  double begin();
  void fire_due(double t);
  /// Behind a step that something ended at t: whether the run ends there on request. Fails ("run.stalled") where such
  /// steps make no progress.
  bool settle_cut(double t);
  /// A checkpoint at a stop is of behind its jump; its events may not have come yet.
  void resume_at_stop(double t);
  /// Energy of motions too small for the tolerances.
  double calc_noise();
  /// Weight and applied forces times the size of the system, at the last sample.
  double calc_flow() const;
  /// Work to as much of the energies as the states, so that the balance tells of the motion, not of itself.
  void hold_work();
  /// Kinetic, of what the present accelerations do within an output step. Allocates, once in a tenth of that.
  double calc_coming_energy();
  void take_step(const Stop& stop);
  /// Warns once of each hinge whose axes nearly fall together.
  void watch_axes(double t);
  /// Takes y_ over the jumps of given rates at stop_, after calc_state at its time; logs them once.
  void cross_jump();
  /// The samples of the last step up to t; false when the run was asked to stop at one, and did.
  bool write_outputs(double t);
  /// The sample at t, of y_, which is the next one.
  void write_outputs_at(double t);
  /// Looks at y_ at t: sample, energies, limits.
  void observe(double t);
  /// The largest rate, in words.
  std::string name_fastest() const;
  const VectorXd& calc_sample(double t, const VectorXd& y);
  const VectorXd& calc_gaps(double t);
  void update_progress(double t);
  /// Warns where jets have used up much of their body.
  void tell_consumption();
  /// The regular end, with the judgement of the energy.
  SimulateOutcome close(double t, const std::string& reason);

  // Events (run_events.cpp)
  /// Signals that crossed their values in the last step up to `to`: each is located and logged, up to the first that
  /// does more, which is returned and has not come yet; those after it have not crossed.
  std::optional<Firing> watch_signals(const Stop& stop, double to);
  /// What comes at a stop itself: events at a time, and crossings by the jump.
  std::optional<Firing> pass(const Stop& stop);
  /// Carries out events that come at one time, at which y_ is, and those that they bring about; the one that ends the
  /// run, when there is one.
  std::optional<Firing> fire(std::vector<Firing> firings);
  /// What an event does to hinges and constraints.
  void change(const Firing& firing);
  /// The end that an event brings: a last sample at its time.
  SimulateOutcome finish(const Firing& firing);

  // Corners of forces (run_corners.cpp)
  void start_corners(double t);
  /// Where in the last step the first force has a corner, or its end.
  double find_corner(const Stop& stop);
  const VectorXd& calc_corners(double t);
  /// From here on at t, where y_ is.
  void leave_corners(double t);
  // Controllers (run_control.cpp)
  /// Samples that are due at t and switches that are open there, once; y_ is the state.
  void settle_control(double t);
  /// At the start: lags that are to start at rest.
  void settle_lags(double t);
  /// Switches every block with a positive guard at (t, y_) until there is none.
  void settle_switches(double t);
  /// Counts a switch of a block; warns once ("control.sliding") where it switches without rest.
  void count_switch(const std::string& label, double t);
  /// The first time in the last step up to `to` at which a block switches.
  std::optional<double> find_switch(const Stop& stop, double to);
  // Dry friction and rigid stops (run_latches.cpp)
  /// What rests, slides and strikes at (t, y_), from here on.
  void settle_latches(double t);
  /// The first time in the last step up to `to` at which that changes.
  std::optional<double> find_latch(const Stop& stop, double to);

  void get_control_memory(VectorXd& memory) const;
  void set_control_memory(const VectorXd& memory);

  // Checkpoints (run_checkpoint.cpp)
  void check_resume();
  bool is_memory_good(const records::Checkpoint& c) const;
  double restore(const records::Checkpoint& c);
  /// A checkpoint of y_ at t.
  void save(double t);
  void save_now_and_then();
  /// On request: y_ at t, behind the jumps there.
  SimulateOutcome halt(double t);

  // Failures (run_failure.cpp)
  /// Runs what evaluates the equations; on failure closes the sink first, so that the samples so far are kept.
  template <class Action>
  void guard(const Action& action) {
    try {
      action();
    } catch (...) {
      fail_as_thrown();
    }
  }
  /// In a handler: what was thrown, as the failure of this run.
  [[noreturn]] void fail_as_thrown();
  /// `tried`: the time of the evaluation that gave no finite number, in a step from t.
  [[noreturn]] void fail_non_finite(double t, double tried);
  [[noreturn]] void fail_diverged(double t, const std::string& what);
  /// Events that bring each other about without end.
  [[noreturn]] void fail_cycle(const Firing& firing);
  /// row: of the state that asks for the short steps; -1: not known.
  [[noreturn]] void fail_stalled(double t, const std::string& detail, int row = -1);
  [[noreturn]] void finish_failed(double t, const char* id, const std::string& what, const std::string& advice);

  const records::SystemSpec& spec_;
  records::ResultSink& sink_;
  const SimulateOptions& options_;
  Diagnostics& diagnostics_;
  RunSetup setup_;
  Timeline timeline_;
  SystemOde ode_;
  LinearLimit limit_;
  VectorXd reach_;
  EnergyMonitor monitor_;
  double coming_ = 0, coming_at_ = -std::numeric_limits<double>::infinity();
  std::unique_ptr<Stepper> stepper_;
  VectorXd y_, y_dot_;
  VectorXd corners_, last_corners_, corners_at_end_, largest_corners_;
  VectorXd gaps_, last_gaps_, trial_gaps_;  ///< of the signals of events, from their values
  records::Checkpoint checkpoint_, restored_;
  std::chrono::steady_clock::time_point saved_at_;
  Progress progress_;
  std::optional<SimulateOutcome> outcome_;
  double last_sample_ = -std::numeric_limits<double>::infinity();
  double passed_ = -std::numeric_limits<double>::infinity();   ///< the last stop whose events have come
  Stop stop_;                                                  ///< the next one, or the one just met
  double crossed_ = -std::numeric_limits<double>::infinity();  ///< the last stop whose jumps are logged
  std::vector<Firing> waiting_;                                ///< located at the next stop
  double changed_ = -std::numeric_limits<double>::infinity();  ///< the last time an event changed the system
  int num_quick_ = 0;                                          ///< changes in quick succession
  bool has_changed_ = false;                                   ///< the system, since the stepper was started
  bool is_started_ = false;                                    ///< the stepper is
  int num_tiny_ = 0;
  double cut_at_ = -std::numeric_limits<double>::infinity();  ///< where something last ended a step
  int num_cuts_ = 0;                                          ///< in quick succession
  VectorXd guards_, last_guards_;
  /// Of a block that switches: since when the last hundreds of switches are counted.
  struct Switching {
    double since = 0;
    int count = 0;
    bool is_told = false;
  };
  std::map<std::string, Switching> switching_;  ///< by label
  std::vector<int> gimbals_;                    ///< bodies on three angles or more, of which no warning was given
  Latches latches_;
  VectorXd latch_guards_, last_latch_guards_;
  double settled_ = -std::numeric_limits<double>::infinity();
  int num_settled_ = 0;
  double sampled_ = -std::numeric_limits<double>::infinity();  ///< the last instant whose samples are taken
  bool has_switched_ = false;  ///< what the motion depends on has changed since the stepper's last start
};

}  // namespace bough::solver
