#pragma once
/// \file Names of the fields of common cards, as in the Quick Reference Guide.
#include <string>
#include <string_view>
#include <vector>

namespace bough::nastran::detail {

/// Names in order, "-" for a field that is always blank; empty for a card that is not listed.
const std::vector<std::string>& get_field_names(std::string_view upper_case_card);

/// Fields from one entry of a card to the next where a line holds several entries (PELAS: 4); 0 for all other cards.
int get_entry_size(std::string_view upper_case_card);

}  // namespace bough::nastran::detail
