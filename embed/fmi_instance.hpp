#pragma once
/// \file Instance of an FMU, common to FMI 2.0 and 3.0 (fmi2.cpp, fmi3.cpp): phases, variables, states, messages.
///
/// Source: FMI 2.0.4 sections 3.2 and 4.2, FMI 3.0.1 sections 2.3, 3.2 and 4.2.
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/non_copyable.hpp"
#include "embed/handles.hpp"

namespace bough::fmi {

/// Numbers as in both standards.
enum class Status { Ok = 0, Warning = 1, Discard = 2, Error = 3, Fatal = 4 };

/// Phase of an instance, on which the permitted calls depend. Bits, for lists of phases.
enum Phase : unsigned {
  kInstantiated = 1,
  kInitialization = 2,
  kEventMode = 4,
  kContinuousTime = 8,  ///< Model Exchange
  kStepMode = 16,       ///< Co-Simulation
  kTerminated = 32,
  kAnyPhase = 63
};
/// Name of a state as in the standard: "Step Mode".
const char* get_name(Phase phase);

struct InstanceOptions {
  std::string token, resources;  ///< guid or instantiation token; folder of the resources
  bool is_model_exchange = false;
  bool has_event_mode = false;  ///< Co-Simulation of FMI 3: between steps the importer enters event mode
  bool logs_all = false;
  std::function<void(Status, const char* category, const std::string& text)> log;
};

struct StepResult {
  bool is_terminated = false;  ///< an event has ended the run
  double time = 0;             ///< [T] reached
};

/// Result of get_state(): everything that an instance continues from.
struct SavedState {
  Phase phase = kInstantiated;
  std::vector<double> parameters, inputs;                                    ///< inputs: present values
  std::vector<double> built_parameters, built_inputs;                        ///< of the loaded model
  double tolerance = 0, start = 0, stop = 0, duration = 0, output_step = 0;  ///< 0, NaN, NaN: as in the system file
  std::vector<std::byte> bytes;                                              ///< of bough_save; empty: not started
};

class Instance : private NonCopyable {
 public:
  /// Checks the token and loads resources/system.toml. \throws InputError, "fmu.token" among them.
  explicit Instance(InstanceOptions options);
  ~Instance();

  /// Returns the options of the constructor, with the logging of the last set_logging().
  const InstanceOptions& options() const { return options_; }
  /// Returns the phase that the last set_phase() entered.
  Phase phase() const { return phase_; }
  /// Enters a phase; the callers check that the standard permits the transition.
  void set_phase(Phase phase) { phase_ = phase; }
  /// Selects if all categories of messages are logged.
  void set_logging(bool is_on) { options_.logs_all = is_on; }

  /// Logs a message. \return Status::Error.
  Status fail(const std::string& text);
  /// Logs a message: the importer may try again with another step or value. \return Status::Discard.
  Status discard(const std::string& text);

  /// \param tolerance  relative; 0: of the system file. \param stop  NaN: not defined.
  Status set_up(double tolerance, double start, double stop);
  /// Starts the simulation if it is not started yet.
  Status finish_initialization();
  /// Enters the phase Terminated; the last values remain readable.
  Status terminate();
  /// Returns to the phase Instantiated with the start values of the system file.
  Status reset();

  /// Reads variables by their value references, in Model Exchange at the time and states last set. \param values  one
  /// per reference. \return Status::Error for an unknown reference.
  Status get_values(std::span<const std::uint32_t> references, double* values);
  /// Sets inputs, and parameters before the end of the initialization. If one value is rejected, none is set.
  Status set_values(std::span<const std::uint32_t> references, const double* values);

  /// Phases in which get_directional_derivative() may be called.
  static constexpr unsigned kDifferentiable = kInitialization | kEventMode | kContinuousTime | kStepMode | kTerminated;
  /// Derivatives of outputs and state derivatives along a direction of inputs and states; in the initialization, of
  /// these and the initial states along a direction of inputs and parameters.
  ///
  /// Modes (stuck, locked, switched) and samples are held. In the initialization the system is built for each
  /// difference.
  /// \param seed  one per known. \param sensitivity  one per unknown.
  Status get_directional_derivative(std::span<const std::uint32_t> unknowns, std::span<const std::uint32_t> knowns,
                                    const double* seed, double* sensitivity);

  // Co-Simulation
  /// Advances a Co-Simulation from t, the present time, to t + h. `result.time` is earlier if an event ends the run.
  /// \return Status::Error for a step beyond the stop time.
  Status do_step(double t, double h, StepResult& result);
  /// Returns the time [T] reached; before the start of the simulation the start time.
  double time();
  /// Returns the message of the event that ended the run; empty: none did.
  const std::string& end_message() const { return end_message_; }

