#include "formats/nastran/detail/parsers.hpp"
#include "formats/nastran/detail/shared_fields.hpp"

namespace bough::nastran::detail {
namespace {

using records::Deck;
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

/// C ID1 ID2 ... or C ID1 THRU ID2, of which only the points that exist are meant.
void read_list(Card& card, Reading& r, std::vector<GridComponents>& terms) {
  read_components_of_ids(card, 0, "ID", [&](unsigned c, const auto& range) {
    if (range.is_thru)
      r.set_ranges.push_back({&terms, c, range, card.get_location()});
    else
      terms.push_back({range.first, c, card.get_location()});
  });
}

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
void write_aset(const Deck& deck, CardSink& sink) { write_lists("ASET1", deck.aset, sink); }
void write_omit(const Deck& deck, CardSink& sink) { write_lists("OMIT1", deck.omit, sink); }
void write_qset(const Deck& deck, CardSink& sink) { write_lists("QSET1", deck.qset, sink); }
void write_bset(const Deck& deck, CardSink& sink) { write_lists("BSET1", deck.bset, sink); }
void write_cset(const Deck& deck, CardSink& sink) { write_lists("CSET1", deck.cset, sink); }

template <auto set>
void parse_pairs(Card& card, Reading& r) {
  read_pairs(card, 0, r.deck.*set);
}
template <auto set>
void parse_list(Card& card, Reading& r) {
  read_list(card, r, r.deck.*set);
}
/// The card of pairs and the card of lists of one set; both are written as lists.
template <auto set>
void add_set(ParserTable& table, const char* pairs, const char* list, CardWriter write) {
  add_plain_cards(table, {{pairs, parse_pairs<set>}, {list, parse_list<set>}});
  write_by(table, write, {pairs, list});
}

}  // namespace

void add_dof_set_parsers(ParserTable& table) {
  add_plain_cards(table, {{"SUPORT", parse_suport}, {"SUPORT1", parse_suport1}});
  write_by(table, write_suport, {"SUPORT"});
  write_by(table, write_suport1, {"SUPORT1"});
  add_set<&Deck::aset>(table, "ASET", "ASET1", write_aset);
  add_set<&Deck::omit>(table, "OMIT", "OMIT1", write_omit);
  add_set<&Deck::qset>(table, "QSET", "QSET1", write_qset);
  add_set<&Deck::bset>(table, "BSET", "BSET1", write_bset);
  add_set<&Deck::cset>(table, "CSET", "CSET1", write_cset);
}

}  // namespace bough::nastran::detail
