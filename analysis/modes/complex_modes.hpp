#pragma once
/// \file Complex modes of a deck (SOL 107, 110), one subcase after the other.
#include "analysis/modes/modes.hpp"

namespace bough::analysis {

/// Throws InputError "cli.complex-option" for `option` with a deck that requests complex eigenvalues.
void refuse_complex_option(bool is_given, const char* option);

/// Solves the requested subcase, or those with CMETHOD. Throws the failures of all subcases if none has modes.
ModesAnswer solve_complex_modes(const ModesRequest& request, ModesReceiver& receiver, Events& events);

}  // namespace bough::analysis
