#pragma once
/// \file Special nodes of a .FLX (NASA-CR-202063 4.1.3): nodes at Bo that modes alone move, no points of the body.
#include "formats/records/flex_body.hpp"

namespace bough::records {

/// Returns true if output node k (from 0) is a special node: no element is drawn, and the mesh lists the points of the
/// body without it.
bool is_special_node(const FlexBody& body, int k);

}  // namespace bough::records
