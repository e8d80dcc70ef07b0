/// Materials over temperature: MATT1, MATT2, MATT8, MATT9, TABLEM1 to TABLEM4. Source of the fields: MSC Nastran Quick
/// Reference Guide, the entries named.
#include <algorithm>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "formats/nastran/detail/dynamic_cards.hpp"
#include "formats/nastran/detail/parsers.hpp"
#include "formats/nastran/detail/table_points.hpp"
#include "formats/nastran/detail/unit_converter.hpp"

namespace bough::nastran::detail {
namespace {

/// Fields of MATi with a table at the same field of MATTi, the id included, and their dimensions.
struct TableFields {
  const char* card;
  int count;
  const char* words;
};
constexpr TableFields kTableFields[] = {{"MATT1", 11, ". P P . R . . . P P P"},
                                        {"MATT2", 16, ". P P P P P P R . . . . . P P P"},
                                        {"MATT8", 18, ". P P . P P P R . . . P P P P P . 1/P2"},
                                        {"MATT9", 31, ". P P P P P P P P P P P P P P P P P P P P P R . . . . . . . ."}};

const TableFields& find_fields(const std::string& card) {
  return *std::find_if(std::begin(kTableFields), std::end(kTableFields), [&](const auto& f) { return card == f.card; });
}

/// MID, then a table for each field of the material.
void parse_tables(Card& card, Reading& r) {
  records::MaterialTables t;
  const auto& fields = find_fields(card.get_name());
  t.material = "MAT" + card.get_name().substr(4);
  t.mid = card.read_id(0, "MID");
  for (int i = 1; i < fields.count; ++i) t.tables.push_back(card.read_reference(i, "TID"));
  t.at = card.get_location();
  const int tref = t.material == "MAT1" ? 6 : t.material == "MAT2" ? 11 : t.material == "MAT8" ? 10 : 29;
  if (card.is_ok()) card.demand(t.tables[static_cast<std::size_t>(tref - 1)] == 0, tref, "TREF", "a blank");
  if (r.claim(card.get_name(), t.mid, card)) r.deck.temperatures.materials.push_back(std::move(t));
}

void parse_tablem(Card& card, Reading& r) {
  auto table = read_function_table(card, card.get_name().back() - '0');
  if (card.is_ok() && r.claim("TABLEM", table.id, card)) r.deck.temperatures.tables.push_back(std::move(table));
}

void write_tables(const records::Deck& deck, CardSink& sink) {
  for (const auto& t : deck.temperatures.materials) {
    CardFields card("MATT" + t.material.substr(3));
    card.add(t.mid);
    for (const int id : t.tables) card.add_id(id);
    sink.put(card);
  }
}

void write_tablems(const records::Deck& deck, CardSink& sink) {
  for (const auto& t : deck.temperatures.tables) put_function_table("TABLEM" + std::to_string(t.kind), t, sink);
}

std::vector<std::string> split_words(const char* text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

/// Dimensions of the tables; those of TABLEM2 to TABLEM4 are factors of the field.
void note_tables(const UnitConverter& u, UnitNotes& notes) {
  const auto words = split_words(find_fields(u.get_name()).words);
  for (int i = 1; i < std::min(u.size(), static_cast<int>(words.size())); ++i)
    if (!u.get(i).empty()) notes.table_values[u.get(i)].insert(words[static_cast<std::size_t>(i)]);
}

void convert_tablem1(UnitConverter& u) {
  const auto word = find_table_value(u);
  for (int i = 9; i < u.size(); i += 2) u.scale(i, word);
}

}  // namespace

void add_material_table_parsers(ParserTable& table) {
  table["MATT1"] = {parse_tables, "", "MID T(E) T(G) T(NU) T(RHO) T(A) - T(GE) T(ST) T(SC) T(SS)"};
  table["MATT2"] = {parse_tables, "",
                    "MID T(G11) T(G12) T(G13) T(G22) T(G23) T(G33) T(RHO) T(A1) T(A2) T(A3) - T(GE) T(ST) T(SC) T(SS)"};
  table["MATT8"] = {parse_tables, "",
                    "MID T(E1) T(E2) T(NU12) T(G12) T(G1Z) T(G2Z) T(RHO) T(A1) T(A2) - T(XT) T(XC) T(YT) T(YC) T(S) "
                    "T(GE) T(F12)"};
  table["MATT9"] = {parse_tables, ""};
  for (const char* card : {"MATT1", "MATT2", "MATT8", "MATT9"}) table[card].note = note_tables;
  table["TABLEM1"] = {parse_tablem, nullptr};
  table["TABLEM1"].convert = convert_tablem1;
  for (const char* card : {"TABLEM2", "TABLEM3", "TABLEM4"}) table[card] = {parse_tablem, ""};
  write_by(table, write_tables, {"MATT1", "MATT2", "MATT8", "MATT9"});
  write_by(table, write_tablems, {"TABLEM1", "TABLEM2", "TABLEM3", "TABLEM4"});
}

}  // namespace bough::nastran::detail
