#pragma once
/// \file AUTOSPC: dofs without stiffness are fixed.
#include <array>

#include "fe/model/constraints.hpp"
#include "fe/model/model.hpp"

namespace bough::fe {

/// The singular directions of the 3 x 3 translational and rotational stiffness of each node, after constraints.
///
/// A direction is singular when its principal stiffness is at most `epsilon` times the largest diagonal term of its
/// block, or round-off of the terms that the block is a sum of (parts that rigid elements cancel); how stiff the model
/// is elsewhere does not matter. The component (CD) with the largest share in it is held and the block looked at again,
/// so that a rigid-body motion of the whole model, to which every node has stiffness, is never touched (MSC Nastran's
/// grid point singularity processing, PARAM,EPZERO).
/// The stiffness of a prestressed model has that of its stress; what it softens is left free, as no support may hide
/// that it buckles. T of `model` = constraints before AUTOSPC; fdof_ldof as in Elimination.
/// Entries whose component has stiffness, as at the end of an oblique rod, say so (is_skew) and have the terms by which
/// the components follow each other when the direction itself is held. By node and component.
std::vector<AutospcEntry> find_singular_dofs(const Model& model, const std::vector<int>& fdof_ldof, double epsilon);

/// The mass of each of `entries`, its own and of dofs that follow it (the diagonal of M before AUTOSPC).
/// T of `model` = constraints before AUTOSPC.
std::vector<double> calc_masses(const Model& model, const std::vector<int>& fdof_ldof,
                                const std::vector<AutospcEntry>& entries);

}  // namespace bough::fe
