#pragma once
/// \file A deck in other units: every field with a dimension is multiplied, the rest keeps every byte.
#include <vector>

#include "formats/nastran/field_editor.hpp"

namespace bough::nastran {

/// Factors from old to new units: values in new units per old unit.
struct UnitFactors {
  double mass = 1, length = 1, time = 1;
};

/// The fields of the deck that change. Adds deck.unit-card for a card with numbers whose dimensions are not known,
/// deck.unit-field for a field whose dimension cannot be told, deck.unit-replication for cards written by replication,
/// each at its line; then nothing is to be written. Angles, ratios and temperatures stay, rho and PARAM,WTMASS too in
/// their proportion: RHO is converted as a mass, WTMASS is kept.
std::vector<FieldEdit> convert_units(const DeckEditor& deck, const UnitFactors& factors, Diagnostics& diagnostics);

}  // namespace bough::nastran
