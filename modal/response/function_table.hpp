#pragma once
/// \file Functions of frequency and time that the deck gives as tables. Source: MSC Nastran Quick Reference Guide,
/// TABLED1 to TABLED4, TABDMP1.
#include "formats/records/deck_dynamics.hpp"

namespace bough::modal::response {

/// Where a function jumps it has two values: before, after, or the mean of them.
enum class Side { Before, After, Mean };

/// y(x). Beyond its ends the table goes on along the line of its last two points (TABLED4: it keeps its end value).
/// `reach`: points of the table within it of x count as x.
double evaluate(const records::DynamicTable& table, double x, Side side = Side::Mean, double reach = 0);

/// ζ at a frequency of G = 2 ζ, CRIT = ζ, Q = 1/(2 ζ); beyond its ends along the line of its last two points.
double calc_damping_ratio(const records::DampingCurve& curve, double hz);

/// The card with this id; nullptr if there is none.
const records::DynamicTable* find_table(const records::DynamicDeck& deck, int id);

}  // namespace bough::modal::response
