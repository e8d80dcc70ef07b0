#pragma once
/// \file Extent of a body, whatever the origin of its frame.
#include "solver/bodies/body.hpp"

namespace bough::solver {

/// [L] Centre of mass from Bo; Bo of a body without mass.
Vector3d calc_centre_of_mass(const Body& body);

/// [L] Diagonal of a box of the body's mass and inertia about its centre of mass; 0 of a point.
double calc_inertia_extent(const Body& body);

/// [L] The larger of calc_inertia_extent and the diagonal of the box around the nodes, without node 0 and special
/// nodes; 0 of a point.
double calc_extent(const Body& body);

}  // namespace bough::solver
