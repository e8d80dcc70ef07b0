#pragma once
/// \file Time events of a run: samples, jumps, mesh times, events at a time, its end.
#include <limits>
#include <optional>
#include <vector>

#include "formats/records/system_spec.hpp"

namespace bough::solver {

/// A time that no step passes. Its right-hand side is asked for times up to `latest` <= time only: before a jump for
/// earlier ones, so that the last step sees the values before it; what follows starts at `time` with those after it.
struct TimeEvent {
  double time = 0, left = 0;
  bool is_jump = false;  ///< a jump, or an event at a time: the integrator drops its history
};

/// Effective division of [simulation].
struct RunPlan {
  double start = 0, end = 0, output_step = 0;
  double step = 0;  ///< rk4: effective step; others: the largest step, 0 = free
};

/// Checks [simulation]: "run.unknown-integrator", "run.bad-simulation"; note "run.step-adjusted" when rk4's step does
/// not divide output_step.
RunPlan make_run_plan(const records::SimulationRecord& simulation, Diagnostics& diagnostics);

/// One queue of samples and stops. Times closer together than 1e-12 of the duration are one, the jump's. Samples are
/// counted, not stored: start, start + output_step, ..., exactly the end.
class TimeEvents {
 public:
  /// `jumps` (jumps, events at a time) and `mesh_times`: in any order, inside the run or not.
  TimeEvents(const RunPlan& plan, std::vector<double> jumps, std::vector<double> mesh_times);
  explicit TimeEvents(const RunPlan& plan) : TimeEvents(plan, {}, {}) {}

  /// Instants of samples from the start on, first + i * period: each becomes a stop without a restart.
  void add_samples(double first, double period) {
    samples_.push_back({first, period});
    next_ = calc_output(index_);
  }

  /// Start time [T] of the run.
  double start() const { return plan_.start; }
  /// End time [T] of the run.
  double end() const { return plan_.end; }
  /// Number of output samples, with those at start and end.
  long num_outputs() const { return num_outputs_; }
  /// Time of output sample i, exactly the end for the last one; infinite after it.
  double calc_output(long i) const;
  /// The next sample that has not been taken; infinite after the last.
  double next_output() const { return next_; }
  /// Index of the next output sample.
  long next_index() const { return index_; }
  /// Goes on to the next output sample.
  void take_output();
  /// Skips the samples up to and including t.
  void skip_outputs(double t);
  /// The first stop past t; the end is one.
  TimeEvent find_next(double t) const;
  /// The stop at t, an instant of samples too; none if there is none.
  std::optional<TimeEvent> find_at(double t) const;
  /// Returns true if the integrator is reset at t.
  bool is_restart(double t) const;
  /// Times that are one.
  double resolution() const { return close_; }

 private:
  double snap(double t) const;
  /// Snaps to time events alone, not to samples.
  double snap_to_stop(double t) const;

  RunPlan plan_;
  double close_ = 0;
  long num_outputs_ = 0, index_ = 0;
  double next_ = 0;
  std::vector<TimeEvent> stops_;
  struct Samples {
    double first = 0, period = 0;
  };
  std::vector<Samples> samples_;
};

}  // namespace bough::solver
