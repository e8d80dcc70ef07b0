#pragma once
/// \file The superelements of a deck: external ones by their files, those with elements by static condensation.
#include "formats/records/deck.hpp"

namespace bough::analysis {

/// Makes deck.superelements: sections (BEGIN SUPER) with elements are condensed to their boundary, K = ΨᵀKΨ and M =
/// ΨᵀMΨ with the constraint modes Ψ (Guyan 1965) and, by QSET, modes with the boundary held (Craig & Bampton
/// 1968), whose coordinates become scalar points of the deck; their loads by set; geometric stiffness; recovery rows:
/// displacements of all grids, element forces and stresses, forces of the constraints. Then
/// matrices::read_superelements().
///
/// The boundary has the grids of SECONCT and, unless SEBULK requests MANUAL, those that coincide with a grid of the
/// main bulk data (with SEBNDRY those that it names). Reports fe.part-boundary (no boundary; two parts meet outside
/// of the main bulk data), fe.part-load (loads that are not condensed), fe.part-modes, fe.part-mass,
/// fe.part-recovery, what fe reports of the section, and what read_superelements() reports. Collective.
void join_superelements(records::Deck& deck, Diagnostics& diagnostics);

}  // namespace bough::analysis
