#pragma once
/// \file [[actuator]] of a system file as blocks (docs/theory/control.md).
#include <memory>

#include "solver/signals/block.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {

/// Outputs by type; 0: unknown type.
int find_actuator_outputs(const std::string& type);

/// Types: hinge motor brake force moment jet wheel cmg double_gimbal_cmg modal. Adds the marker it acts at to the tree.
/// Reports "control.*" and what find_loaded_node does; nullptr on errors.
std::unique_ptr<Block> make_actuator(const records::ActuatorRecord& record, const System& system, Tree& tree,
                                     Diagnostics& diagnostics);

}  // namespace bough::solver
