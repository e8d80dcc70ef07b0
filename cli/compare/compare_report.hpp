#pragma once
/// \file Results of `compare`, as tables of at most 100 columns and as JSON.
#include <nlohmann/json.hpp>
#include <string>

#include "analysis/compare/compare.hpp"

namespace bough::cli {

/// Table of the norms of the mass integrals per mode by each method, with differences from the exact set, and of the
/// captured effective mass.
std::string format_report(const analysis::SingleReport& report);
/// The numbers of the table as JSON, at full precision.
nlohmann::json make_json(const analysis::SingleReport& report);
/// Tables of two models: nodes in common, pairs of modes with frequencies and MAC, effective masses, and matrices if
/// both are bodies.
std::string format_report(const analysis::PairReport& report);
/// The numbers of the tables as JSON, with the whole MAC matrix.
nlohmann::json make_json(const analysis::PairReport& report);
/// Table of three refined meshes: each quantity on the meshes A to C, its observed order and its extrapolated value.
std::string format_report(const analysis::RefinementReport& report);
/// The numbers of the table as JSON.
nlohmann::json make_json(const analysis::RefinementReport& report);
/// Tables of test and analysis: pairs with frequencies and MAC, cross-orthogonality, COMAC.
std::string format_report(const analysis::TestReport& report);
/// The numbers of these tables as JSON.
nlohmann::json make_json(const analysis::TestReport& report);
/// Table of computed responses against measured functions: FRAC, levels, peaks.
std::string format_report(const analysis::FrfReport& report);
/// The numbers of the table as JSON.
nlohmann::json make_json(const analysis::FrfReport& report);
/// Table of the places of sensors, in the order in which effective independence keeps them.
std::string format_report(const analysis::SensorReport& report);
/// The places of sensors as JSON.
nlohmann::json make_json(const analysis::SensorReport& report);

}  // namespace bough::cli
