#pragma once
/// \file Dimensions of signals, where they are known, against those that blocks expect.
#include <string>
#include <vector>

#include "solver/signals/graph.hpp"

namespace bough::solver {

/// "F L, 1/T" of `outputs` components: one each; nothing if they are not known ("by the controller").
std::vector<std::string> split_dims(const std::string& dims, int outputs);
/// Returns true if both are the same quantity, as "F L" and "M L^2/T^2", or if one is not known (empty).
bool are_alike_dims(const std::string& a, const std::string& b);
/// a / T.
std::string make_rate_dims(const std::string& a);

/// Warns ("control.units") if a controller adds or compares different quantities, or if the input of an actuator has a
/// wrong dimension; after a gain the dimension is unknown. `records`: of each slot, nullptr: no controller.
void check_signal_units(const SignalGraph& graph, const std::vector<const records::ControllerRecord*>& records,
                        Diagnostics& diagnostics);

}  // namespace bough::solver
