#pragma once
/// \file Special nodes of a .FLX as nodes of a flexible body that moves.
#include "formats/flx/flx_file.hpp"

namespace bough::flx {

/// Appends the special nodes of `file` to the output nodes of the body that make_flex_body made of it.
void add_special_nodes(const FlxFile& file, records::FlexBody& body);

}  // namespace bough::flx