  // Model Exchange
  /// Number of continuous states.
  std::size_t num_states() const;
  /// Number of event functions, which FMI calls event indicators.
  std::size_t num_event_functions() const;
  /// Sets the time [T] of the next evaluations. \return Status::Discard for a time that is not finite.
  Status set_time(double t);
  /// Sets the n = num_states() states of the next evaluations. \return Status::Discard for a value that is not finite.
  Status set_states(const double* x, std::size_t n);
  /// Reads the states: in Model Exchange those last set, which events may have changed; in Co-Simulation those reached.
  Status get_states(double* x, std::size_t n);
  /// Computes the derivatives of the n = num_states() states; in Co-Simulation on a copy, so that the run is unchanged.
  Status get_derivatives(double* x_dot, std::size_t n);
  /// Computes the n = num_event_functions() event functions, in Co-Simulation on a copy.
  Status get_event_functions(double* g, std::size_t n);
  /// Ends a step of the importer. \param[out] enter_event_mode  true if constraints have drifted.
  Status complete_step(bool& enter_event_mode);
  /// Iterates the events at the present time; the states may jump. In Co-Simulation only `info` is reset.
  Status update_discrete(bough_event_info& info);

  // FMU states
  /// Copies everything that the instance continues from. \return null if the present state cannot be computed.
  std::unique_ptr<SavedState> get_state();
  /// Continues from a state of an instance of the same FMU. \return Status::Error for a state of another FMU.
  Status set_state(const SavedState& saved);
  /// Writes a state as bytes, with the token of the FMU before and a hash after them.
  std::vector<std::byte> serialize(const SavedState& saved) const;
  /// \throws InputError "fmu.state".
  std::unique_ptr<SavedState> deserialize(std::span<const std::byte> bytes) const;

 private:
  using Simulation = std::unique_ptr<bough_simulation, void (*)(bough_simulation*)>;
  void load();
  void start();
  void ensure_started();
  Simulation make(const records::SimulationRecord& times);
  /// Gives a simulation that has reached or would pass its end a longer duration.
  void extend(double t);
  /// Puts the simulation at (t, x) of the importer. Model Exchange.
  Status sync();
  bough_simulation* prepare_probe();
  /// f'(0) of the values of variables with inputs and parameters changed by h times the directions.
  Status differentiate_initialization(std::span<const std::uint32_t> unknowns, const std::vector<double>& inputs,
                                      const std::vector<double>& parameters, double* sensitivity);
  Status check(bough_status status, const bough_simulation* simulation);
  void log(Status status, const char* category, const std::string& text) const;

  InstanceOptions options_;
  Phase phase_ = kInstantiated;
  std::string token_;
  std::shared_ptr<const embed::Model> model_;
  std::vector<double> parameters_, inputs_;  ///< as set
  std::vector<double> default_parameters_, default_inputs_;
  std::vector<double> built_parameters_, built_inputs_;  ///< of model_
  double tolerance_ = 0, start_, stop_;
  Simulation simulation_, probe_;
  double t_ = 0;
  std::vector<double> x_;
  bool is_moved_ = true;  ///< simulation_ is not at (t_, x_) yet
  std::string end_message_;
};

/// Live instances and saved states: unknown pointers are reported, not dereferenced.
embed::Handles& get_instances();
embed::Handles& get_states();

/// "/a/b" of "file:///a/b" or "file:/a/b", percent signs decoded; other text unchanged.
std::string get_path_of_uri(const std::string& uri);

/// Runs `action(instance)`; an exception becomes a message and Status::Error.
///
/// \param allowed  phases in which the function may be called.
template <class Action>
Status call(void* handle, unsigned allowed, const char* function, const Action& action) noexcept {
  if (!handle || !get_instances().has(handle)) return Status::Error;
  auto& instance = *static_cast<Instance*>(handle);
  try {
    try {
      if ((instance.phase() & allowed) == 0)
        return instance.fail(std::string(function) + " is not allowed in the state " + get_name(instance.phase()) +
                             " of the instance: see the state machine of the standard");
      return action(instance);
    } catch (const Failure& error) {
      return instance.fail(error.what());
    } catch (const std::bad_alloc&) {
      return instance.fail("no memory left");
    } catch (const std::exception& error) {
      return instance.fail(std::string("internal error: ") + error.what());
    }
  } catch (...) {
    return Status::Error;
  }
}

}  // namespace bough::fmi
