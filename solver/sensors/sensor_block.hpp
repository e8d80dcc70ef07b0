#pragma once
/// \file A sensor in the signal graph: the measurement and its processing.
///
///     measurement -> lag -> misalignment -> scale -> + bias + random walk + noise -> range -> quantization -> hold,
///     delay
#include <memory>

#include "solver/sensors/sensor.hpp"
#include "solver/signals/block.hpp"

namespace bough::solver {

/// Reports "sensor.bad-value" and "sensor.needs-sample-time" (noise, random_walk, quantization, delay without it).
std::unique_ptr<Block> make_sensor_block(const Sensor& entry, const records::SensorRecord& record,
                                         Diagnostics& diagnostics);

}  // namespace bough::solver
