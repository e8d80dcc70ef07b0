#pragma once
/// \file Names of what hosts set and read: inputs, outputs, parameters, states, event functions.
#include <string>
#include <unordered_map>
#include <vector>

#include "formats/records/results.hpp"
#include "formats/records/system_spec.hpp"
#include "solver/simulate/simulator.hpp"

namespace bough::embed {

struct Port {
  std::string name, dims;
  double start = 0;          ///< NaN: none
  int row = 0;               ///< of an output: in the vector of all channels
  std::string channel = {};  ///< of an output: path
};

class Ports {
 public:
  /// Lists inputs and parameters of the file, and channels, states and event functions of its simulator.
  Ports(const records::SystemSpec& spec, const solver::Simulator& simulator);

  /// \param kind  a bough_kind. NULL: no such kind.
  const std::vector<Port>* list(int kind) const;
  /// Finds a port by its name, by the path of its channel, or by the name of a scalar without component; -1: none.
  int find(int kind, const std::string& name) const;
  /// Port::row of each output.
  const std::vector<int>& output_rows() const { return output_rows_; }
  /// Outputs of all components of `name`; that of one if it has a component. Empty: none.
  std::vector<int> find_outputs(const std::string& name) const;

 private:
  void add_outputs(const std::vector<records::Channel>& channels);

  std::vector<Port> ports_[5];
  std::vector<int> output_rows_;
  std::unordered_map<std::string, int> index_[5];
  std::unordered_map<std::string, std::pair<int, int>> channels_;  ///< first output and number of each name
};

}  // namespace bough::embed
