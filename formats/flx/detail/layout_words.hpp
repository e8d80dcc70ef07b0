#pragma once
/// \file Names and words of a layout (docs/formats/flx.md).
#include <algorithm>

#include "formats/flx/layout.hpp"

namespace bough::flx::detail {

/// A field of a text and the index that it needs; numbers take a format, texts do not.
struct FieldInfo {
  std::string name, indices;
  bool is_text = false;
};
/// Returns all fields that a text of a layout may name.
const std::vector<FieldInfo>& get_fields();

/// The entry of that name; null when there is none.
template <class Info>
const Info* find(const std::vector<Info>& list, const std::string& name) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const Info& info) { return info.name == name; });
  return found == list.end() ? nullptr : &*found;
}

/// Words of a line up to a remark; "..." keeps blanks, \" \\ and \n inside it. False when a quote is not closed.
bool split(const std::string& line, std::vector<std::string>& words);

}  // namespace bough::flx::detail
