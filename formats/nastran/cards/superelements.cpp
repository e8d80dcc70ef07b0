#include <array>

#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {
namespace {

constexpr double kTolerance = 1e-5;  // Quick Reference Guide, SEBULK and SECONCT

/// SEID TYPE RSEID METHOD TOL LOC UNITNO
void parse_sebulk(Card& card, Reading& r) {
  records::Sebulk s;
  s.id = card.read_id(0, "SEID");
  s.type = card.get_upper(1);
  s.reference = card.read_reference(2, "RSEID");
  s.is_auto = card.read_word(3, "METHOD", "AUTO", {"AUTO", "MANUAL"}) == "AUTO";
  s.tolerance = card.read_real(4, "TOL", kTolerance);
  card.read_word(5, "LOC", "YES", {"YES", "NO"});
  s.unit = card.read_reference(6, "UNITNO");
  s.at = card.get_location();
  if (s.type.empty()) card.fail("deck.missing-field", 1, "TYPE is blank, expected PRIMARY, EXTOP4, ...");
  if (card.is_ok()) r.deck.super.sebulk.push_back(s);
}

/// SEIDA SEIDB TOL LOC, then on further lines GIDA1 GIDB1 GIDA2 GIDB2 ... or GIDA1 THRU GIDA2 GIDB1 THRU GIDB2.
void parse_seconct(Card& card, Reading& r) {
  records::Seconct s;
  s.a = card.read_id(0, "SEIDA");
  s.b = card.read_reference(1, "SEIDB");
  s.tolerance = card.read_real(2, "TOL", kTolerance);
  card.read_word(3, "LOC", "YES", {"YES", "NO"});
  card.use(4, 8);
  s.at = card.get_location();
  card.use(8, card.get_size());
  for (int i = 8; i < card.get_size();) {
    if (card.is_blank(i)) {
      ++i;
      continue;
    }
    if (!card.is_word(i + 1, "THRU")) {
      const int a = card.read_id(i, "GIDA"), b = card.read_id(i + 1, "GIDB");
      s.points.emplace_back(a, b);
      i += 2;
      continue;
    }
    const int a1 = card.read_id(i, "GIDA1"), a2 = card.read_id(i + 2, "GIDA2");
    const int b1 = card.read_id(i + 3, "GIDB1"), b2 = card.read_id(i + 5, "GIDB2");
    if (!card.is_ok()) return;
    if (!card.is_word(i + 4, "THRU") || a2 < a1 || a2 - a1 != b2 - b1 || a2 - a1 > 1'000'000) {
      card.fail("deck.bad-list", i, "GIDA1 THRU GIDA2 GIDB1 THRU GIDB2: the two ranges differ in length",
                "write ranges of one length");
      return;
    }
    for (int k = 0; k <= a2 - a1; ++k) s.points.emplace_back(a1 + k, b1 + k);
    i += 6;
  }
  if (card.is_ok()) r.deck.super.seconct.push_back(std::move(s));
}

/// SEIDA SEIDB GIDA1 GIDA2 ..., also over more lines, with THRU: SECONCT to the grids at the same places.
void parse_sebndry(Card& card, Reading& r) {
  records::Seconct s;
  s.a = card.read_id(0, "SEIDA");
  if (!card.is_word(1, "ALL")) s.b = card.read_reference(1, "SEIDB");
  card.use(1);
  s.at = card.get_location();
  for (const int id : read_ids(card, 2, card.get_size(), "GIDA")) s.points.emplace_back(id, 0);
  if (card.is_ok()) r.deck.super.seconct.push_back(std::move(s));
}

/// GID1 C1 GID2 C2 ..., also over more lines; GID1 THRU GID2 of scalar points.
void parse_extrn(Card& card, Reading& r) {
  card.use(0, card.get_size());
  auto& super = r.deck.super;
  if (super.extrn.empty()) super.extrn_at = card.get_location();
  for (int i = 0; i < card.get_size();) {
    if (card.is_blank(i)) {
      ++i;
      continue;
    }
    const int first = card.read_id(i, "GID");
    if (card.is_word(i + 1, "THRU")) {
      const int last = card.read_id(i + 2, "GID2");
      const auto c = card.read_components(i + 3, "C", 0);
      if (!card.is_ok()) return;
      card.demand(last >= first && last - first < 1'000'000, i + 2, "GID2", "an id after GID1");
      for (int id = first; card.is_ok() && id <= last; ++id) super.extrn.push_back({id, c});
      i += 4;
    } else {
      super.extrn.push_back({first, card.read_components(i + 1, "C", 0)});
      i += 2;
    }
    if (!card.is_ok()) return;
  }
}

/// LIDS0 SEID LIDSE
void parse_seload(Card& card, Reading& r) {
  records::Seload load;
  load.set = card.read_id(0, "LIDS0");
  load.superelement = card.read_id(1, "SEID");
  load.load = card.read_id(2, "LIDSE");
  load.at = card.get_location();
  if (card.is_ok()) r.deck.super.seload.push_back(load);
}

/// The tables of EXTSEOUT: record 2 has TYPE ID COMP ROW for each item.
void parse_dti(Card& card, Reading& r) {
  const auto name = card.get_upper(0);
  card.use(0, card.get_size());
  static constexpr std::array tables{"TUG1", "TEF1", "TES1", "TQG1"};
  if (name == "SELOAD") {  // record n: the load, its column of PX, its label
    if (card.is_integer(1) && card.read_int(1, "IREC") > 0 && card.is_integer(2) && card.is_integer(3))
      r.deck.super.load_columns[card.read_id(2, "LIDSE")] = card.read_id(3, "COLUMN");
    return;
  }
  const bool is_table = std::find(tables.begin(), tables.end(), name) != tables.end();
  if (!is_table) {
    if (r.unread_tables.insert(name).second)
      card.warn("deck.unused-card", 0, "table " + name + " is not read", "it carries nothing Bough computes with");
    return;
  }
  if (!card.is_integer(1) || card.read_int(1, "IREC") != 2) return;
  records::RecoveryRows rows;
  rows.name = name;
  rows.at = card.get_location();
  // The rest of the first line is blank; then the headings, twice.
  for (int i = 8; i + 3 < card.get_size(); i += 4) {
    if (card.is_word(i, "ENDREC")) break;
    if (card.is_word(i, "TYPE") || card.is_blank(i, i + 4)) continue;
    records::RecoveryItem item;
    item.type = card.read_int(i, "TYPE");
    item.id = card.read_id(i + 1, "ID");
    item.num_rows = card.read_id(i + 2, "COMP");
    item.first_row = card.read_id(i + 3, "ROW") - 1;
    if (!card.is_ok()) return;
    rows.items.push_back(item);
  }
  r.deck.super.rows.push_back(std::move(rows));
}

void convert_sebulk(UnitConverter& u) {
  u.fail_card("SEBULK takes matrices from a file, which keeps its units",
              "convert the deck of the component and write its files again");
}

}  // namespace

void add_superelement_parsers(ParserTable& table) {
  table["SEBULK"] = {parse_sebulk, nullptr, "SEID TYPE RSEID METHOD TOL LOC UNITNO"};
  table["SEBULK"].convert = convert_sebulk;
  table["SECONCT"] = {parse_seconct, ". . L", "SEIDA SEIDB TOL LOC"};
  table["SELOAD"] = {parse_seload, ""};
  table["SEBNDRY"] = {parse_sebndry, ""};
  table["EXTRN"] = {parse_extrn, ""};
  table["DTI"] = {parse_dti, ""};
}

}  // namespace bough::nastran::detail
