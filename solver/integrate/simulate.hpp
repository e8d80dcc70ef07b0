#pragma once
/// \file A whole run: from a System to samples in a ResultSink.
#include <atomic>
#include <functional>
#include <optional>

#include "formats/records/results.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {

struct Progress {
  double time = 0, start = 0, end = 0, step = 0;
  int order = 0;
  long num_steps = 0, num_rejected = 0, num_evaluations = 0;
  double energy_error = 0;  ///< kinetic + strain + potential - work, relative to the largest of them so far
};

struct SimulateOptions {
  std::function<void(const Progress&)> progress;  ///< called at each output sample
  const std::atomic<bool>* stop = nullptr;        ///< set by a signal: checkpoint and end cleanly
  std::optional<records::Checkpoint> resume;
};

struct SimulateOutcome {
  bool completed = false;
  double time = 0;
  std::string reason;  ///< why it stopped early
  Progress last;
};

/// Integrates spec.simulation and streams samples. A run that diverges (non-finite state, or past the limit) ends the
/// sink with what it had and throws ComputationError("run.diverged") with the time and the body.
SimulateOutcome simulate(const System& system, const records::SystemSpec& spec, records::ResultSink& sink,
                         const SimulateOptions& options, Diagnostics& diagnostics);

}  // namespace bough::solver
