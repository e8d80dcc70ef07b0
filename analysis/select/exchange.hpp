#pragma once
/// \file Exchange of retained and dropped modes by the measured loss.
#include "analysis/select/selection.hpp"

namespace bough::analysis {

/// Exchanges modes that costs have decided about, one pair at a time, the pair that lowers the loss most, as long as it
/// falls. With `tolerance` modes are then dropped, that of least loss first, as long as the loss is within it.
/// \note Each pair costs a linear model of every configuration.
void exchange_modes(const std::vector<Weighing>& weighings, std::optional<double> tolerance, Events& events,
                    Selection& selection);

}  // namespace bough::analysis
