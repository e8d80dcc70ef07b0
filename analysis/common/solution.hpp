#pragma once
/// \file Requests of the deck's SOL other than linear statics, modes and buckling.
#include <string>
#include <vector>

#include "formats/records/deck.hpp"

namespace bough::analysis {

/// One note where SOL is not linear: cli.other-solution.
void note_solution(const records::Deck& deck, Diagnostics& diagnostics);

/// Static solutions of a SOL that is nonlinear in its statics only when asked for: throws
/// InputError("cli.nonlinear-static") unless `is_linear`, else notes as note_solution.
void demand_static_solution(const records::Deck& deck, bool is_linear, Diagnostics& diagnostics);

/// Returns true for SOL 107, 110 and their kin unless CMETHOD (or EIGC) is among the names of --ignore.
bool asks_complex_modes(const records::Deck& deck, const std::vector<std::string>& ignored);

}  // namespace bough::analysis
