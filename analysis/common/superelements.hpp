#pragma once
/// \file The superelements of a deck: external ones by their files, those with elements by static condensation.
#include "formats/records/deck.hpp"

namespace bough::analysis {

/// Makes deck.superelements: sections (BEGIN SUPER) with elements are condensed to their boundary, K = ΨᵀKΨ and M =
/// ΨᵀMΨ with the constraint modes Ψ (Guyan 1965), and get displacements of all their grids as recovery rows; then
/// matrices::read_superelements().
///
/// The boundary has the grids of SECONCT and, unless SEBULK requests MANUAL, those that coincide with a grid of the
/// main bulk data. Reports fe.part-boundary (no boundary; two parts meet outside of the main bulk data), fe.part-load
/// (loads in a section), what fe reports of the section, and what read_superelements() reports. Collective.
void join_superelements(records::Deck& deck, Diagnostics& diagnostics);

}  // namespace bough::analysis
