#pragma once
/// \file Results of `compare`, as tables of at most 100 columns and as JSON.
#include <nlohmann/json.hpp>
#include <string>

#include "analysis/compare/compare.hpp"

namespace bough::cli {

std::string format_report(const analysis::SingleReport& report);
nlohmann::json make_json(const analysis::SingleReport& report);
std::string format_report(const analysis::PairReport& report);
nlohmann::json make_json(const analysis::PairReport& report);
std::string format_report(const analysis::RefinementReport& report);
nlohmann::json make_json(const analysis::RefinementReport& report);
std::string format_report(const analysis::TestReport& report);
nlohmann::json make_json(const analysis::TestReport& report);
std::string format_report(const analysis::SensorReport& report);
nlohmann::json make_json(const analysis::SensorReport& report);

}  // namespace bough::cli
