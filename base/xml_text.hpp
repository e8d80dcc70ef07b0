#pragma once
/// \file Any bytes as text of an XML file.
#include <string>

namespace bough {

/// Signs that XML reads as its own are written as entities; control characters, which no XML file may hold, are left
/// out; bytes that are no UTF-8 become U+FFFD.
std::string escape_xml(const std::string& text);

}  // namespace bough
