#pragma once
/// \file What a bough_model holds: a loaded system and the names of what hosts set and read.
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "embed/load.hpp"
#include "formats/records/results.hpp"

namespace bough::embed {

struct Port {
  std::string name, dims;
  double start = 0;  ///< NaN: none
  int row = 0;       ///< of an output: in the vector of all channels
};

class Model {
 public:
  /// Begins a simulation once for the names; throws what that throws.
  explicit Model(LoadedSystem loaded);

  const LoadedSystem& loaded() const { return loaded_; }
  const std::vector<Port>* list(int kind) const;
  /// By its name, by the path of its channel, by the name without the component of a scalar; -1: none.
  int find(int kind, const std::string& name) const;

 private:
  void add_outputs(const std::vector<records::Channel>& channels);

  LoadedSystem loaded_;
  std::vector<Port> ports_[5];
  std::unordered_map<std::string, int> index_[5];
};

/// A sink that drops all.
class NoSink final : public records::ResultSink {
 public:
  void begin(const records::ResultsHeader&) override {}
  void write_sample(const Eigen::Ref<const Eigen::VectorXd>&) override {}
  void write_event(const records::EventRecord&) override {}
  void write_checkpoint(const records::Checkpoint&) override {}
  void end(bool, const std::string&) override {}
};

}  // namespace bough::embed
