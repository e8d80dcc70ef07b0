#pragma once
/// \file Sizes of the bodies of a tree, whatever the origins of their frames and the places of their hinges.
#include "solver/tree/tree.hpp"

namespace bough::solver {

/// [L] Extents of the bodies (calc_extent), one per body, without what they carry. Of a point mass it is the distance
/// from its hinge; if both coincide, the largest of the other sizes; if there is none, the reach of the hinges, or 1.
VectorXd calc_body_sizes(const Tree& tree);

}  // namespace bough::solver
