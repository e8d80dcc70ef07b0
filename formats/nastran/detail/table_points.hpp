#pragma once
/// \file Tables of functions: pairs x y up to ENDT, and the kinds 1 to 4 of TABLEDi and TABLEMi.
#include <utility>
#include <vector>

#include "formats/nastran/detail/card.hpp"
#include "formats/records/function_table.hpp"

namespace bough::nastran::detail {

/// Reads the pairs from field `first` on, up to ENDT; ascending, unchanged or reversed.
std::vector<std::pair<double, double>> read_points(Card& card, int first);
/// Reports a jump at an end of the table: it goes on there along the line of its last two points.
void refuse_jumps_at_ends(Card& card, const std::vector<std::pair<double, double>>& points);
/// Reads XAXIS YAXIS, the field of the values beyond the ends, and the pairs from the second line on.
void read_axes(Card& card, records::FunctionTable& table, const char* beyond_name);
/// Reads TABLEDi or TABLEMi of a kind 1 to 4.
records::FunctionTable read_function_table(Card& card, int kind);

}  // namespace bough::nastran::detail
