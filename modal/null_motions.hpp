#pragma once
/// \file Every zero-energy motion, of the whole and of its parts: by inverse iteration, for where the modes found
/// from a shifted K are not sound.
#include "modal/pencil.hpp"

namespace bough::modal::detail {

/// find_rigid_motions and all others with every row of K x zero in roundoff: mechanisms, parts that float, scalar
/// points on nothing. `modes`: those of find_rigid_motions first, then the others, zero at `held`; `supports` is set.
/// Costs one factor of K and some forty solutions for six motions.
RigidMotions find_null_motions(const Pencil& pencil);

}  // namespace bough::modal::detail
