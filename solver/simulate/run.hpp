#pragma once
/// \file One run: the state of its loop and what it writes to. For simulate.cpp.
#include <chrono>
#include <limits>
#include <map>

#include "solver/simulate/energy_monitor.hpp"
#include "solver/simulate/hybrid_system.hpp"
#include "solver/simulate/joint_contacts.hpp"
#include "solver/simulate/modal_range_monitor.hpp"
#include "solver/simulate/run_options.hpp"
#include "solver/simulate/simulate.hpp"

namespace bough::solver {

/// Six digits, for messages.
std::string short_text(double value);

class Run {
 public:
  /// Prepares a run; nothing is written before start(). References must outlive it.
  Run(const System& system, const records::SystemSpec& spec, RunSetup setup, records::ResultSink& sink,
      const SimulateOptions& options, Diagnostics& diagnostics);
  /// The beginning, through its first step.
  void start();

  /// The start: loops closed, controllers sampled, the first sample, events of its time.
  void begin();
  /// Continues to t, or to an earlier end; events at t have been handled then. The result does not depend on slices.
  void advance_to(double t);
  /// Reached; of an end, its own.
  double time() const { return time_; }
  /// Times closer together than this are one.
  double resolution() const { return time_events_.resolution(); }
  /// Number of rows of the state.
  int num_states() const { return ode_.size(); }
  /// Memory of the signals.
  const VectorXd& memory() const;
  /// Sets one row of the memory of the signals, without an evaluation.
  void put_memory(int row, double value);
  /// Outcome of a run that has ended; none before.
  const std::optional<SimulateOutcome>& outcome() const { return outcome_; }
  /// All channels at time().
  const VectorXd& calc_outputs() { return calc_sample(time_); }
  /// All channels, of which these rows are up to date: what they do not need is not computed.
  const VectorXd& calc_outputs(std::span<const int> rows) {
    return calc_rows(is_led_ ? calc_seen_time() : time_, rows);
  }
  /// Channels and the samples made of them.
  const Outputs& recorder() const { return setup_.recorder; }
  /// Sets what is held from time() on by the blocks of `memory`, one row of the signals' memory a value. Whatever a
  /// jump of them brings about comes at once.
  void set_held(const std::vector<std::pair<int, double>>& rows);

  // Interface for an integrator of the host (run_continuous.cpp)
  /// Present state x = [q; u; z; work; dissipated].
  const VectorXd& state() const { return y_; }
  /// Name of a row of the state, as in bough_name().
  std::string name_state(int row) const { return ode_.name_row(row); }
  /// From here on the state is the host's, until advance_to().
  void lead();
  /// Returns true if the host integrates.
  bool is_led() const { return is_led_; }
  /// Puts it at (t, x). No time event lies between the last one and t, which may be the next one's.
  void set_continuous(double t, const Eigen::Ref<const VectorXd>& x);
  /// Time derivatives of the state at the present (t, x).
  void calc_derivatives(Eigen::Ref<VectorXd> x_dot);
  /// All channels at the present (t, x).
  const VectorXd& calc_continuous_outputs();
  /// An event is where one of them changes its sign.
  int num_event_functions() const;
  /// Values at the present (t, x): kinks of force elements, switches of blocks, joint contacts and user events.
  void calc_event_functions(Eigen::Ref<VectorXd> g);
  /// Names of the event functions, in their order.
  std::vector<std::string> list_event_functions() const;
  /// Derivative of [ẋ; all channels] at (t, x) along dx and along changes of memory rows; modes and the
  /// rest of the memory are held (run_directional.cpp).
  VectorXd differentiate(const VectorXd& dx, const std::vector<std::pair<int, double>>& dmemory);
  /// Returns true if constraints have drifted apart, so that update_discrete() is called for.
  bool needs_projection();
  /// Event iteration at (t, x): handles time events, crossings and their consequences until nothing changes. Returns
  /// true if x has jumped.
  bool update_discrete();
  /// The next time event; the end is one.
  double next_event_time();

  /// All that the run goes on from, bit for bit where the step is fixed.
  records::Checkpoint save_state();
  /// Restores a state of save_state() by a run of the same system and plan, which has begun. Throws InputError
  /// "run.bad-checkpoint".
  void restore_state(const records::Checkpoint& saved);

