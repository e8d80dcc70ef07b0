#pragma once
/// \file Table and JSON of linear models along a parameter or a run.
#include <nlohmann/json.hpp>
#include <string>

#include "formats/records/linear_sweep.hpp"

namespace bough::cli {

nlohmann::json make_json(const records::LinearSweep& sweep);
std::string format_sweep(const records::LinearSweep& sweep);

}  // namespace bough::cli
