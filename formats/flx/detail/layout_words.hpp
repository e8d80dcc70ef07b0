#pragma once
/// \file Names and words of a layout (docs/formats/flx.md).
#include "formats/flx/layout.hpp"

namespace bough::flx::detail {

/// A field of a text and the index that it needs.
const std::vector<BlockInfo>& get_fields();

/// The entry of that name; null when there is none.
const BlockInfo* find(const std::vector<BlockInfo>& list, const std::string& name);

/// Words of a line up to a remark; "..." keeps blanks, \" \\ and \n inside it. False when a quote is not closed.
bool split(const std::string& line, std::vector<std::string>& words);

}  // namespace bough::flx::detail
