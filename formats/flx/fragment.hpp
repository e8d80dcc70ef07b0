#pragma once
/// \file Lines of problem.INT of TREETOPS for a .FLX with special nodes (NASA-CR-202063 4.1.3, 4.1.4).
#include <string>
#include <vector>

#include "formats/flx/flx_file.hpp"

namespace bough::flx {

/// A list to type into TREESET: the report names what is to be added, not the columns of .INT. For each body, in file
/// order: its nodes with their places, the special nodes at Bo, a jet along x at each of them, nine sensors at the
/// first (acceleration, rate and angular acceleration of the body, which make up A_I), one user controller between
/// them and what it computes. Numbers of jets, sensors and controllers count from `first_id` on, each kind for itself.
/// Throws InputError "flx.no-special-nodes" for a body without them.
std::string make_fragment(const std::vector<FlxFile>& bodies, int first_id);

}  // namespace bough::flx
