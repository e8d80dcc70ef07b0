#pragma once
/// \file Names of PARAM in the Nastran family.
#include "formats/records/deck.hpp"

namespace bough::nastran::detail {

/// One note with every PARAM that has no effect here, by line (deck.unused-params), and a warning for each name that no
/// Nastran knows, with the nearest that one does (deck.unknown-param).
void report_params(const records::Deck& deck, Diagnostics& diagnostics);

}  // namespace bough::nastran::detail