 private:
  /// Difference steps of the rows of y_, as linear models take them.
  VectorXd calc_state_steps() const;
  /// After a switch of fill levels: outputs, limits and contacts of the present system.
  void set_variant();
  bool is_stop_asked() const { return options_.stop && options_.stop->load(std::memory_order_relaxed); }

  // The loop (run.cpp)
  void fire_due(double t);
  /// Starts the integrator or leads it on to the next stop.
  void enter_interval();
  /// Ends of a piece of the way to stop_.
  enum class Arrival { AtStop, Cut, Pause, End };
  /// Steps on to stop_, to where something cuts a step, or to t_pause.
  Arrival cross_interval(double t_pause);
  /// After the last step at stop_: jumps, samples, events, contacts.
  void arrive_at_stop();
  /// After a step ended by an event at t: ends the run on request. "run.stalled" if such steps make no progress.
  void settle_cut(double t);
  /// A checkpoint at a stop is after its jump; its events may not have been handled yet.
  void resume_at_stop(double t);
  /// Energy of motions too small for the tolerances.
  double calc_noise();
  /// Weight and applied forces times the size of the system, at the last sample.
  double calc_flow() const;
  /// Work to as much of the energies as the states, so that the balance tells of the motion, not of itself.
  void set_work_tolerance();
  /// Kinetic, of what the present accelerations do within an output step. Allocates, once in a tenth of that.
  double calc_coming_energy();
  void take_step(const TimeEvent& stop);
  /// Warns once of each hinge whose axes nearly fall together.
  void watch_axes(double t);
  void watch_elements(double t);
  /// Takes y_ over the jumps of given rates at stop_, after calc_state at its time; logs them once.
  void cross_jump();
  /// Starts the integrator afresh at (t, y_), towards stop_.
  void reset(double t);
  /// The sample at t within the last step, at which y_ is or is to be; false when the run was asked to stop there, and
  /// did.
  bool write_output(double t, bool is_at_state);
  /// The sample at t, of y_, which is the next one.
  void write_outputs_at(double t);
  /// Looks at y_ at t: sample, energies, limits.
  void observe(double t);
  /// The largest rate, in words.
  std::string name_fastest() const;
  /// Evaluates the equations of motion at (t, y_), and on request all signals, unless ode_ holds that state.
  void evaluate(double t, bool with_signals);
  /// Returns true if ode_ holds the evaluation at (t, y_).
  bool is_evaluated(double t) const;
  const VectorXd& calc_sample(double t);
  const VectorXd& calc_rows(double t, std::span<const int> rows);
  SampleState get_sample_state(double t) const;
  /// Kinematics at (t, y_), in place of a whole evaluation.
  void calc_motion(double t);
  bool has_motion(double t) const;
  void update_progress(double t);
  /// Warns where jets have used up much of their body.
  void tell_consumption();
  void warn_of_drained_slosh();
  /// The regular end, with the judgement of the energy.
  SimulateOutcome close(double t, const std::string& reason);

