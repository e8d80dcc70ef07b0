#pragma once
/// \file A whole run: from a System to samples in a ResultSink.
#include <atomic>
#include <chrono>
#include <functional>
#include <optional>

#include "formats/records/results.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {

struct Progress {
  double time = 0, start = 0, end = 0, step = 0;
  int order = 0;
  long num_steps = 0, num_rejected = 0, num_evaluations = 0;
  double energy_error = 0;  ///< at `time`, relative (EnergyMonitor)
};

struct SimulateOptions {
  std::function<void(const Progress&)> progress;  ///< called at each output sample, and between many switches
  const std::atomic<bool>* stop = nullptr;        ///< set by a signal: checkpoint and end cleanly
  std::optional<records::Checkpoint> resume;
  std::chrono::seconds checkpoint_after{60};  ///< where samples are rare; else with every hundredth
};

struct SimulateOutcome {
  bool completed = false;
  double time = 0;
  std::string reason;  ///< why it stopped early: a request (then not completed) or an event
  Progress last;
  double energy_error = 0;     ///< the worst of the run, relative
  bool energy_is_kept = true;  ///< else "run.energy-error" was reported
};

/// Reports what simulate would refuse in the spec. The system may have come from draft_system.
void check_run(const System& system, const records::SystemSpec& spec, Diagnostics& diagnostics);

/// Checks the start of the run too: closes loops, factors masses, samples controllers, makes the first sample and
/// handles the events of its time. Reports what would end the run there, a failed computation too; throws nothing.
void check_start(const System& system, const records::SystemSpec& spec, Diagnostics& diagnostics);

/// Integrates spec.simulation and streams samples. A run that diverges (non-finite state, or past the limit) ends the
/// sink with the samples so far and throws ComputationError("run.diverged") with the time and the body. An energy error
/// above energy_error_limit is an error in `diagnostics` ("run.energy-error"), one past a hundredth of the limit a
/// warning ("run.energy-drift"): the samples are written all the same.
SimulateOutcome simulate(const System& system, const records::SystemSpec& spec, records::ResultSink& sink,
                         const SimulateOptions& options, Diagnostics& diagnostics);

}  // namespace bough::solver
