#pragma once
/// \file What the deck's SOL asks for beyond linear statics, modes and buckling.
#include "formats/records/deck.hpp"

namespace bough::cli {

/// One note where SOL is not linear: cli.other-solution.
void note_solution(const records::Deck& deck, Diagnostics& diagnostics);

/// Static solutions of a SOL that is nonlinear in its statics only when asked for: throws
/// InputError("cli.nonlinear-static") unless `is_linear`, else notes as note_solution.
void demand_static_solution(const records::Deck& deck, bool is_linear, Diagnostics& diagnostics);

}  // namespace bough::cli
