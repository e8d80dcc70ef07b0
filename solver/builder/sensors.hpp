#pragma once
/// \file [[sensor]] of a system file: names to indices.
#include <vector>

#include "solver/sensors/sensor.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {

/// Every sensor of the spec, in its order. Reports every error: "sensor.unknown-body", "sensor.unknown-node",
/// "sensor.unknown-hinge", "sensor.bad-frame", "sensor.bad-coordinate", "sensor.unknown-element". Measure only when it
/// reported none.
std::vector<Sensor> build_sensors(const System& system, const records::SystemSpec& spec, Diagnostics& diagnostics);

}  // namespace bough::solver
