#pragma once
/// \file Margins of safety, and extremes over the subcases.
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "formats/records/deck.hpp"
#include "formats/records/static_result.hpp"

namespace bough::cli {

/// Of rods, bars and beams whose MAT1 has ST, SC or SS, as Nastran prints them.
std::vector<records::StressMargins> calc_margins(const records::Deck& deck, const records::StaticSubcase& subcase);

/// Of displacements, reactions, element forces, stresses and strains; all subcases have the same grids and elements.
std::vector<records::CaseExtremes> find_case_extremes(const records::StaticResult& result);

/// The smallest of each kind; empty without any.
std::string format_margins(const std::vector<records::StressMargins>& margins);
nlohmann::json to_json(const std::vector<records::StressMargins>& margins);

/// A row per component: the least and the largest of all, where and in which subcase.
std::string format_case_extremes(const std::vector<records::CaseExtremes>& extremes);
nlohmann::json to_json(const std::vector<records::CaseExtremes>& extremes);

}  // namespace bough::cli
