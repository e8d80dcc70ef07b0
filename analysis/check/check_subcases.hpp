#pragma once
/// \file Checks of each subcase: its sets exist; resultants of its loads.
#include "analysis/check/check.hpp"

namespace bough::analysis {

/// The subcases that have a load, temperatures or enforced displacements, with the resultants of their loads about the
/// origin. `model`: of the subcase in `options`. What static would refuse is an error, and a warning in decks of other
/// solutions; reports cli.empty-load.
std::vector<SubcaseCheck> check_subcases(const records::Deck& deck, const fe::Model& model,
                                         const fe::ModelOptions& options, Diagnostics& diagnostics);

}  // namespace bough::analysis
