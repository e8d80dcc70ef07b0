#pragma once
/// \file Table and JSON of linear models along a parameter or a run.
#include <nlohmann/json.hpp>
#include <string>

#include "formats/records/linear_sweep.hpp"

namespace bough::cli {

/// Poles, frequencies [Hz], damping ratios and correlations of all branches, one row per value of the parameter.
nlohmann::json make_json(const records::LinearSweep& sweep);
/// Table of the branches: frequencies and damping ratios at both ends of the sweep and the largest real part of the
/// pole; then the number of poles at z = 0, if any.
std::string format_sweep(const records::LinearSweep& sweep);

}  // namespace bough::cli
