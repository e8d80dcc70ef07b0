#pragma once
/// \file Connected parts of a model: grids and scalar points that elements, rigid elements and MPC join.
#include <string>
#include <vector>

#include "fe/model/model.hpp"

namespace bough::fe {

/// Grids and scalar points that are joined, at least two of them or one with a spring to ground.
struct ConnectedPart {
  std::vector<int> nodes;  ///< indices into Model::nodes(), ascending by id
  int num_elements = 0;    ///< of all kinds, masses too
  bool is_held = false;    ///< a translation or a scalar point is constrained (not by AUTOSPC), or a spring to ground
};

/// Largest part first; of equal ones that with the lowest id. Two nodes are joined by an element that names both
/// (springs, bushes and dampers too), or where the constraint equations (T, T_fixed) let one follow the other.
std::vector<ConnectedPart> find_connected_parts(const Model& model);

/// Rank (0 to 6) of the constrained dofs and springs to ground under rigid-body motions of the whole model: 6 if these
/// hold a model in one part. Scalar points count nothing.
int count_held_motions(const Model& model);

/// "2 parts; part 2: 3 grids, 2 elements, grids 4 to 6, touches nothing; its grid 4 lies on grid 3 of part 1" of the
/// parts that nothing holds, next to another part; empty if there is none.
struct LooseParts {
  std::string what, advice;
};
/// Describes at most five loose parts; without any ground the first part counts as the structure.
LooseParts describe_loose_parts(const Model& model);

}  // namespace bough::fe
