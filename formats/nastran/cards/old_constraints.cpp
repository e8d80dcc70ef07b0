#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {
namespace {

/// CRIGD1 of NASTRAN-95: EID IG, grids that move with IG in all six components. It becomes an RBE2.
void parse_crigd1(Card& card, Reading& r) {
  records::Rbe2 e;
  e.id = card.read_id(0, "EID");
  e.gn = card.read_id(1, "IG");
  e.cm = 0b111111;
  add_rbe2(card, r, std::move(e), 2, card.get_size(), "G", "G1");
}

/// CRIGD2: EID IG, pairs of a grid and its dependent components. It becomes an RBE1.
void parse_crigd2(Card& card, Reading& r) {
  records::Rbe1 e;
  e.id = card.read_id(0, "EID");
  e.at = card.get_location();
  e.independent.push_back({card.read_id(1, "IG"), 0b111111, e.at});
  for (int i = 2; i < card.get_size(); i += 2)
    if (!card.is_blank(i, i + 2))
      e.dependent.push_back({card.read_id(i, "Gi"), card.read_components(i + 1, "Ci"), e.at});
  if (e.dependent.empty() && card.is_ok())
    card.fail("deck.missing-field", 2, "G1 is blank, expected a dependent grid at least");
  if (r.claim_rigid(e.id, card)) r.deck.rbe1.push_back(std::move(e));
}

/// CRIGDR: EID IG G C, one or two on a card: a rigid rod whose translation C at G depends.
void parse_crigdr(Card& card, Reading& r) {
  read_entries(card, 4, {0, 4}, [&](int first) {
    records::Rrod e;
    card.read_ids(first, {{"EID", e.id}, {"IG", e.ga}, {"G", e.gb}});
    e.cmb = card.read_component(first + 3, "C");
    card.demand(e.cmb >= 1 && e.cmb <= 3, first + 3, "C", "a translation 1, 2 or 3");
    e.at = card.get_location();
    if (r.claim_rigid(e.id, card, first, 4)) r.deck.rrod.push_back(e);
  });
}

}  // namespace

void add_old_constraint_parsers(ParserTable& table) {
  table["CRIGD1"] = {parse_crigd1, ""};
  table["CRIGD2"] = {parse_crigd2, ""};
  table["CRIGDR"] = {parse_crigdr, ""};
  write_as(table, "RBE2", {"CRIGD1"});
  write_as(table, "RBE1", {"CRIGD2"});
  write_as(table, "RROD", {"CRIGDR"});
}

}  // namespace bough::nastran::detail
