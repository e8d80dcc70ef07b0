#pragma once
/// \file Pointing budget of a linear model: RMS of each output by source, wheel speed and exposure.
#include <string>
#include <vector>

#include "analysis/common/events.hpp"
#include "formats/records/pointing_budget.hpp"
#include "solver/statespace/frequency_response.hpp"

namespace bough::analysis {

struct BudgetRequest {
  std::string file;                  ///< linear model
  std::string budget;                ///< TOML file of sources
  std::vector<std::string> outputs;  ///< empty: all
  statespace::FrequencyRange range;  ///< band of spectral densities; open ends by the densities and poles
};

/// Computes the RMS of every source in every output, by weighting; wheels at each speed.
/// \throws InputError "linear.bad-budget", "linear.bad-psd", "linear.unknown-input", "linear.no-channels", those of
/// reading; ComputationError "linear.unbounded-random".
records::PointingBudget calc_budget(const BudgetRequest& request, Events& events);

/// Comma-separated values: weighting, exposure, source, speed, then each output. Rows of wheels have a speed; "worst"
/// in its place is the largest over the speeds; source "total" is the root of the sum of squares.
std::string make_budget_csv(const records::PointingBudget& budget);

}  // namespace bough::analysis
