#include <array>
#include <bit>

#include "formats/nastran/detail/field_list.hpp"
#include "formats/nastran/detail/parsers.hpp"
#include "formats/nastran/detail/recovery_table.hpp"

namespace bough::nastran::detail {
namespace {

constexpr double kTolerance = 1e-5;  // Quick Reference Guide, SEBULK and SECONCT

using records::Seconct;

/// LOC: whether coincident points are checked for their place, which is done in any case.
FieldList& list_location_check(FieldList& f) {
  return f.field(
      "LOC",
      [](Card& card, int i) {
        card.read_word(i, "LOC", "YES", {"YES", "NO"});
      },
      [](CardFields& out) { out.add_blank(); });
}

void list_sebulk(FieldList& f, records::Sebulk& s) {
  f.id("SEID", s.id);
  f.field(
      "TYPE", [&](Card& card, int i) { s.type = card.get_upper(i); }, [&](CardFields& out) { out.add_word(s.type); });
  f.reference("RSEID", s.reference);
  f.field(
      "METHOD",
      [&](Card& card, int i) {
        s.is_auto = card.read_word(i, "METHOD", "AUTO", {"AUTO", "MANUAL"}) == "AUTO";
      },
      [&](CardFields& out) { out.add_word(s.is_auto ? "AUTO" : "MANUAL"); });
  list_location_check(f.real("TOL", s.tolerance, kTolerance)).reference("UNITNO", s.unit);
}
void parse_sebulk(Card& card, Reading& r) {
  records::Sebulk s;
  read_fields(card, list_sebulk, s);
  if (s.type.empty()) card.fail("deck.missing-field", 1, "TYPE is blank, expected PRIMARY, EXTOP4, ...");
  if (card.is_ok()) r.deck.super.sebulk.push_back(s);
}

void list_seconct(FieldList& f, Seconct& s) {
  list_location_check(f.id("SEIDA", s.a).reference("SEIDB", s.b).real("TOL", s.tolerance, kTolerance));
}
/// The fields of list_seconct, then on further lines GIDA1 GIDB1 GIDA2 GIDB2 ... or GIDA1 THRU GIDA2 GIDB1 THRU GIDB2.
void parse_seconct(Card& card, Reading& r) {
  Seconct s;
  read_fields(card, list_seconct, s);
  card.use(4, 8);
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
  Seconct s;
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

void list_seload(FieldList& f, records::Seload& load) {
  f.id("LIDS0", load.set).id("SEID", load.superelement).id("LIDSE", load.load);
}
void parse_seload(Card& card, Reading& r) {
  records::Seload load;
  read_fields(card, list_seload, load);
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

void write_sebulks(const records::Deck& deck, CardSink& sink) {
  for (const auto& s : deck.super.sebulk) sink.put(make_fields("SEBULK", list_sebulk, s));
}
/// Points of SEBNDRY have no counterpart.
bool is_boundary(const Seconct& s) { return !s.points.empty() && s.points.front().second == 0; }
void write_seconcts(const records::Deck& deck, CardSink& sink) {
  for (const auto& s : deck.super.seconct) {
    if (is_boundary(s)) continue;
    auto card = make_fields("SECONCT", list_seconct, s);
    card.end_line();
    for (const auto& [a, b] : s.points) card.add(a).add(b);
    sink.put(card);
  }
}
void write_sebndries(const records::Deck& deck, CardSink& sink) {
  for (const auto& s : deck.super.seconct) {
    if (!is_boundary(s)) continue;
    CardFields card("SEBNDRY");
    card.add(s.a).add(s.b);
    for (const auto& point : s.points) card.add(point.first);
    sink.put(card);
  }
}
void write_seloads(const records::Deck& deck, CardSink& sink) {
  for (const auto& load : deck.super.seload) sink.put(make_fields("SELOAD", list_seload, load));
}
void write_extrn(const records::Deck& deck, CardSink& sink) {
  if (deck.super.extrn.empty()) return;
  CardFields card("EXTRN");
  for (const auto& point : deck.super.extrn) {
    card.add(point.id);
    point.c == 0 ? card.add(0) : card.add_components(point.c);
  }
  sink.put(card);
}
/// Tables of rows, and the load of each column of PX.
void write_recovery_tables(const records::Deck& deck, CardSink& sink) {
  int num_columns = 0;
  for (const auto& point : deck.super.extrn) num_columns += point.c == 0 ? 1 : std::popcount(point.c);
  for (const auto& rows : deck.super.rows) write_recovery_rows(rows.name, rows.items, num_columns, sink);
  int record = 0;
  for (const auto& [load, column] : deck.super.load_columns)
    sink.put(CardFields("DTI").add_word("SELOAD").add(++record).add(load).add(column));
}

void convert_sebulk(UnitConverter& u) {
  u.fail_card("SEBULK takes matrices from a file, which keeps its units",
              "convert the deck of the component and write its files again");
}

}  // namespace

void add_superelement_parsers(ParserTable& table) {
  table["SEBULK"] = {parse_sebulk, nullptr, name_fields(list_sebulk)};
  table["SEBULK"].convert = convert_sebulk;
  table["SECONCT"] = {parse_seconct, ". . L", name_fields(list_seconct)};
  table["SELOAD"] = {parse_seload, "", name_fields(list_seload)};
  table["SEBNDRY"] = {parse_sebndry, ""};
  table["EXTRN"] = {parse_extrn, ""};
  table["DTI"] = {parse_dti, ""};
  write_by(table, {{"SEBULK", write_sebulks},
                   {"SECONCT", write_seconcts},
                   {"SEBNDRY", write_sebndries},
                   {"SELOAD", write_seloads},
                   {"EXTRN", write_extrn},
                   {"DTI", write_recovery_tables}});
}

}  // namespace bough::nastran::detail
