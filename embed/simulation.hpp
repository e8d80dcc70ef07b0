#pragma once
/// \file A simulation that a host steps: options of the host, ends, the state as bytes; below bough.h and the Python
/// module.
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "embed/load.hpp"
#include "solver/simulate/no_sink.hpp"
#include "solver/simulate/simulator.hpp"

namespace bough::embed {

/// Nine digits, whatever the locale.
std::string to_text(double value);

/// Zero or empty: those of the system file.
struct SimulationOptions {
  std::string integrator;
  double step = 0, relative_tolerance = 0, absolute_tolerance = 0;
  double duration = 0;  ///< [T] longest time from the start on
};

/// The message for an option that is negative or not finite; empty: all are valid.
std::string describe_fault(const SimulationOptions& options);

/// The records with the options of a host.
records::SystemSpec change_spec(records::SystemSpec spec, const SimulationOptions& options);

class Simulation {
 public:
  /// \param spec  that of the system, with another [simulation] if needed.
  /// Throws what solver::Simulator throws. \param loaded and what `run` points to must outlive it.
  Simulation(const LoadedSystem& loaded, records::SystemSpec spec, solver::SimulateOptions run = {});

  /// Returns the simulator, at time() between calls.
  solver::Simulator& simulator() { return *simulator_; }
  const solver::Simulator& simulator() const { return *simulator_; }
  /// Returns warnings and notes since the construction.
  const Diagnostics& diagnostics() const { return diagnostics_; }
  /// Returns the specification with the options of the host.
  const records::SystemSpec& spec() const { return spec_; }
  /// Hash of the data that must be equal when a state is restored.
  std::uint64_t fingerprint() const { return fingerprint_; }

  /// Returns true if the run goes on at t; false if an event or its duration has ended it, at time() <= t.
  /// Throws ComputationError "run.energy-error" and what Simulator::advance_to() throws.
  bool advance_to(double t);
  /// Returns true if t is before the time that is reached.
  bool is_past(double t) const { return t < simulator_->time() - simulator_->resolution(); }
  /// The message for a time that is_past().
  std::string describe_past(double t) const;
  /// The message for a time after the next event of an integrator of the host.
  std::string describe_event_before(double t) const;
  /// Reason of the end. \pre the run has ended.
  std::string describe_end() const;

  /// Bytes of save(), the same for all states.
  std::size_t state_size() const { return state_size_; }
  /// \param to  at least state_size() bytes; those after the state are set to zero.
  void save(std::span<std::byte> to) const;
  /// Throws InputError "embed.bad-state", "run.bad-checkpoint".
  void restore(std::span<const std::byte> from);

 private:
  records::SystemSpec spec_;
  solver::NoSink sink_;
  solver::SimulateOptions run_;
  Diagnostics diagnostics_;
  std::uint64_t fingerprint_ = 0;
  std::unique_ptr<solver::Simulator> simulator_;
  std::size_t state_size_ = 0;
};

}  // namespace bough::embed
