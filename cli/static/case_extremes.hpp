#pragma once
/// \file Margins of safety, and extremes over the subcases.
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "formats/records/deck.hpp"
#include "formats/records/static_result.hpp"

namespace bough::cli {

/// Margins of rods, bars and beams whose MAT1 has ST, SC or SS, as Nastran prints them.
std::vector<records::StressMargins> calc_margins(const records::Deck& deck, const records::StaticSubcase& subcase);

/// Adds one subcase to the extremes of displacements, reactions, element forces, stresses and strains. All have
/// the same grids and elements.
void add_to_extremes(const Eigen::MatrixXi& dof_map, const records::StaticSubcase& subcase,
                     std::vector<records::CaseExtremes>& extremes);

/// The smallest of each kind; empty without any.
std::string format_margins(const std::vector<records::StressMargins>& margins);
nlohmann::json to_json(const std::vector<records::StressMargins>& margins);

/// A row per component: the least and the largest of all, where and in which subcase.
std::string format_case_extremes(const std::vector<records::CaseExtremes>& extremes);
nlohmann::json to_json(const std::vector<records::CaseExtremes>& extremes);

}  // namespace bough::cli
