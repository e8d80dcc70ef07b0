/// Rigid elements that are converted to other ones (RBAR1, RJOINT, RTRPLT, ...), and RSPLINE.
#include <bit>

#include "formats/nastran/detail/parsers.hpp"
#include "formats/nastran/detail/rigid_expansion.hpp"

namespace bough::nastran::detail {
namespace {

constexpr unsigned kAll = 63;

/// RBAR1: EID GA GB CB ALPHA; RJOINT: EID GA GB CB. The components CB of GB follow all six of GA, as in an RBE2.
void parse_one_follower(Card& card, Reading& r) {
  records::Rbe2 e;
  e.id = card.read_id(0, "EID");
  e.gn = card.read_id(1, "GA");
  e.gm = {card.read_id(2, "GB")};
  e.cm = card.read_components(3, "CB", kAll);
  if (card.get_name() == "RBAR1") {
    note_expansion(card, r, card.read_real(4, "ALPHA", 0.0));
    card.use(5);  // TREF
  }
  e.at = card.get_location();
  if (r.claim_rigid(e.id, card)) r.deck.rbe2.push_back(std::move(e));
}

void claim_plate(Card& card, Reading& r, records::Rbe1 e) {
  int count = 0;
  for (const auto& term : e.independent) count += std::popcount(term.c);
  if (card.is_ok() && count != 6)
    card.fail("deck.field-range", 4, "CN has " + std::to_string(count) + " components, expected six in all",
              "choose six that hold a rigid body");
  std::erase_if(e.independent, [](const auto& term) { return term.c == 0; });
  std::erase_if(e.dependent, [](const auto& term) { return term.c == 0; });
  if (r.claim_rigid(e.id, card)) r.deck.rbe1.push_back(std::move(e));
}

/// RTRPLT: EID GA GB GC CNA CNB CNC, CMA CMB CMC ALPHA: an RBE1 on three grids. Blank CM: all that is not independent.
void parse_rtrplt(Card& card, Reading& r) {
  records::Rbe1 e;
  e.id = card.read_id(0, "EID");
  e.at = card.get_location();
  const bool has_dependent = !card.is_blank(8, 11);
  for (int k = 0; k < 3; ++k) {
    const int g = card.read_id(1 + k, "G");
    const unsigned cn = card.read_components(4 + k, "CN", 0);
    e.independent.push_back({g, cn, e.at});
    e.dependent.push_back({g, has_dependent ? card.read_components(8 + k, "CM", 0) : kAll & ~cn, e.at});
  }
  note_expansion(card, r, card.read_real(11, "ALPHA", 0.0));
  card.use(12);  // TREF
  claim_plate(card, r, std::move(e));
}

/// RTRPLT1: EID GA GB GC CMB CMC ALPHA: GA is independent.
void parse_rtrplt1(Card& card, Reading& r) {
  records::Rbe1 e;
  e.id = card.read_id(0, "EID");
  e.at = card.get_location();
  e.independent.push_back({card.read_id(1, "GA"), kAll, e.at});
  for (int k = 0; k < 2; ++k)
    e.dependent.push_back({card.read_id(2 + k, "G"), card.read_components(4 + k, "CM", kAll), e.at});
  note_expansion(card, r, card.read_real(6, "ALPHA", 0.0));
  card.use(7, 9);  // TREF
  claim_plate(card, r, std::move(e));
}

/// EID D/L G1 G2 C2 G3 C3 ...: a grid with components depends on the spline, one without holds it.
void parse_rspline(Card& card, Reading& r) {
  records::Rspline e;
  e.id = card.read_id(0, "EID");
  e.ratio = card.read_real(1, "D/L", 0.1);
  e.points.push_back({card.read_id(2, "G1"), 0});
  for (int i = 3; i < card.get_size(); i += 2) {
    const int g = card.read_id(i, "G");
    e.points.push_back({g, card.read_components(i + 1, "C", 0)});
  }
  e.at = card.get_location();
  card.demand(e.ratio > 0, 1, "D/L", "a positive ratio");
  if (card.is_ok() && (e.points.size() < 2 || e.points.back().c != 0))
    card.fail("deck.field-range", 3, "the spline ends at a dependent grid",
              "its first and last grids are independent: leave their components blank");
  if (r.claim_rigid(e.id, card)) r.deck.special.rspline.push_back(std::move(e));
}

void write_rspline(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.special.rspline) {
    CardFields card("RSPLINE");
    card.add(e.id).add(e.ratio).add(e.points.front().g);
    for (std::size_t i = 1; i < e.points.size(); ++i) card.add(e.points[i].g).add_components(e.points[i].c);
    sink.put(card);
  }
}

}  // namespace

void add_special_constraint_parsers(ParserTable& table) {
  // CRTRPLT and CRSPLINE: the names of NASTRAN-95, with the same fields.
  add_plain_cards(table, {{"RBAR1", parse_one_follower},
                          {"RJOINT", parse_one_follower},
                          {"RTRPLT", parse_rtrplt},
                          {"RTRPLT1", parse_rtrplt1},
                          {"RSPLINE", parse_rspline},
                          {"CRTRPLT", parse_rtrplt},
                          {"CRSPLINE", parse_rspline}});
  write_by(table, write_rspline, {"RSPLINE"});
  write_as(table, "RSPLINE", {"CRSPLINE"});
  write_as(table, "RBE2", {"RBAR1", "RJOINT"});
  write_as(table, "RBE1", {"RTRPLT", "RTRPLT1", "CRTRPLT"});
}

}  // namespace bough::nastran::detail
