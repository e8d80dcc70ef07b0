#pragma once
/// \file Names of groups of element results.
#include <string>

namespace bough::records {

/// Card of a group of element results: "CQUAD4" of "CQUAD4-2", the second group with other components.
inline std::string get_card_of_group(const std::string& group) { return group.substr(0, group.find('-')); }

}  // namespace bough::records
