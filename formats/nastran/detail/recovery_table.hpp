#pragma once
/// \file DTI tables of the rows of recovery matrices.
#include <string_view>
#include <vector>

#include "formats/nastran/detail/card_sink.hpp"
#include "formats/records/deck_superelements.hpp"

namespace bough::nastran::detail {

/// Writes DTI `name` ("TUG1"): record 0 the sizes, 1 the columns, 2 the rows of each item, 3 the elements. A table
/// without a known header ("TQG1") has record 2 alone.
void write_recovery_rows(std::string_view name, const std::vector<records::RecoveryItem>& items, int num_columns,
                         CardSink& sink);

}  // namespace bough::nastran::detail
