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

}  // namespace

void add_dof_set_parsers(ParserTable& table) {
  table["SUPORT"] = {parse_suport, ""};
  table["SUPORT1"] = {parse_suport1, ""};
  table["ASET"] = {parse_aset, ""};
  table["ASET1"] = {parse_aset1, ""};
  table["OMIT"] = {parse_omit, ""};
  table["OMIT1"] = {parse_omit1, ""};
  table["QSET"] = {parse_qset, ""};
  table["QSET1"] = {parse_qset1, ""};
  table["BSET"] = {parse_bset, ""};
  table["BSET1"] = {parse_bset1, ""};
  table["CSET"] = {parse_cset, ""};
  table["CSET1"] = {parse_cset1, ""};
}

}  // namespace bough::nastran::detail
