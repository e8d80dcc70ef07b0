#pragma once
/// \file The bough_model of the C interface: a loaded system and the names of its ports.
#include "embed/ports.hpp"
#include "embed/simulation.hpp"

namespace bough::embed {

class Model {
 public:
  /// Begins a simulation once for the names; throws what that throws.
  explicit Model(LoadedSystem loaded) : loaded_(std::move(loaded)), ports_(make_ports(loaded_)) {}

  /// Returns the system file with the bodies and tables that it names.
  const LoadedSystem& loaded() const { return loaded_; }
  /// Returns the names, dimensions and start values of all ports.
  const Ports& ports() const { return ports_; }
  /// Returns the index of each output in the vector of all channels.
  const std::vector<int>& output_rows() const { return ports_.output_rows(); }
  /// Returns the ports of a bough_kind; null for an unknown kind.
  const std::vector<Port>* list(int kind) const { return ports_.list(kind); }
  /// Returns the index of a port as Ports::find() does; -1: none.
  int find(int kind, const std::string& name) const { return ports_.find(kind, name); }

 private:
  static Ports make_ports(const LoadedSystem& loaded) {
    return {loaded.spec, Simulation(loaded, loaded.spec).simulator()};
  }

  LoadedSystem loaded_;
  Ports ports_;
};

}  // namespace bough::embed
