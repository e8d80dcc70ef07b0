/// Nonstructural mass by sets (NSM = n of the case control), and accelerations of grids as loads.
#include <set>

#include "formats/nastran/detail/parsers.hpp"
#include "formats/nastran/detail/shared_fields.hpp"

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
  read_acceleration(card, a);
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

void write_nsm(const records::NonstructuralMass& m, CardSink& sink) {
  CardFields card(m.is_total ? "NSML1" : "NSM1");
  card.add(m.sid).add_word(m.type).add(m.value);
  if (m.is_all) card.add_word("ALL");
  // A card each: a range stands alone on its card.
  if (m.is_all) return sink.put(card);
  for (const auto& [first, last] : m.range) {
    card.add(first);
    if (last > first) card.add_word("THRU").add(last);
  }
  sink.put(card);
}

void write_acceleration(const records::GridAcceleration& a, CardSink& sink) {
  CardFields card(a.direction < 0 ? "ACCEL1" : "ACCEL");
  card.add(a.sid).add_id(a.cid);
  if (a.direction >= 0) {
    card.add(a.n).add_word(std::string(1, static_cast<char>('X' + a.direction))).end_line();
    for (const auto& [place, value] : a.table) card.add(place).add(value);
    return sink.put(card);
  }
  card.add(a.a).add(a.n).end_line();
  if (a.is_all) card.add_word("ALL");
  for (std::size_t i = 0; i < a.grids.size(); ++i) {
    std::size_t last = i;
    while (a.skip_if_missing && last + 1 < a.grids.size() && a.grids[last + 1] == a.grids[last] + 1) ++last;
    card.add(a.grids[i]);
    if (last > i) card.add_word("THRU").add(a.grids[last]);
    i = last;
  }
  sink.put(card);
}

void write_nsms(const records::Deck& deck, CardSink& sink) {
  for (const auto& m : deck.special.nsm) write_nsm(m, sink);
}

void write_nsmadd(const records::Deck& deck, CardSink& sink) {
  for (const auto& [sid, sets] : deck.special.nsmadd) {
    CardFields card("NSMADD");
    card.add(sid);
    for (const int set : sets) card.add(set);
    sink.put(card);
  }
}

void write_accelerations(const records::Deck& deck, CardSink& sink) {
  for (const auto& a : deck.special.accelerations) write_acceleration(a, sink);
}

/// NSM: pairs of id and value; NSM1: one value. NSML and NSML1: the whole mass.
void convert_nsm(UnitConverter& u) {
  static const std::set<std::string> areas{"PSHELL", "PCOMP", "PCOMPG", "PSHEAR", "PRAC2D"};
  static const std::set<std::string> lines{"PBAR",  "PBARL", "PBEAM",  "PBEAML", "PBCOMP",
                                           "PBEND", "PROD",  "CONROD", "PTUBE"};
  const auto& name = u.get_name();
  const auto type = make_upper(u.get(1));
  const bool is_whole = name.starts_with("NSML");
  const char* word = is_whole ? "M" : areas.count(type) > 0 ? "S" : lines.count(type) > 0 ? "N" : "?";
  if (name.ends_with('1')) return u.scale(2, word);
  for (int i = 3; i < u.size(); i += 2) u.scale(i, word);
}

void convert_accel(UnitConverter& u) {
  for (int i = 8; i < u.size(); i += 2) {
    u.scale(i, "L");
    u.scale(i + 1, "G");
  }
}

}  // namespace

void add_nonstructural_parsers(ParserTable& table) {
  table["NSM"] = table["NSML"] = {parse_pairs, nullptr};
  table["NSM1"] = table["NSML1"] = {parse_list, nullptr};
  table["NSMADD"] = {parse_nsmadd, ""};
  for (const char* name : {"NSM", "NSML", "NSM1", "NSML1"}) table[name].convert = convert_nsm;
  write_by(table, write_nsms, {"NSM1", "NSML1"});
  write_as(table, "NSM1", {"NSM"});
  write_as(table, "NSML1", {"NSML"});
  write_by(table, write_nsmadd, {"NSMADD"});
}

void add_acceleration_parsers(ParserTable& table) {
  table["ACCEL1"] = {parse_accel1, ". . G . . ."};
  table["ACCEL"] = {parse_accel, nullptr};
  table["ACCEL"].convert = convert_accel;
  write_by(table, write_accelerations, {"ACCEL", "ACCEL1"});
}

}  // namespace bough::nastran::detail
