#pragma once
/// \file Pointing budget as tables and JSON.
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "formats/records/pointing_budget.hpp"

namespace bough::cli {

/// A table of RMS for each weighting: rows of sources and the total, columns of outputs; then the worst wheel speeds.
std::string format_budget(const records::PointingBudget& budget);

/// Outputs, sources, band; by weighting the RMS, the total and, of wheels, the worst speeds and the RMS over speed.
nlohmann::json make_budget_json(const records::PointingBudget& budget);

}  // namespace bough::cli
