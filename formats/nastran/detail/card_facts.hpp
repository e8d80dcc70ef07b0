#pragma once
/// \file Facts about the fields of a card, in whatever table its parser is.
#include <string>
#include <string_view>
#include <vector>

namespace bough::nastran::detail {

class UnitConverter;
struct UnitNotes;

/// The fields of a card: names, dimensions, entries on a line.
struct CardFacts {
  /// Dimension of each data field in order, a word each: "." none, "?" not known, so that the field must be blank,
  /// others as find_dimension knows them. "": no field has a dimension; nullptr: `convert` alone knows.
  const char* dimensions = nullptr;
  const char* names = nullptr;  ///< of the data fields in order, as in the Quick Reference Guide; "-": always blank
  int entry_size = 0;           ///< fields from one entry to the next, of cards with several entries on a line
  /// In place of `dimensions`: scales the fields of a card whose dimensions depend on other fields or cards.
  void (*convert)(UnitConverter&) = nullptr;
  /// Keeps what the dimensions of other cards depend on.
  void (*note)(const UnitConverter&, UnitNotes&) = nullptr;
};

/// The facts of a card (upper case) that is read in any analysis; nullptr for others.
const CardFacts* find_card_facts(std::string_view name);
/// The words of CardFacts::dimensions; empty for a card without.
const std::vector<std::string>& get_dimension_words(std::string_view upper_case_card);
/// Names of the fields in order; empty for a card without.
const std::vector<std::string>& get_field_names(std::string_view upper_case_card);
/// CardFacts::entry_size; 0 for a card without several entries.
int get_entry_size(std::string_view upper_case_card);

/// A dimension as exponents of mass, length and time.
struct Dimension {
  int mass = 0, length = 0, time = 0;
};
/// "L" length, "P" pressure, ...; nullptr for a word that no dimension has.
const Dimension* find_dimension(std::string_view word);

}  // namespace bough::nastran::detail
