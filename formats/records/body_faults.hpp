#pragma once
/// \file Numbers of a flexible body that no structure has: its file was edited by hand, or made by another program.
#include <string>
#include <vector>

#include "formats/records/flex_body.hpp"

namespace bough::records {

/// Describes interface nodes, locators, grids of elements and a method of integrals that the body does not have, by the
/// paths of the HDF5 and flat files. Any shapes will do.
std::vector<std::string> find_unknown_names(const FlexBody& body);

/// Describes each fault: no integrals of the method; a node listed twice; a negative mass, or none below a nonzero
/// gamma0; negative moments of inertia; modal matrices that are not symmetric; negative modal masses.
/// \pre the arrays have the shapes of flex_body.hpp, and find_unknown_names finds none.
std::vector<std::string> find_body_faults(const FlexBody& body);

}  // namespace bough::records
