/// Properties over frequency: PELAST, PDAMPT, PBUSHT. Source of the fields: MSC Nastran Quick Reference Guide, the
/// entries named.
#include <algorithm>
#include <cmath>
#include <set>

#include "formats/nastran/detail/card_sink.hpp"
#include "formats/nastran/detail/dynamic_cards.hpp"
#include "formats/nastran/detail/unit_converter.hpp"
#include "formats/nastran/detail/write_order.hpp"

namespace bough::nastran::detail {
namespace {

using records::DynamicCards;
using records::FrequencyTables;

constexpr double kEqualFactors = 1e-14;  ///< relative difference

FrequencyTables read_head(Card& card, const char* property) {
  FrequencyTables t;
  t.property = property;
  t.pid = card.read_id(0, "PID");
  t.at = card.get_location();
  return t;
}

void add_tables(Card& card, DynamicCards& r, FrequencyTables tables) {
  if (!card.is_ok()) return;
  for (const auto& other : r.frequency_tables)
    if (other.property == tables.property && other.pid == tables.pid)
      return card.fail("deck.duplicate-id", 0, "id " + std::to_string(tables.pid) + " is used twice",
                       "give one of them another id");
  r.frequency_tables.push_back(std::move(tables));
}

/// PID TKID TGEID TKNID; the last one is of nonlinear solutions.
void parse_pelast(Card& card, DynamicCards& r) {
  auto t = read_head(card, "PELAS");
  t.k[0] = card.read_reference(1, "TKID");
  t.ge[0] = card.read_reference(2, "TGEID");
  card.read_reference(3, "TKNID");
  add_tables(card, r, std::move(t));
}

/// PID TBID1 TBID2; the last one is of nonlinear solutions.
void parse_pdampt(Card& card, DynamicCards& r) {
  auto t = read_head(card, "PDAMP");
  t.b[0] = card.read_reference(1, "TBID1");
  card.read_reference(2, "TBID2");
  add_tables(card, r, std::move(t));
}

/// PID, then on each line a flag K, B, GE or KN and six tables; KN is of nonlinear solutions.
void parse_pbusht(Card& card, DynamicCards& r) {
  auto t = read_head(card, "PBUSH");
  for (int line = 0; line < card.get_size(); line += 8) {
    if (line > 0) card.demand(card.is_blank(line), line, "the field before the flag", "a blank");
    if (card.is_blank(line + 1)) {
      if (!card.is_blank(line + 2, line + 8))
        card.fail("deck.missing-field", line + 1, "tables without a flag K, B, GE or KN");
      continue;
    }
    const auto flag = card.read_word(line + 1, "flag", "", {"K", "B", "GE", "KN"});
    std::array<int, 6> ids{};
    for (int c = 0; c < 6; ++c) ids[static_cast<std::size_t>(c)] = card.read_reference(line + 2 + c, "TID");
    if (flag == "K") t.k = ids;
    if (flag == "B") t.b = ids;
    if (flag == "GE") {
      t.ge = ids;
      if (card.is_blank(line + 3, line + 8)) t.ge.fill(ids[0]);
    }
  }
  add_tables(card, r, std::move(t));
}

void write_frequency_tables(const DynamicCards& cards, CardSink& sink) {
  for (const auto& t : cards.frequency_tables) {
    CardFields card(t.property + "T");
    card.add(t.pid);
    if (t.property == "PELAS") card.add_id(t.k[0]).add_id(t.ge[0]);
    if (t.property == "PDAMP") card.add_id(t.b[0]);
    bool is_first = true;
    const auto add_line = [&](const char* flag, const std::array<int, 6>& ids) {
      if (t.property != "PBUSH" || std::all_of(ids.begin(), ids.end(), [](int id) { return id == 0; })) return;
      if (!is_first) card.add_blank(1);
      is_first = false;
      card.add_word(flag);
      for (const int id : ids) card.add_id(id);
    };
    add_line("K", t.k);
    add_line("B", t.b);
    add_line("GE", t.ge);
    sink.put(card);
  }
}

// Conversion of units: the ids have no dimension, the tables that they name have.

/// \param word  dimension of y
void note_table(UnitNotes& notes, const std::string& tid, const char* word) {
  if (tid.empty()) return;
  notes.table_axes[tid].insert("Hz");
  notes.table_values[tid].insert(word);
}
const char* choose_word(Motion motion, const char* translation, const char* rotation) {
  return motion == Motion::Translation ? translation : motion == Motion::Rotation ? rotation : "?";
}
/// The table of field 1; its dimension is that of the elements of the property, which may be on later cards.
void note_scalar_table(const UnitConverter& u, UnitNotes& notes, const char* element) {
  if (u.get(1).empty()) return;
  notes.table_axes[u.get(1)].insert("Hz");
  notes.spring_tables.emplace_back(element, u.get(0), u.get(1));
}
void note_pelast(const UnitConverter& u, UnitNotes& notes) {
  note_scalar_table(u, notes, "CELAS");
  note_table(notes, u.get(2), ".");
}
void note_pdampt(const UnitConverter& u, UnitNotes& notes) { note_scalar_table(u, notes, "CDAMP"); }
void note_pbusht(const UnitConverter& u, UnitNotes& notes) {
  for (int line = 0; line < u.size(); line += 8) {
    const auto flag = make_upper(u.get(line + 1));
    for (int c = 0; c < 6; ++c)
      if (flag == "K")
        note_table(notes, u.get(line + 2 + c), c < 3 ? "K" : "Q");
      else if (flag == "B")
        note_table(notes, u.get(line + 2 + c), c < 3 ? "B" : "BR");
      else if (flag == "GE")
        note_table(notes, u.get(line + 2 + c), ".");
  }
}

}  // namespace

std::string find_table_value(const UnitConverter& u) {
  auto words = std::set<std::string>();
  const auto& notes = u.get_notes();
  if (const auto found = notes.table_values.find(u.get(0)); found != notes.table_values.end()) words = found->second;
  for (const auto& [element, pid, tid] : notes.spring_tables)
    if (tid == u.get(0)) {
      const bool is_spring = element == "CELAS";
      words.insert(choose_word(u.find_property_motion(element, pid), is_spring ? "K" : "B", is_spring ? "Q" : "BR"));
    }
  if (words.empty()) return ".";
  if (words.size() == 1 || words.count("?") > 0) return words.size() == 1 ? *words.begin() : "?";
  const double factor = u.calc_factor(*words.begin());
  const auto is_equal = [&](const auto& word) { return std::abs(u.calc_factor(word) / factor - 1) < kEqualFactors; };
  return std::all_of(words.begin(), words.end(), is_equal) ? *words.begin() : "??";
}

void add_frequency_table_parsers(DynamicParserTable& table) {
  table["PELAST"] = {parse_pelast, "", nullptr, note_pelast};
  table["PDAMPT"] = {parse_pdampt, "", nullptr, note_pdampt};
  table["PBUSHT"] = {parse_pbusht, "", nullptr, note_pbusht};
  set_writer(table, write_frequency_tables, {"PELAST", "PDAMPT", "PBUSHT"});
}

}  // namespace bough::nastran::detail
