#pragma once
/// \file Bars of a pointing budget as SVG: waterfall over sources, shares of sources by weighting.
#include <string>

#include "formats/records/pointing_budget.hpp"

namespace bough::report {

/// Draws the waterfall of one output under the weighting of `table`: a bar for each source, the largest first, each
/// from the sum of the mean squares before it to the sum with it, and the total. Numbers are RMS and share of the mean
/// square.
///
/// \param output  from 0. \return empty if the RMS is zero.
std::string draw_budget_waterfall(const records::PointingBudget& budget, const records::BudgetTable& table,
                                  Eigen::Index output);

/// Draws the shares of the sources in the mean square of one output, one stacked bar for each table of the budget.
///
/// \param output  from 0. \return empty if every RMS is zero.
std::string draw_budget_shares(const records::PointingBudget& budget, Eigen::Index output);

}  // namespace bough::report
