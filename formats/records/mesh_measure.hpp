#pragma once
/// \file Sizes of the elements of a mesh.
#include <unordered_map>

#include "formats/records/flex_body.hpp"

namespace bough::records {

/// Length, area or volume between the corners of an element, by its id; solids as tetrahedra, six a hexahedron.
/// Elements with a node that is no grid (index -1) have none, vertices zero.
std::unordered_map<int, double> calc_measures(const BodyMesh& mesh);

}  // namespace bough::records
