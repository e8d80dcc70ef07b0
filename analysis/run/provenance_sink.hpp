#pragma once
/// \file A sink before the writer: adds the input files with their SHA-256, and delays the end of the file until the
/// controllers are closed.
#include <optional>
#include <string>
#include <vector>

#include "formats/records/results.hpp"

namespace bough::analysis {

class ProvenanceSink final : public records::ResultSink {
 public:
  /// `inner` must outlive the sink. `source`: (file name, SHA-256).
  ProvenanceSink(records::ResultSink& inner, std::vector<std::pair<std::string, std::string>> source)
      : inner_(inner), source_(std::move(source)) {}

  /// Adds the input files to the header before the inner sink receives it.
  void begin(const records::ResultsHeader& header) override {
    auto with_source = header;
    with_source.source = source_;
    inner_.begin(with_source);
  }
  void write_sample(const Eigen::Ref<const Eigen::VectorXd>& sample) override { inner_.write_sample(sample); }
  void write_event(const records::EventRecord& event) override {
    events_.push_back(event);
    inner_.write_event(event);
  }
  void write_checkpoint(const records::Checkpoint& checkpoint) override { inner_.write_checkpoint(checkpoint); }
  void write_energy_error(double worst) override { inner_.write_energy_error(worst); }
  void flush() override { inner_.flush(); }
  void end(bool completed, const std::string& reason) override { end_.emplace(completed, reason); }
  /// Passes on the end that the solver gave, if it gave one.
  void finish() {
    if (end_) inner_.end(end_->first, end_->second);
    end_.reset();
  }
  /// Passes on the end of a run that failed.
  void finish_failed() {
    if (end_ && !end_->first) finish();
  }
  /// Written so far.
  const std::vector<records::EventRecord>& events() const { return events_; }

 private:
  records::ResultSink& inner_;
  std::vector<records::EventRecord> events_;
  std::vector<std::pair<std::string, std::string>> source_;
  std::optional<std::pair<bool, std::string>> end_;
};

}  // namespace bough::analysis
