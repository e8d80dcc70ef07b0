#pragma once
/// \file [[event]] of a system file: at a time, or where a signal crosses a value.
#include "formats/records/system_spec.hpp"
#include "solver/simulate/outputs.hpp"

namespace bough::solver {

/// An event that came.
struct Occurrence {
  double time = 0;
  size_t trigger = 0;
};

class UserEvents {
 public:
  /// Finds the signals among the recorder's channels. Reports "run.bad-event", "run.unknown-signal" and the warning
  /// "run.event-never" for a time outside the run. If `system_is_valid` is false, signals may be
  /// missing because of errors reported before.
  static UserEvents build(const records::SystemSpec& spec, const Outputs& recorder, bool system_is_valid,
                          Diagnostics& diagnostics);

  /// Times of the events at a time; either those that only log, or the others.
  std::vector<double> collect_times(bool log_only) const;
  /// Returns true if an event watches a signal.
  bool has_signals() const { return num_signals_ > 0; }
  /// Record of an event of the system file.
  const records::UserEventRecord& get(size_t trigger) const { return records_[trigger]; }
  /// "event 'contact': tip:x rises through 0.1"
  std::string describe(size_t trigger) const;

  /// Values minus thresholds of all signals of a sample; NaN for events at a time.
  void calc_gaps(const VectorXd& sample, VectorXd& gaps) const;
  /// Storage for calc_gaps(), zero.
  VectorXd make_gaps() const { return VectorXd::Zero(static_cast<Eigen::Index>(records_.size())); }

  /// From here on crossings count: the signs at the start, or after a jump of the state.
  void start(const VectorXd& gaps);
  /// Finds the signals that crossed their value since the last call, by the signs kept, and keeps those of `gaps`. A
  /// signal exactly at its value keeps the sign it had. Appends the indices of the events to `crossed`.
  void find_crossed(const VectorXd& gaps, std::vector<size_t>& crossed);
  /// Events at a time due within `resolution` of t, appended.
  void find_due(double t, double resolution, std::vector<Occurrence>& due) const;

  /// The signs kept, for a checkpoint.
  VectorXd signs;

 private:
  std::vector<records::UserEventRecord> records_;
  std::vector<int> index_;  ///< in the sample; -1: at a time
  int num_signals_ = 0;
};

}  // namespace bough::solver
