/// Nonstructural mass by sets (NSM = n of the case control), and accelerations of grids as loads.
#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {
namespace {

using records::NonstructuralMass;

const std::vector<std::string> kTypes{"PSHELL", "PCOMP", "PCOMPG", "PBAR",   "PBARL", "PBEAM",  "PBEAML", "PBCOMP",
                                      "PROD",   "PTUBE", "PSHEAR", "CONROD", "PBEND", "PSOLID", "ELEMENT"};

/// NSM, NSML: SID TYPE ID VALUE ID VALUE ID VALUE.
void parse_pairs(Card& card, Reading& r) {
  NonstructuralMass m;
  m.sid = card.read_id(0, "SID");
  m.type = card.read_word(1, "TYPE", "", kTypes);
  m.is_total = card.get_name() == "NSML";
  m.at = card.get_location();
  for (int i = 2; i < card.get_size(); i += 2) {
    if (card.is_blank(i, i + 2)) continue;
    const int id = card.read_id(i, "ID");
    m.range = {{id, id}};
    m.value = card.read_real(i + 1, "VALUE");
    if (card.is_ok()) r.deck.special.nsm.push_back(m);
  }
}

/// NSM1, NSML1: SID TYPE VALUE, ids with THRU or ALL.
void parse_list(Card& card, Reading& r) {
  NonstructuralMass m;
  m.sid = card.read_id(0, "SID");
  m.type = card.read_word(1, "TYPE", "", kTypes);
  m.value = card.read_real(2, "VALUE");
  m.is_total = card.get_name() == "NSML1";
  m.at = card.get_location();
  m.is_all = card.is_word(3, "ALL");
  if (m.is_all) card.use(3);
  if (!m.is_all)
    for (const auto& range : read_id_list(card, 3, card.get_size(), "ID")) {
      if (range.step == 1 && range.except.empty())
        m.range.emplace_back(range.first, range.last);
      else
        for (int id = range.first; id <= range.last && card.is_ok(); id += range.step)
          if (range.contains(id)) m.range.emplace_back(id, id);
    }
  if (card.is_ok() && !m.is_all && m.range.empty())
    card.fail("deck.missing-field", 3, "no id is given, expected ids or ALL");
  if (card.is_ok()) r.deck.special.nsm.push_back(std::move(m));
}

void parse_nsmadd(Card& card, Reading& r) {
  const int sid = card.read_id(0, "SID");
  auto sets = read_ids(card, 1, card.get_size(), "S");
  if (card.is_ok()) r.deck.special.nsmadd.emplace_back(sid, std::move(sets));
}

/// SID CID A N1 N2 N3, from the second line on the grids.
void parse_accel1(Card& card, Reading& r) {
  records::GridAcceleration a;
  a.sid = card.read_id(0, "SID");
  a.cid = card.read_reference(1, "CID");
  a.a = card.read_real(2, "A", 0.0);
  a.n = card.read_vector(3, "N1 N2 N3");
  a.at = card.get_location();
  a.is_all = card.is_word(8, "ALL");
  if (a.is_all) card.use(8);
  if (!a.is_all)
    for (const auto& range : read_id_list(card, 8, card.get_size(), "GRID")) {
      a.skip_if_missing = a.skip_if_missing || range.is_thru;
      for (int id = range.first; id <= range.last && card.is_ok(); id += range.step)
        if (range.contains(id)) a.grids.push_back(id);
    }
  if (card.is_ok() && !a.is_all && a.grids.empty()) card.fail("deck.missing-field", 8, "no grid is given");
  if (card.is_ok() && a.a != 0 && a.n.isZero(0.0))
    card.fail("deck.field-range", 3, "N1 N2 N3 are all zero", "give the direction");
  if (card.is_ok()) r.deck.special.accelerations.push_back(std::move(a));
}

/// SID CID N1 N2 N3 DIR, from the second line on LOC VAL pairs.
void parse_accel(Card& card, Reading& r) {
  records::GridAcceleration a;
  a.sid = card.read_id(0, "SID");
  a.cid = card.read_reference(1, "CID");
  a.n = card.read_vector(2, "N1 N2 N3");
  const std::string direction = card.read_word(5, "DIR", "X", {"X", "Y", "Z"});
  a.direction = direction.empty() ? 0 : direction[0] - 'X';
  a.at = card.get_location();
  for (int i = 8; i < card.get_size(); i += 2) {
    if (card.is_blank(i, i + 2)) continue;
    const double place = card.read_real(i, "LOC");
    a.table.emplace_back(place, card.read_real(i + 1, "VAL"));
    if (card.is_ok() && a.table.size() > 1 && !(place > a.table[a.table.size() - 2].first))
      card.fail("deck.field-range", i, "LOC is not above the one before", "give the places in ascending order");
  }
  if (card.is_ok() && a.table.size() < 2)
    card.fail("deck.missing-field", 8, "fewer than two places with values are given");
  if (card.is_ok() && a.n.isZero(0.0)) card.fail("deck.field-range", 2, "N1 N2 N3 are all zero", "give the direction");
  if (card.is_ok()) r.deck.special.accelerations.push_back(std::move(a));
}

}  // namespace

void add_nonstructural_parsers(ParserTable& table) {
  table["NSM"] = table["NSML"] = parse_pairs;
  table["NSM1"] = table["NSML1"] = parse_list;
  table["NSMADD"] = {parse_nsmadd, ""};
  table["ACCEL1"] = {parse_accel1, ". . G . . ."};
  table["ACCEL"] = parse_accel;
}

}  // namespace bough::nastran::detail
