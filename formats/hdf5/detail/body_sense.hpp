#pragma once
/// \file Numbers of a flexible-body file that no body has: it was edited by hand, or made by another program.
#include "formats/hdf5/detail/reader.hpp"

namespace bough::hdf5 {

/// Reports "hdf5.value": a node listed twice, a negative mass or none below Γ0, negative moments of inertia, modal
/// matrices that are not symmetric, modal masses that are negative. `body` has all its modal matrices.
void check_sense(FileReader& file, const records::FlexBody& body);

}  // namespace bough::hdf5
