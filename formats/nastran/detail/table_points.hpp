#pragma once
/// \file Tables of functions: pairs x y up to ENDT, and the kinds 1 to 4 of TABLEDi and TABLEMi.
#include <utility>
#include <vector>

#include "formats/nastran/detail/card.hpp"
#include "formats/nastran/detail/card_sink.hpp"
#include "formats/nastran/detail/field_list.hpp"
#include "formats/records/function_table.hpp"

namespace bough::nastran::detail {

/// Reads the pairs from field `first` on, up to ENDT; ascending, unchanged or reversed.
std::vector<std::pair<double, double>> read_points(Card& card, int first);
/// Reports a jump at an end of the table: it goes on there along the line of its last two points.
void refuse_jumps_at_ends(Card& card, const std::vector<std::pair<double, double>>& points);
/// Fields TID XAXIS YAXIS and how the table continues beyond its ends.
void list_axes(FieldList& fields, records::FunctionTable& table, const char* beyond_name);
/// Fields of the first line of TABLEDi and TABLEMi; the kind is that of the table.
void list_function_table(FieldList& fields, records::FunctionTable& table);
/// Reads the pairs from the second line on, of a table whose axes are read.
void read_axis_points(Card& card, records::FunctionTable& table);
/// Reads TABLEDi or TABLEMi of a kind 1 to 4.
records::FunctionTable read_function_table(Card& card, int kind);
/// Writes the first line, the pairs from the second line on, and ENDT.
void put_points(CardFields card, const std::vector<std::pair<double, double>>& points, CardSink& sink);
/// Writes a TABLEDi or TABLEMi of that name.
void put_function_table(const std::string& name, const records::FunctionTable& table, CardSink& sink);

}  // namespace bough::nastran::detail
