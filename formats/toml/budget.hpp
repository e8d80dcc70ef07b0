#pragma once
/// \file Pointing budgets in TOML.
#include "base/diagnostic.hpp"
#include "formats/records/pointing_budget.hpp"

namespace bough::toml_files {

/// Exposures and sources of a file for bough response --budget. Reports "linear.bad-budget", "linear.bad-psd", toml.*.
records::BudgetSpec read_budget(const std::string& path, Diagnostics& diagnostics);

}  // namespace bough::toml_files
