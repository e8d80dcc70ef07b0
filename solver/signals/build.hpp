#pragma once
/// \file The signal graph of a system file: names to blocks and rows.
#include "solver/system/build.hpp"

namespace bough::solver {

/// Sensors, controllers, actuators and the functions that they name into impl.signals; jumps of those functions into
/// impl.breakpoints. After the tree is finished; adds markers. Reports what Sensors::build, make_controller and
/// make_actuator do, "control.unknown-signal", "control.algebraic-loop"; impl.signals_are_sound tells.
void build_signals(const records::SystemSpec& spec, const System& system, const FunctionMap& functions,
                   System::Impl& impl, Diagnostics& diagnostics);

}  // namespace bough::solver
