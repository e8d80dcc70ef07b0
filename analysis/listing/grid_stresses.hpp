#pragma once
/// \file Grid point stresses of surfaces of shells and of volumes of solids (SURFACE, VOLUME, GPSTRESS).
#include <functional>
#include <string>

#include "analysis/listing/element_columns.hpp"
#include "formats/records/deck_dynamics.hpp"
#include "formats/records/listing.hpp"

namespace bough::analysis {

/// Computes the stresses of a field at the corner grids of its elements (docs/theory/recovery.md).
///
/// TOPOLOGICAL, and a VOLUME: the mean of the corner stresses of the connected elements, each in the output system.
/// GEOMETRIC: the linear field by least squares through all corner stresses of the connected elements, at the grid.
/// A grid where normals differ by more than a negative TOLERANCE, and one of an edge of more than two elements with
/// BRANCH BREAK, has a row per element.
///
/// \param is_member  ids of the elements of the field.
/// \param skipped  receives cards of members that have no corner stresses.
/// \throws InputError cli.surface-axis (AXIS along the normal), fe.missing-coordinates.
records::ListedGridStresses calc_grid_stresses(const fe::Model& model, const ElementIndex& elements,
                                               const records::Deck& deck, const records::StressField& field,
                                               const std::vector<records::ElementForces>& forces,
                                               const std::function<bool(int)>& is_member,
                                               std::set<std::string>& skipped);

}  // namespace bough::analysis
