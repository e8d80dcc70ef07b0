#pragma once
/// \file Tables and JSON of margins of safety and of extremes over the subcases.
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "formats/records/static_result.hpp"

namespace bough::cli {

/// The smallest of each kind; empty without any.
std::string format_margins(const std::vector<records::StressMargins>& margins);
/// The rows of format_margins() as JSON.
nlohmann::json to_json(const std::vector<records::StressMargins>& margins);

/// A row per component: the least and the largest of all, where and in which subcase.
std::string format_case_extremes(const std::vector<records::CaseExtremes>& extremes);
/// The extremes as JSON.
nlohmann::json to_json(const std::vector<records::CaseExtremes>& extremes);

}  // namespace bough::cli
