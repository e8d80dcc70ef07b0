#pragma once
/// \file The time history of a multibody system, written to a results file.
#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "analysis/common/events.hpp"
#include "formats/records/results.hpp"
#include "solver/simulate/simulate.hpp"

namespace bough::analysis {

struct RunRequest {
  std::string file;                         ///< system file
  std::string output;                       ///< results file; empty: choose_run_output(file)
  std::string start_from;                   ///< results file with the initial state; empty: that of the system file
  std::vector<std::string> set;             ///< "name=value" of [parameters]
  bool resume = false;                      ///< continue the results file from its last checkpoint
  const std::atomic<bool>* stop = nullptr;  ///< set by another thread or a signal: the run ends with a checkpoint
};

struct RunAnswer {
  std::string output;               ///< results file
  bool was_complete = false;        ///< nothing was left to resume: the members below but for outcome.reason are unset
  solver::SimulateOutcome outcome;  ///< reason of a complete run: the event that ended it
  std::optional<double> resumed;    ///< [T] time of the checkpoint from which the run continued; none: from the start
  std::vector<records::EventRecord> events;  ///< of this part of the run
  std::vector<Diagnostic> errors;            ///< of results that are written and fail the energy check
  double seconds = 0;                        ///< wall time of the integration
};

/// Receives messages as soon as they are known, and what only a run reports.
class RunEvents : public Events {
 public:
  /// Called before the results file is created, or opened to be resumed; may throw.
  virtual void check_output(const std::string& /*path*/, bool /*resumes*/) {}
  /// Called when the integration begins.
  virtual void start() {}
  /// Called at each sample, and between many switches.
  virtual void show(const solver::Progress& /*progress*/) {}
};

/// Name of the system file with .h5, in the working directory.
std::string choose_run_output(const std::string& file);

/// Integrates and writes the results file.
///
/// Throws InputError "cli.output-is-input", "hdf5.busy", "cli.changed-input", and what load_system(), the writer and
/// solver::simulate() throw; a run that fails ends the results file with its reason.
RunAnswer run_system(const RunRequest& request, RunEvents& events);

}  // namespace bough::analysis
