#pragma once
/// \file Enforced displacements of fixed DOFs: SPC and SPCD. Source: MSC Nastran Quick Reference Guide, SPC, SPCD.
#include "fe/model/model.hpp"

namespace bough::fe {

/// Returns true if the fixed DOFs of the model are those of load set `set`: every DOF that its SPCD cards move is
/// fixed, and no DOF is fixed for the SPCD cards of another set alone.
bool is_held_for(const Model& model, const records::Deck& deck, int set);

/// Displacements d of the fixed DOFs: those of the SPC set, overridden by the SPCD cards of load set `set` (0: none).
/// \return in the CD axes, in the order of Model::fixed_dofs(). Reports fe.spcd-not-fixed.
VectorXd calc_enforced(const Model& model, const records::Deck& deck, int set, Diagnostics& diagnostics);

}  // namespace bough::fe