  // Event functions and their zero crossings (run_scan.cpp)
  /// Values of the event functions.
  struct EventValues {
    VectorXd kinks;     ///< of forces: their signs change
    VectorXd switches;  ///< of blocks: positive where a block switches
    VectorXd contacts;  ///< of joint contacts: positive where one changes its mode
    VectorXd signals;   ///< of events: signals minus their values
  };
  /// The first change within the last step.
  struct Change {
    double time = 0;         ///< up to which the step stands
    bool is_kink = false;    ///< a force has a kink there
    bool is_switch = false;  ///< a block or a joint contact changes its mode there
    std::optional<Occurrence> firing;
    bool is_pause = false;  ///< the host pauses there; nothing has changed
  };
  /// A signal that crossed its value, of an event that is logged, and its sign after.
  struct Crossing {
    Occurrence log;
    double sign;
  };
  /// The first change in the part of the last step up to its next sample. It is found at once: a pause of the host
  /// before it leaves the run as it is, so that slices locate what one run locates, to the last bit.
  struct Look {
    Change change;
    EventValues events;             ///< at change.time
    VectorXd largest_kinks, signs;  ///< after it
    std::vector<Crossing> logs;     ///< up to it, by time
  };
  void start_events();
  bool has_event_functions() const;
  // One kind each at (t, y_), into events_; kinks need no accelerations.
  void calc_kinks(double t);
  void calc_switches(double t);
  void calc_contacts(double t);
  void calc_signal_events(double t);
  /// All of them at t within the last step, by one evaluation.
  void calc_events(double t, const TimeEvent& stop);
  /// Kinks are looked for from (t, y_) on.
  void restart_kinks(double t);
  /// Where event function i of a kind crosses zero between the last look and `to`, whose values are in events_.
  double locate(VectorXd EventValues::*rows, Eigen::Index i, double before, double to, double tolerance,
                const TimeEvent& stop);
  /// The first crossing of one kind up to `to`, which becomes its time; events_ is of `to`. get_before(i): the value at
  /// the last look where function i has crossed, else none.
  template <class Before>
  bool find_first(VectorXd EventValues::*rows, const Before& get_before, const TimeEvent& stop, double& to);
  /// Finds the first change between the last look and `to`, into look_.
  void look_ahead(const TimeEvent& stop, double to);
  /// Logs the crossings found by the last event search, up to `until`.
  void accept_look(double until);
  /// Values of the event functions at (t, y_), from which the next look starts.
  void refresh_events(double t);
  /// Looks at the last step, at each sample and at its end, and writes the samples, up to the first change or to
  /// t_pause. None when the run was asked to stop at a sample, and did.
  std::optional<Change> scan_step(const TimeEvent& stop, double t_pause);

  // Events (run_events.cpp)
  /// Signals that crossed their values between the last look and `to`: each is located and kept in look_.logs, up to
  /// the first that does more, which is returned and has not come yet; those after it have not crossed.
  std::optional<Occurrence> find_occurrence(const TimeEvent& stop, double to);
  /// Events whose signals have crossed their values by a jump at t, where y_ is.
  std::vector<size_t> find_crossed(double t);
  void start_signal_events(double t);
  /// Events at a stop: events at a time, and crossings by the jump.
  std::optional<Occurrence> pass(const TimeEvent& stop);
  /// Carries out events that come at one time, at which y_ is, and those that they bring about; the one that ends the
  /// run, when there is one.
  std::optional<Occurrence> fire(std::vector<Occurrence> firings);
  /// Applies an event to hinges and constraints.
  void change(const Occurrence& firing);
  void write_event(const Occurrence& firing);
  /// Source of a line of /events.
  std::string get_source(const Occurrence& firing) const;
  /// The end that an event brings: a last sample at its time.
  SimulateOutcome finish(const Occurrence& firing);

  // Controllers (run_control.cpp)
  /// Samples that are due at t and switches that are open there, once; y_ is the state.
  void take_samples(double t);
  /// Initializes at the start the lags with `initial = "steady"`.
  void initialize_lags(double t);
  /// Switches every block with a positive event function at (t, y_) until there is none.
  void iterate_switches(double t);
  /// Counts a switch of a block; warns once ("control.sliding") where it switches without rest.
  void count_switch(const std::string& label, double t);
  /// Handles the event of an empty tank: limits the consumption of its thruster to the available propellant.
  void end_at_reserve(const Block& block);
  // Dry friction and rigid stops (run_joint_contacts.cpp)
  /// Updates the contacts that stick, slide and strike at (t, y_).
  void iterate_contacts(double t);

  void get_control_memory(VectorXd& memory) const;
  void set_control_memory(const VectorXd& memory);

  // Checkpoints (run_checkpoint.cpp)
  void check_resume();
  bool is_memory_good(const records::Checkpoint& c) const;
  double restore(const records::Checkpoint& c);
  void fill_checkpoint(double t);
  static constexpr TimeEvent kNoEvent{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                                      false};
  double calc_seen_time() const;
  /// The host may have put any state: the energy balance is judged from here on.
  void restart_balance();
  /// Continues with the integrator of the run from the state of the host's integrator.
  void take_over();
  /// Switches, crossings and contacts at time_ after a jump. Returns false if an event has ended the run.
  bool settle_jump();
  std::string describe_end(const Occurrence& firing) const;
  void find_next_stop();
  int num_kinks() const;
  template <class Action>
  void for_each_kept(const Action& action);
  /// A checkpoint of y_ at t.
  void save(double t);
  void save_now_and_then();
  /// Ends the run on request: y_ at t, after the jumps there.
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
  [[noreturn]] void fail_cycle(const Occurrence& firing);
  /// row: of the state that asks for the short steps; -1: not known.
  [[noreturn]] void fail_stalled(double t, const std::string& detail, int row = -1);
  [[noreturn]] void finish_failed(double t, const char* id, const std::string& what, const std::string& advice);

