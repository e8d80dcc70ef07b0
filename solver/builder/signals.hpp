#pragma once
/// \file The signal graph of a system file: names to blocks and rows.
#include "solver/builder/build.hpp"
#include "solver/builder/connects.hpp"

namespace bough::solver {

/// Sensors, controllers, actuators, forces that follow a signal (system.driven) and the functions that they name into
/// system.signals; jumps of those functions into system.jump_times. After the tree is finished; adds markers. Reports
/// what build_sensors, make_controller and make_actuator do, "control.unknown-signal", "control.algebraic-loop" and
/// the warning "control.units"; system.signals_are_valid tells.
void build_signals(const records::SystemSpec& spec, const FlexMap& flex, const FunctionMap& functions,
                   const SignalUses& uses, System& system, Diagnostics& diagnostics);

}  // namespace bough::solver
