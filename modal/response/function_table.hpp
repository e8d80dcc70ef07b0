#pragma once
/// \file Functions of frequency and time that the deck gives as tables. Source: MSC Nastran Quick Reference Guide,
/// TABLED1 to TABLED4, TABDMP1.
#include "formats/records/deck_dynamics.hpp"

namespace bough::modal::response {

using records::evaluate;
using records::Side;

/// ζ at a frequency of G = 2 ζ, CRIT = ζ, Q = 1/(2 ζ); beyond its ends along the line of its last two points.
double calc_damping_ratio(const records::DampingCurve& curve, double hz);

/// The card with this id; nullptr if there is none.
const records::DynamicTable* find_table(const records::DynamicDeck& deck, int id);

}  // namespace bough::modal::response
