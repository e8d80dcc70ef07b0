#pragma once
/// \file Cards of loads over frequency and time, read for responses alone: elsewhere they are named as not read.
#include <algorithm>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "formats/nastran/detail/card.hpp"
#include "formats/nastran/detail/card_facts.hpp"
#include "formats/records/deck_dynamics.hpp"

namespace bough::nastran::detail {

struct CardSink;
using DynamicParser = void (*)(Card&, records::DynamicCards&);
using DynamicWriter = void (*)(const records::DynamicCards&, CardSink&);

/// A row of their table.
struct DynamicRow : CardFacts {
  DynamicRow() = default;
  /// \param field_dimensions  CardFacts::dimensions; nullptr: converter does.
  DynamicRow(DynamicParser parser, const char* field_dimensions, void (*converter)(UnitConverter&) = nullptr,
             void (*noter)(const UnitConverter&, UnitNotes&) = nullptr)
      : parse(parser) {
    dimensions = field_dimensions;
    convert = converter;
    note = noter;
  }

  DynamicParser parse = nullptr;
  DynamicWriter write = nullptr;  ///< as CardRow::write, with write_order and written_as
  int write_order = 0;
  const char* written_as = nullptr;
};
using DynamicParserTable = std::unordered_map<std::string_view, DynamicRow>;

/// Cards of responses: those of add_dynamic_loads, add_dynamic_tables and add_dynamic_lists.
const DynamicParserTable& get_dynamic_parsers();
void add_dynamic_loads(DynamicParserTable& table);   ///< xLOADn, DLOAD, DAREA, DELAY, DPHASE, LSEQ, TIC
void add_dynamic_tables(DynamicParserTable& table);  ///< TABLEDn, TABDMP1, TABRND1, TABRNDG
void add_dynamic_lists(DynamicParserTable& table);   ///< FREQn, TSTEP, USET, RVDOF, RANDPS, RANDT1, RCROSS
/// Adds PELAST, PDAMPT and PBUSHT.
void add_frequency_table_parsers(DynamicParserTable& table);
/// Dimension of the values of a TABLEDi by the properties that name it; "." of loads, "?" if they differ.
std::string find_table_value(const UnitConverter& u);

/// EIGC, TF, EPOINT: cards of complex modes alone.
const DynamicParserTable& get_complex_parsers();

/// ROTORG, RSPINR, RGYRO, RSPEED, DDVAL, ROTORD, UNBALNC: cards of complex modes and of responses.
const DynamicParserTable& get_rotor_parsers();

/// The member of the case control that alone selects the sets of such cards; nullptr for other cards. What is wrong
/// with a set that no subcase selects is a warning.
int records::DynamicSelection::*find_selection_of(std::string_view card);

/// Appends the record of a card without errors. Reports deck.duplicate-id if another one has its id.
template <class Record>
void add_unique(Card& card, std::vector<Record>& all, Record record, int Record::*id) {
  if (!card.is_ok()) return;
  if (std::any_of(all.begin(), all.end(), [&](const auto& other) { return other.*id == record.*id; }))
    return card.fail("deck.duplicate-id", 0, "id " + std::to_string(record.*id) + " is used twice",
                     "give one of them another id");
  all.push_back(std::move(record));
}

}  // namespace bough::nastran::detail
