#pragma once
/// \file [[controller]] of a system file as blocks (docs/theory/control.md).
#include <memory>

#include "formats/records/system_spec.hpp"
#include "solver/signals/block.hpp"

namespace bough::solver {

/// Sizes of a controller's inputs, in their order, then of reference and rate (0: none).
struct ControllerWiring {
  std::vector<int> inputs;
  int reference = 0, rate = 0;

  /// Number of all input components, with reference and rate.
  int size() const;
  /// Returns true if all inputs have the size of the first, as sum and product require ("control.bad-size").
  bool are_alike() const;
};

/// Types: transfer_function state_space gain sum product limit notch lead_lag pid table relay pwpf switch expression
/// library fmu. Reports "control.*"; nullptr on errors.
std::unique_ptr<Block> make_controller(const records::ControllerRecord& record, const ControllerWiring& wiring,
                                       Diagnostics& diagnostics);
/// Outputs of the controller where they do not depend on its inputs, else 0.
int find_outputs(const records::ControllerRecord& record);

}  // namespace bough::solver
