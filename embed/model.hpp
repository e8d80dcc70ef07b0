#pragma once
/// \file The bough_model of the C interface: a loaded system and the names of its ports.
#include "embed/ports.hpp"
#include "embed/simulation.hpp"

namespace bough::embed {

class Model {
 public:
  /// Begins a simulation once for the names; throws what that throws.
  explicit Model(LoadedSystem loaded) : loaded_(std::move(loaded)), ports_(make_ports(loaded_)) {}

  const LoadedSystem& loaded() const { return loaded_; }
  const Ports& ports() const { return ports_; }
  const std::vector<int>& output_rows() const { return ports_.output_rows(); }
  const std::vector<Port>* list(int kind) const { return ports_.list(kind); }
  int find(int kind, const std::string& name) const { return ports_.find(kind, name); }

 private:
  static Ports make_ports(const LoadedSystem& loaded) {
    return {loaded.spec, Simulation(loaded, loaded.spec).simulator()};
  }

  LoadedSystem loaded_;
  Ports ports_;
};

}  // namespace bough::embed
