#pragma once
/// \file Tables and JSON of margins of safety and of extremes over the subcases.
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "formats/records/static_result.hpp"

namespace bough::cli {

/// The smallest of each kind; empty without any.
std::string format_margins(const std::vector<records::StressMargins>& margins);
nlohmann::json to_json(const std::vector<records::StressMargins>& margins);

/// A row per component: the least and the largest of all, where and in which subcase.
std::string format_case_extremes(const std::vector<records::CaseExtremes>& extremes);
nlohmann::json to_json(const std::vector<records::CaseExtremes>& extremes);

}  // namespace bough::cli
