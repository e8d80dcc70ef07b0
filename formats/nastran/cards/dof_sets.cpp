#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {
namespace {

using records::GridComponents;

/// Pairs ID C from field `first` of the only line on; C is blank or 0 for a scalar point.
void read_pairs(Card& card, int first, std::vector<GridComponents>& terms) {
  std::vector<GridComponents> read;
  int i = first;
  for (; i + 1 < 8; i += 2) {
    if (card.is_blank(i, i + 2)) continue;
    const int g = card.read_id(i, "ID");
    read.push_back({g, card.read_components(i + 1, "C", 0), card.get_location()});
  }
  if (card.get_size() > i)
    card.fail("deck.too-many-fields", i, "data after the last pair of ID and C", "begin another card");
  if (read.empty() && card.is_ok()) card.fail("deck.missing-field", first, "ID is blank, expected a grid at least");
  if (card.is_ok()) terms.insert(terms.end(), read.begin(), read.end());
}

void parse_suport(Card& card, Reading& r) { read_pairs(card, 0, r.deck.suport); }
void parse_suport1(Card& card, Reading& r) {
  const int sid = card.read_id(0, "SID");
  read_pairs(card, 1, r.deck.suport1[sid]);
}
void parse_aset(Card& card, Reading& r) { read_pairs(card, 0, r.deck.aset); }
void parse_omit(Card& card, Reading& r) { read_pairs(card, 0, r.deck.omit); }

void parse_qset(Card& card, Reading& r) { read_pairs(card, 0, r.deck.qset); }
void parse_bset(Card& card, Reading& r) { read_pairs(card, 0, r.deck.bset); }
void parse_cset(Card& card, Reading& r) { read_pairs(card, 0, r.deck.cset); }

/// C ID1 ID2 ... or C ID1 THRU ID2, of which only the points that exist are meant.
void read_list(Card& card, Reading& r, std::vector<GridComponents>& terms) {
  const unsigned c = card.read_components(0, "C", 0);
  const auto list = read_id_list(card, 1, card.get_size(), "ID");
  if (list.empty() && card.is_ok()) card.fail("deck.missing-field", 1, "ID is blank, expected a grid at least");
  if (!card.is_ok()) return;
  for (const auto& range : list) {
    if (range.is_thru)
      r.set_ranges.push_back({&terms, c, range, card.get_location()});
    else
      terms.push_back({range.first, c, card.get_location()});
  }
}
void parse_aset1(Card& card, Reading& r) { read_list(card, r, r.deck.aset); }
void parse_omit1(Card& card, Reading& r) { read_list(card, r, r.deck.omit); }
void parse_qset1(Card& card, Reading& r) { read_list(card, r, r.deck.qset); }
void parse_bset1(Card& card, Reading& r) { read_list(card, r, r.deck.bset); }
void parse_cset1(Card& card, Reading& r) { read_list(card, r, r.deck.cset); }

/// One card for each run of ids with the same components: C ID1 ID2 ...
void write_lists(const char* name, const std::vector<records::GridComponents>& terms, CardSink& sink) {
  for (std::size_t i = 0; i < terms.size();) {
    CardFields card(name);
    const unsigned c = terms[i].c;
    card.add_components(c);
    for (; i < terms.size() && terms[i].c == c; ++i) card.add(terms[i].g);
    sink.put(card);
  }
}

/// Pairs, as many as one line holds after `head`.
void write_pairs(const CardFields& head, std::size_t per_card, const std::vector<records::GridComponents>& terms,
                 CardSink& sink) {
  for (std::size_t i = 0; i < terms.size();) {
    CardFields card = head;
    for (std::size_t end = i + per_card; i < end && i < terms.size(); ++i)
      card.add(terms[i].g).add_components(terms[i].c);
    sink.put(card);
  }
}

void write_suport(const records::Deck& deck, CardSink& sink) {
  write_pairs(CardFields("SUPORT"), 4, deck.suport, sink);
}
void write_suport1(const records::Deck& deck, CardSink& sink) {
  for (const auto& [sid, terms] : deck.suport1) {
    CardFields head("SUPORT1");
    write_pairs(head.add(sid), 3, terms, sink);
  }
}

void write_aset(const records::Deck& deck, CardSink& sink) { write_lists("ASET1", deck.aset, sink); }
void write_omit(const records::Deck& deck, CardSink& sink) { write_lists("OMIT1", deck.omit, sink); }
void write_qset(const records::Deck& deck, CardSink& sink) { write_lists("QSET1", deck.qset, sink); }
void write_bset(const records::Deck& deck, CardSink& sink) { write_lists("BSET1", deck.bset, sink); }
void write_cset(const records::Deck& deck, CardSink& sink) { write_lists("CSET1", deck.cset, sink); }

}  // namespace

void add_dof_set_parsers(ParserTable& table) {
  add_plain_cards(table, {{"SUPORT", parse_suport},
                          {"SUPORT1", parse_suport1},
                          {"ASET", parse_aset},
                          {"ASET1", parse_aset1},
                          {"OMIT", parse_omit},
                          {"OMIT1", parse_omit1},
                          {"QSET", parse_qset},
                          {"QSET1", parse_qset1},
                          {"BSET", parse_bset},
                          {"BSET1", parse_bset1},
                          {"CSET", parse_cset},
                          {"CSET1", parse_cset1}});
  write_by(table, write_suport, {"SUPORT"});
  write_by(table, write_suport1, {"SUPORT1"});
  write_by(table, write_aset, {"ASET", "ASET1"});
  write_by(table, write_omit, {"OMIT", "OMIT1"});
  write_by(table, write_qset, {"QSET", "QSET1"});
  write_by(table, write_bset, {"BSET", "BSET1"});
  write_by(table, write_cset, {"CSET", "CSET1"});
}

}  // namespace bough::nastran::detail
