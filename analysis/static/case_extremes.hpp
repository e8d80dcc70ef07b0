#pragma once
/// \file Margins of safety, and extremes over the subcases.
#include <vector>

#include "formats/records/deck.hpp"
#include "formats/records/static_result.hpp"

namespace bough::analysis {

/// Margins of rods, bars and beams whose MAT1 has ST, SC or SS, as Nastran prints them.
std::vector<records::StressMargins> calc_margins(const records::Deck& deck, const records::StaticSubcase& subcase);

/// Adds one subcase to the extremes of displacements, reactions, element forces, stresses and strains. All have
/// the same grids and elements.
void add_to_extremes(const Eigen::MatrixXi& dof_map, const records::StaticSubcase& subcase,
                     std::vector<records::CaseExtremes>& extremes);

}  // namespace bough::analysis
