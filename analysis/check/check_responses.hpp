#pragma once
/// \file Checks of what a deck of SOL 107 to 112 selects: frequencies, times, loads, damping, methods.
#include "analysis/check/check.hpp"
#include "formats/records/deck_dynamics.hpp"

namespace bough::analysis {

/// Frequencies or times and loads of each subcase that `frequency` or `transient` solves for the SOL of the deck; empty
/// for other solutions. `model`: of the subcase in `options`. Reports what those commands, or `modes` of a deck that
/// asks for complex ones, refuse before they solve; a deck without any DLOAD is a warning.
std::vector<ResponseCheck> check_responses(const records::DynamicDeck& deck, const fe::Model& model,
                                           const fe::ModelOptions& options, Diagnostics& diagnostics);

}  // namespace bough::analysis
