#pragma once
/// \file Dimensions of the fields of cards, for the conversion of units.
#include <string>
#include <string_view>
#include <vector>

namespace bough::nastran::detail {

/// A dimension as exponents of mass, length and time.
struct Dimension {
  int mass = 0, length = 0, time = 0;
};

/// The data fields of a card in order, a word each: "." has no dimension, the others are as get_dimension knows them,
/// "?" must be blank since nothing tells its dimension. nullptr: the card is not in the table.
const std::vector<std::string>* find_field_words(std::string_view card);
/// "L" length, "P" pressure, ...
Dimension get_dimension(std::string_view word);
/// Number of DIM fields of a PBARL or PBEAML section; 0 for one that is not known.
int get_num_section_dims(std::string_view type);

}  // namespace bough::nastran::detail
