#pragma once
/// \file Table, JSON and CSV of linear models along a parameter or a run.
#include <nlohmann/json.hpp>
#include <string>

#include "formats/records/linear_sweep.hpp"

namespace bough::cli {

nlohmann::json make_json(const records::LinearSweep& sweep);
std::string format_sweep(const records::LinearSweep& sweep);
/// A row a value: the parameter, then real, imaginary part, frequency and damping of each branch.
std::string make_sweep_csv(const records::LinearSweep& sweep);

}  // namespace bough::cli
