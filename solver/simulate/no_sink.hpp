#pragma once
/// \file A sink that drops all, for runs whose motion is read step by step.
#include "formats/records/results.hpp"

namespace bough::solver {

class NoSink final : public records::ResultSink {
 public:
  void begin(const records::ResultsHeader&) override {}
  void write_sample(const Eigen::Ref<const Eigen::VectorXd>&) override {}
  void write_event(const records::EventRecord&) override {}
  void write_checkpoint(const records::Checkpoint&) override {}
  void end(bool, const std::string&) override {}
};

}  // namespace bough::solver
