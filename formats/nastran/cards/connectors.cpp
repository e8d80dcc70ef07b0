/// Fasteners and welds between shells: CFAST, PFAST, CWELD, PWELD. Source of the fields: MSC Nastran Quick Reference
/// Guide, the entries named.
#include <algorithm>

#include "formats/nastran/detail/parsers.hpp"
#include "formats/nastran/detail/unit_converter.hpp"

namespace bough::nastran::detail {
namespace {

/// A place that a grid gives already.
void warn_of_place(Card& card, int field, int gs, int ga) {
  if (card.is_ok() && (gs != 0 || ga != 0))
    card.warn("deck.unused-field", field,
              std::string("XS YS ZS is not used: ") + (gs != 0 ? "GS" : "GA") + " gives the place",
              "leave one of them out");
}

/// EID PID TYPE IDA IDB GS GA GB, XS YS ZS.
void parse_cfast(Card& card, Reading& r) {
  records::Cfast e;
  e.id = card.read_id(0, "EID");
  e.pid = card.read_id(1, "PID", e.id);
  e.by_elements = card.read_word(2, "TYPE", "", {"PROP", "ELEM"}) == "ELEM";
  e.ida = card.read_id(3, "IDA");
  e.idb = card.read_id(4, "IDB");
  e.gs = card.read_reference(5, "GS");
  e.ga = card.read_reference(6, "GA");
  e.gb = card.read_reference(7, "GB");
  const bool has_place = !card.is_blank(8, 11);
  e.xs = card.read_vector(8, "XS YS ZS");
  e.at = card.get_location();
  if (card.is_ok() && e.gs == 0 && e.ga == 0 && !has_place)
    card.fail("deck.missing-field", 5, "GS, GA and XS are blank", "give the grid or the place of the fastener");
  if (has_place) warn_of_place(card, 8, e.gs, e.ga);
  if (card.is_ok() && e.gb != 0 && e.ga == 0)
    card.fail("deck.missing-field", 6, "GA is blank and GB is not", "give both ends or none");
  if (r.claim("CFAST", e.id, card)) r.deck.special.cfast.push_back(e);
}

/// PID D MCID MFLAG KT1 KT2 KT3 KR1, KR2 KR3 MASS GE.
void parse_pfast(Card& card, Reading& r) {
  records::Pfast p;
  p.id = card.read_id(0, "PID");
  p.d = card.read_real(1, "D");
  p.mcid = card.read_int(2, "MCID", -1);
  p.mflag = card.read_int(3, "MFLAG", 0);
  for (int i = 0; i < 3; ++i) {
    p.kt[static_cast<std::size_t>(i)] = card.read_real(4 + i, "KT1 KT2 KT3", 0.0);
    p.kr[static_cast<std::size_t>(i)] = card.read_real(7 + i, "KR1 KR2 KR3", 0.0);
  }
  p.mass = card.read_real(10, "MASS", 0.0);
  p.ge = card.read_real(11, "GE", 0.0);
  p.at = card.get_location();
  card.demand(p.d > 0, 1, "D", "a positive diameter");
  card.demand(p.mflag == 0 || p.mflag == 1, 3, "MFLAG", "0 or 1");
  if (r.claim("PFAST", p.id, card)) r.deck.special.pfast.push_back(p);
}

std::vector<int> read_grids(Card& card, int first) {
  std::vector<int> grids;
  for (int i = first; i < first + 8; ++i)
    if (!card.is_blank(i)) grids.push_back(card.read_id(i, "GAi"));
  return grids;
}

/// EID PID GS FORMAT GA GB SPTYP, then by the format SHIDA SHIDB, PIDA PIDB or two lines of grids; XS YS ZS.
void parse_cweld(Card& card, Reading& r) {
  records::Cweld e;
  e.id = card.read_id(0, "EID");
  e.pid = card.read_id(1, "PID", e.id);
  e.gs = card.read_reference(2, "GS");
  e.format = card.read_word(3, "FORMAT", "", {"GRIDID", "ELEMID", "ELPAT", "PARTPAT", "ALIGN"});
  e.ga = card.read_reference(4, "GA");
  e.gb = card.read_reference(5, "GB");
  int place = 16;
  if (e.format == "GRIDID") {
    e.types = card.read_word(6, "SPTYP", "", {"QQ", "TT", "QT", "TQ", "Q", "T"});
    e.grids_a = read_grids(card, 8);
    e.grids_b = read_grids(card, 16);
    place = 24;
  } else if (e.format == "ALIGN") {
    if (card.is_ok() && (e.ga == 0 || e.gb == 0))
      card.fail("deck.missing-field", 4, "GA or GB is blank", "FORMAT ALIGN joins two grids of shells");
  } else if (e.format == "PARTPAT") {
    e.ida = card.read_id(8, "PIDA");
    e.idb = card.read_id(9, "PIDB");
  } else {
    e.ida = card.read_id(8, "SHIDA");
    e.idb = card.read_reference(9, "SHIDB");
  }
  const bool has_place = !card.is_blank(place, place + 3);
  e.xs = card.read_vector(place, "XS YS ZS");
  e.at = card.get_location();
  if (card.is_ok() && e.format != "ALIGN" && e.gs == 0 && e.ga == 0 && !has_place)
    card.fail("deck.missing-field", 2, "GS, GA and XS are blank", "give the grid or the place of the weld");
  if (has_place && e.format != "ALIGN") warn_of_place(card, place, e.gs, e.ga);
  if (card.is_ok() && e.format == "GRIDID" && e.grids_a.size() < 3)
    card.fail("deck.missing-field", 8, "GA1 to GA8 are less than 3 grids", "give the corners of the shell");
  if (r.claim("CWELD", e.id, card)) r.deck.special.cweld.push_back(std::move(e));
}

/// PID MID D - - MSET - TYPE, LDMIN LDMAX.
void parse_pweld(Card& card, Reading& r) {
  records::Pweld p;
  p.id = card.read_id(0, "PID");
  p.mid = card.read_id(1, "MID");
  p.d = card.read_real(2, "D");
  card.use(3, 7);  // MSET: which set of the solver the ends are in
  p.is_spot = card.read_word(7, "TYPE", "PENTA", {"PENTA", "SPOT"}) == "SPOT";
  card.read_reals(8, {{"LDMIN", p.ld_min, 0.2}, {"LDMAX", p.ld_max, 5.0}});
  p.at = card.get_location();
  card.demand(p.d > 0, 2, "D", "a positive diameter");
  card.demand(p.ld_max >= p.ld_min && p.ld_min >= 0, 9, "LDMAX", "a ratio not below LDMIN");
  if (r.claim("PWELD", p.id, card)) r.deck.special.pweld.push_back(p);
}

void write_cfasts(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.special.cfast) {
    CardFields card("CFAST");
    card.add(e.id).add(e.pid).add_word(e.by_elements ? "ELEM" : "PROP").add(e.ida).add(e.idb);
    card.add_id(e.gs).add_id(e.ga).add_id(e.gb);
    sink.put(e.gs > 0 || e.ga > 0 ? card : card.add(e.xs));
  }
}
void write_pfasts(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.special.pfast) {
    CardFields card("PFAST");
    card.add(p.id).add(p.d).add(p.mcid).add(p.mflag);
    for (const double k : p.kt) card.add(k);
    for (const double k : p.kr) card.add(k);
    sink.put(card.add(p.mass).add(p.ge));
  }
}
void write_cwelds(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.special.cweld) {
    CardFields card("CWELD");
    card.add(e.id).add(e.pid).add_id(e.gs).add_word(e.format.c_str()).add_id(e.ga).add_id(e.gb);
    if (e.format == "GRIDID")
      card.add_word(e.types.c_str());
    else
      card.add_blank();
    card.end_line();
    const auto add_grids = [&](const std::vector<int>& grids) {
      for (const int g : grids) card.add(g);
      card.end_line();
    };
    if (e.format == "GRIDID") {
      add_grids(e.grids_a);
      add_grids(e.grids_b);
    } else {
      card.add_id(e.ida).add_id(e.idb).end_line();
    }
    sink.put(e.gs > 0 || e.ga > 0 ? card : card.add(e.xs));
  }
}
void write_pwelds(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.special.pweld) {
    CardFields card("PWELD");
    card.add(p.id).add(p.mid).add(p.d).add_blank(4).add_word(p.is_spot ? "SPOT" : "PENTA");
    sink.put(card.add(p.ld_min).add(p.ld_max));
  }
}

void convert_cweld(UnitConverter& u) {
  const int place = make_upper(u.get(3)) == "GRIDID" ? 24 : 16;
  u.scale(place, place + 2, "L");
}

}  // namespace

void add_connector_parsers(ParserTable& table) {
  table["CFAST"] = {parse_cfast, ". . . . . . . . L L L", "EID PID TYPE IDA IDB GS GA GB XS YS ZS"};
  table["PFAST"] = {parse_pfast, ". L . . K K K Q Q Q M .", "PID D MCID MFLAG KT1 KT2 KT3 KR1 KR2 KR3 MASS GE"};
  table["CWELD"] = {parse_cweld, nullptr};
  table["CWELD"].convert = convert_cweld;
  table["PWELD"] = {parse_pweld, ". . L . . . . . . .", "PID MID D - - MSET - TYPE LDMIN LDMAX"};
  write_by(table, {{"CFAST", write_cfasts}, {"PFAST", write_pfasts}, {"CWELD", write_cwelds}, {"PWELD", write_pwelds}});
}

}  // namespace bough::nastran::detail
