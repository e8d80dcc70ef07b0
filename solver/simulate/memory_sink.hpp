#pragma once
/// \file A ResultSink that keeps everything in memory: for tests, and for programs that want the numbers and no file.
#include <string>
#include <vector>

#include "formats/records/results.hpp"

namespace bough::solver {

class MemorySink final : public records::ResultSink {
 public:
  void begin(const records::ResultsHeader& header) override;
  void write_sample(const Eigen::Ref<const Eigen::VectorXd>& sample) override;
  void write_event(const records::EventRecord& event) override { events_.push_back(event); }
  void write_checkpoint(const records::Checkpoint& checkpoint) override { checkpoints_.push_back(checkpoint); }
  void write_energy_error(double worst) override { energy_error_ = worst; }
  void end(bool completed, const std::string& reason) override;

  /// Channels and attributes of the run.
  const records::ResultsHeader& header() const { return header_; }
  /// Number of samples so far.
  int num_samples() const { return static_cast<int>(samples_.size()); }
  /// Returns true if the run has the channel.
  bool has(const std::string& path) const;
  /// num_samples x size of the channel; BOUGH_DEMAND that it exists.
  Eigen::MatrixXd get(const std::string& path) const;
  /// Time [T] of each sample.
  Eigen::VectorXd time() const { return get("/time").col(0); }
  /// Events in the order of time.
  const std::vector<records::EventRecord>& events() const { return events_; }
  /// All checkpoints of the run.
  const std::vector<records::Checkpoint>& checkpoints() const { return checkpoints_; }
  /// Returns true after end().
  bool ended() const { return ended_; }
  /// Returns true if the run reached its duration.
  bool completed() const { return completed_; }
  /// Reason of an early end; empty: none.
  const std::string& reason() const { return reason_; }
  double energy_error() const { return energy_error_; }  ///< the worst, as last written

 private:
  records::ResultsHeader header_;
  std::vector<Eigen::VectorXd> samples_;
  std::vector<records::EventRecord> events_;
  std::vector<records::Checkpoint> checkpoints_;
  bool ended_ = false, completed_ = false;
  double energy_error_ = 0;
  std::string reason_;
};

}  // namespace bough::solver
