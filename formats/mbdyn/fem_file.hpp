#pragma once
/// \file The modal element's file of MBDyn (.fem): record groups in text (docs/formats/mbdyn.md).
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/records/flex_body.hpp"

namespace bough::mbdyn {

/// Nodes in the order of the file: the interface nodes first, as the unit loads of record group 19 count them.
std::vector<int> order_nodes(const records::FlexBody& body);

/// Record groups 1 to 10 and 12 to 19; the invariants of the set that the body names, every geometric stiffness that it
/// has. Warns "export.no-stiffening" (inertial loads without K_G) and "export.dropped-loads" (load patterns and unit
/// loads at nodes that are no interface: the format has no place for them). Throws InputError "export.no-integrals".
std::string make_fem(const records::FlexBody& body, const SourceLocation& where, Diagnostics& diagnostics);

}  // namespace bough::mbdyn