  const records::SystemSpec& spec_;
  records::ResultSink& sink_;
  const SimulateOptions& options_;
  Diagnostics& diagnostics_;
  RunSetup setup_;
  TimeEvents time_events_;
  HybridSystem ode_;
  std::unique_ptr<SystemData> expected_data_;  ///< of calc_coming_energy()
  VectorXd coming_y_dot_;
  ModalRangeMonitor limit_;
  VectorXd modal_limit_;
  EnergyMonitor monitor_;
  double expected_energy_ = 0, expected_at_ = -std::numeric_limits<double>::infinity();
  std::unique_ptr<Integrator> integrator_;
  VectorXd y_, y_dot_;
  /// The last evaluation by evaluate().
  struct Evaluated {
    long number = -1;         ///< HybridSystem::num_evaluations
    long motion_number = -1;  ///< the same, of one that ended with the kinematics
    double t = 0;
    VectorXd y, memory, slide;
    bool has_signals = false, has_sample = false;
  };
  Evaluated evaluated_;
  std::vector<bool> chosen_;          ///< of calc_rows(), by block
  EventValues events_, last_events_;  ///< at the present and at the last look
  Look look_;
  bool has_look_ = false;                    ///< look_ is of the part of the step after scanned_
  VectorXd signs_;                           ///< of find_occurrence()
  VectorXd latches_before_, latches_after_;  ///< of iterate_contacts()
  double scanned_ = 0;                       ///< time of the last look
  bool has_located_ = false;                 ///< since the last look, so that y_ is elsewhere
  VectorXd largest_kinks_;
  records::Checkpoint checkpoint_, restored_;
  std::chrono::steady_clock::time_point saved_at_;
  Progress progress_;
  std::optional<SimulateOutcome> outcome_;
  double last_sample_ = -std::numeric_limits<double>::infinity();
  double passed_ = -std::numeric_limits<double>::infinity();  ///< the last stop whose events have come
  TimeEvent stop_;                                            ///< the next one, or the one just met
  double time_ = 0;                                           ///< where y_ is between pieces
  /// For an integrator of the host: the next stop; -inf: not known, as after advance_to().
  TimeEvent next_event_ = kNoEvent;
  bool is_at_event_ = true;    ///< the event at time_ has come
  bool is_led_ = false;        ///< an integrator of the host has moved the state since the last advance_to()
  int ended_by_ = -1;          ///< the event that has ended the run
  bool needs_restart_ = true;  ///< of the stepper, at the next interval
  bool is_inside_ = false;     ///< paused on the way to stop_
  bool has_stepped_ = false;   ///< on the way to stop_
  double crossed_ = -std::numeric_limits<double>::infinity();  ///< the last stop whose jumps are logged
  std::vector<Occurrence> waiting_;                            ///< located at the next stop
  double changed_ = -std::numeric_limits<double>::infinity();  ///< the last time an event changed the system
  int num_quick_ = 0;                                          ///< changes in quick succession
  bool has_changed_ = false;                                   ///< the system, since the stepper was started
  bool is_started_ = false;                                    ///< the stepper is
  int num_tiny_ = 0;
  double last_event_time_ = -std::numeric_limits<double>::infinity();  ///< end of the last step ended by an event
  int num_short_steps_ = 0;                                            ///< in quick succession
  /// Count of the switches of one block since a time.
  struct Switching {
    double since = 0;
    int count = 0;
    bool is_told = false;
  };
  std::map<std::string, Switching> switching_;  ///< by label
  std::vector<std::size_t> inside_;             ///< force elements of which no warning was given
  std::vector<int> gimbals_;                    ///< bodies on three angles or more, of which no warning was given
  JointContacts joint_contacts_;
  double settled_ = -std::numeric_limits<double>::infinity();
  int num_settled_ = 0;
  double sampled_ = -std::numeric_limits<double>::infinity();  ///< the last instant whose samples are taken
  bool has_switched_ = false;  ///< what the motion depends on has changed since the stepper's last start
};

}  // namespace bough::solver
