/// Loads over frequency and time. Source of the fields: MSC Nastran Quick Reference Guide, the entries named.
#include <iterator>

#include "formats/nastran/detail/card_sink.hpp"
#include "formats/nastran/detail/dynamic_cards.hpp"
#include "formats/nastran/detail/field_list.hpp"
#include "formats/nastran/detail/parsers.hpp"
#include "formats/nastran/detail/text.hpp"
#include "formats/nastran/detail/unit_converter.hpp"
#include "formats/nastran/detail/write_order.hpp"

namespace bough::nastran::detail {
namespace {

using records::DynamicCards;
using records::DynamicLoad;

constexpr const char* kExcitations[] = {"LOAD", "DISP", "VELO", "ACCE"};

/// TYPE: 0 to 3, or the first letters of LOAD, DISP, VELO, ACCE.
DynamicLoad::Excitation read_excitation(Card& card, int i) {
  static const std::vector<std::string> words(std::begin(kExcitations), std::end(kExcitations));
  const auto word = card.get_upper(i);
  for (int kind = 0; kind < 4; ++kind)
    if (word == std::to_string(kind) || (!word.empty() && words[static_cast<std::size_t>(kind)].starts_with(word)))
      return static_cast<DynamicLoad::Excitation>(kind);
  if (!word.empty()) card.read_word(i, "TYPE", "LOAD", words);
  return DynamicLoad::Excitation::Force;
}

FieldList& list_excitation(FieldList& f, DynamicLoad& load) {
  return f.field(
      "TYPE", [&](Card& card, int i) { load.excitation = read_excitation(card, i); },
      [&](CardFields& out) { out.add_word(kExcitations[static_cast<int>(load.excitation)]); });
}
FieldList& list_head(FieldList& f, DynamicLoad& load) {
  return f.id("SID", load.sid).id("EXCITEID", load.excite).set_or_real("DELAY", load.delay_set, load.delay);
}
void list_rload1(FieldList& f, DynamicLoad& load) {
  list_head(f, load).set_or_real("DPHASE", load.phase_set, load.phase_deg);
  f.set_or_real("TC", load.table_a, load.a).set_or_real("TD", load.table_b, load.b);
  list_excitation(f, load);
}
void list_rload2(FieldList& f, DynamicLoad& load) {
  list_head(f, load).set_or_real("DPHASE", load.phase_set, load.phase_deg);
  f.set_or_real("TB", load.table_a, load.a).set_or_real("TP", load.table_b, load.b);
  list_excitation(f, load);
}
void list_tload1(FieldList& f, DynamicLoad& load) {
  list_excitation(list_head(f, load), load).set_or_real("TID", load.table_a, load.a);
}
void list_tload2(FieldList& f, DynamicLoad& load) {
  list_excitation(list_head(f, load), load).real("T1", load.t1, 0.0).real("T2", load.t2);
  f.real("F", load.frequency_hz, 0.0).real("P", load.phase_deg, 0.0);
  f.real("C", load.growth, 0.0).real("B", load.power, 0.0);
}

DynamicLoad read_load(Card& card, DynamicLoad::Kind kind, void (*list)(FieldList&, DynamicLoad&)) {
  DynamicLoad load;
  load.kind = kind;
  read_fields(card, list, load);
  return load;
}

void add_load(Card& card, DynamicCards& r, DynamicLoad load) {
  add_unique(card, r.loads, load, &std::remove_reference_t<decltype(load)>::sid);
}

void parse_rload1(Card& card, DynamicCards& r) {
  const auto load = read_load(card, DynamicLoad::Kind::Rload1, list_rload1);
  if (card.is_ok() && card.is_blank(4, 6))
    card.fail("deck.missing-field", 4, "TC and TD are blank, expected a table or a number at least");
  add_load(card, r, load);
}

void parse_rload2(Card& card, DynamicCards& r) {
  const auto load = read_load(card, DynamicLoad::Kind::Rload2, list_rload2);
  card.demand(!card.is_blank(4), 4, "TB", "a table or a number");
  add_load(card, r, load);
}

/// US0 and VS0: where a motion of supports by VELO or ACCE begins.
void refuse_start(Card& card, int first, DynamicLoad::Excitation excitation) {
  for (int i = first; i < first + 2; ++i) {
    const char* name = i == first ? "US0" : "VS0";
    if (card.read_real(i, name, 0.0) == 0 || !card.is_ok()) continue;
    if (excitation == DynamicLoad::Excitation::Force)
      card.warn("deck.unused-field", i, std::string(name) + " is not used: the card gives forces",
                "leave it blank, or write TYPE DISP, VELO or ACCE");
    else
      card.fail("deck.unsupported-start", i, std::string(name) + " is not supported: motions of supports begin at 0",
                "add a TLOAD2 of TYPE DISP for it, or leave it blank");
  }
}

/// The fields of list_tload1, US0 and VS0.
void parse_tload1(Card& card, DynamicCards& r) {
  const auto load = read_load(card, DynamicLoad::Kind::Tload1, list_tload1);
  card.demand(!card.is_blank(4), 4, "TID", "a table or a number");
  refuse_start(card, 5, load.excitation);
  add_load(card, r, load);
}

/// The fields of list_tload2, US0 and VS0.
void parse_tload2(Card& card, DynamicCards& r) {
  const auto load = read_load(card, DynamicLoad::Kind::Tload2, list_tload2);
  if (card.is_ok()) card.demand(load.t2 > load.t1, 5, "T2", "a time after T1");
  if (card.is_ok()) card.demand(load.power >= 0, 9, "B", "zero or above");
  refuse_start(card, 10, load.excitation);
  add_load(card, r, load);
}

void list_dload(FieldList& f, records::DynamicLoadSum& sum) { f.id("SID", sum.sid).real("S", sum.s); }
void parse_dload(Card& card, DynamicCards& r) {
  records::DynamicLoadSum sum;
  read_fields(card, list_dload, sum);
  sum.terms = read_load_terms(card);
  add_unique(card, r.sums, std::move(sum), &std::remove_reference_t<decltype(sum)>::sid);
}

/// SID P1 C1 A1 P2 C2 A2.
void parse_values(Card& card, std::vector<records::DofValue>& values, const char* what) {
  const int sid = card.read_id(0, "SID");
  read_entries(card, 3, {1, 4}, [&](int i) {
    records::DofValue v;
    v.sid = sid;
    v.g = card.read_id(i, "P");
    v.c = card.read_component(i + 1, "C");
    v.value = card.read_real(i + 2, what, 0.0);
    v.at = card.get_location();
    if (card.is_ok()) values.push_back(v);
  });
}
void parse_darea(Card& card, DynamicCards& r) { parse_values(card, r.areas, "A"); }
void parse_delay(Card& card, DynamicCards& r) { parse_values(card, r.delays, "T"); }
void parse_dphase(Card& card, DynamicCards& r) { parse_values(card, r.phases, "TH"); }

void list_lseq(FieldList& f, records::StaticExcitation& s) {
  f.id("SID", s.sid).id("EXCITEID", s.excite).reference("LID", s.load).reference("TID", s.temperature);
}
void parse_lseq(Card& card, DynamicCards& r) {
  records::StaticExcitation s;
  read_fields(card, list_lseq, s);
  if (card.is_ok()) r.lseq.push_back(s);
}

void list_tic(FieldList& f, records::InitialMotion& m) {
  f.id("SID", m.sid).id("G", m.g).component("C", m.c).real("U0", m.u0, 0.0).real("V0", m.v0, 0.0);
}
void parse_tic(Card& card, DynamicCards& r) {
  records::InitialMotion m;
  read_fields(card, list_tic, m);
  if (card.is_ok()) r.initial.push_back(m);
}

void write_dynamic_loads(const DynamicCards& cards, CardSink& sink) {
  using Kind = DynamicLoad::Kind;
  for (const auto& load : cards.loads)
    sink.put(load.kind == Kind::Rload1   ? make_fields("RLOAD1", list_rload1, load)
             : load.kind == Kind::Rload2 ? make_fields("RLOAD2", list_rload2, load)
             : load.kind == Kind::Tload1 ? make_fields("TLOAD1", list_tload1, load)
                                         : make_fields("TLOAD2", list_tload2, load));
}
void write_dloads(const DynamicCards& cards, CardSink& sink) {
  for (const auto& sum : cards.sums) {
    auto card = make_fields("DLOAD", list_dload, sum);
    for (const auto& [scale, set] : sum.terms) card.add(scale).add(set);
    sink.put(card);
  }
}
void write_dof_values(const DynamicCards& cards, CardSink& sink) {
  const auto write = [&](const char* name, const auto& values) {
    for (const auto& v : values) sink.put(CardFields(name).add(v.sid).add(v.g).add(v.c).add(v.value));
  };
  write("DAREA", cards.areas);
  write("DELAY", cards.delays);
  write("DPHASE", cards.phases);
}
void write_lseqs(const DynamicCards& cards, CardSink& sink) {
  for (const auto& s : cards.lseq) sink.put(make_fields("LSEQ", list_lseq, s));
}
void write_tics(const DynamicCards& cards, CardSink& sink) {
  for (const auto& m : cards.initial) sink.put(make_fields("TIC", list_tic, m));
}

// Conversion of units. Tables are pure numbers over hertz or time: the units of a load are those of its DAREA, static
// loads or SPCD.

/// TYPE of a load over frequency or time: 0 force, 1 motion, 2 velocity, 3 acceleration.
int find_excitation(const std::string& type) {
  const auto word = make_upper(type);
  const char first = word.empty() ? 'L' : word[0];
  return first == 'D' || first == '1' ? 1 : first == 'V' || first == '2' ? 2 : first == 'A' || first == '3' ? 3 : 0;
}
void note_rload(const UnitConverter& u, UnitNotes& notes) {
  for (const int field : {4, 5}) {
    if (u.get(field).empty()) continue;
    notes.table_axes[u.get(field)].insert("Hz");
    notes.table_values[u.get(field)].insert(".");
  }
  notes.enforced[u.get(1)].insert(find_excitation(u.get(6)));
}
void note_tload(const UnitConverter& u, UnitNotes& notes) {
  notes.enforced[u.get(1)].insert(find_excitation(u.get(3)));
}
void note_tload1(const UnitConverter& u, UnitNotes& notes) {
  notes.table_axes[u.get(4)].insert("T");
  notes.table_values[u.get(4)].insert(".");
  note_tload(u, notes);
}

/// A delay in time; an integer is a set of DELAY.
void convert_load(UnitConverter& u) {
  if (!parse_int(u.get(2))) u.scale(2, "T");
}
void convert_tload1(UnitConverter& u) {
  convert_load(u);
  u.scale(5, 6, "?");
}
/// t^B exp(C t) cos(2 pi F t + P) between T1 and T2: with B the load has a unit of time in it.
void convert_tload2(UnitConverter& u) {
  convert_load(u);
  u.scale(4, 5, "T");
  u.scale(6, "Hz");
  u.scale(8, "Hz");
  if (parse_real(u.get(9)).value_or(0) != 0 && !u.keeps_time()) u.scale(9, "?");
  u.scale(10, 11, "?");
}
void convert_darea(UnitConverter& u) {
  for (const int first : {1, 4})
    if (!u.get(first).empty()) u.scale_by(u.find_components(first + 1), first + 2, "F", "Q", "?");
}
void convert_tic(UnitConverter& u) {
  const auto motion = u.find_components(2);
  u.scale_by(motion, 3, "L", ".", "?");
  u.scale_by(motion, 4, "V", "Hz", "?");
}

}  // namespace

void add_dynamic_loads(DynamicParserTable& table) {
  table["RLOAD1"] = {parse_rload1, nullptr, convert_load, note_rload};
  table["RLOAD1"].names = name_fields(list_rload1);
  table["RLOAD2"] = {parse_rload2, nullptr, convert_load, note_rload};
  table["RLOAD2"].names = name_fields(list_rload2);
  table["TLOAD1"] = {parse_tload1, nullptr, convert_tload1, note_tload1};
  table["TLOAD1"].names = name_fields(list_tload1);
  table["TLOAD2"] = {parse_tload2, nullptr, convert_tload2, note_tload};
  table["TLOAD2"].names = name_fields(list_tload2);
  table["DLOAD"] = {parse_dload, ""};
  table["DLOAD"].names = name_fields(list_dload);
  table["DAREA"] = {parse_darea, nullptr, convert_darea};
  table["DAREA"].names = "SID P1 C1 A1 P2 C2 A2";
  table["DELAY"] = {parse_delay, ". . . T . . T"};
  table["DELAY"].names = "SID P1 C1 T1 P2 C2 T2";
  table["DPHASE"] = {parse_dphase, ""};
  table["DPHASE"].names = "SID P1 C1 TH1 P2 C2 TH2";
  table["LSEQ"] = {parse_lseq, ""};
  table["LSEQ"].names = name_fields(list_lseq);
  table["TIC"] = {parse_tic, nullptr, convert_tic};
  table["TIC"].names = name_fields(list_tic);
  set_writer(table, write_dynamic_loads, {"RLOAD1", "RLOAD2", "TLOAD1", "TLOAD2"});
  set_writer(table, write_dloads, {"DLOAD"});
  set_writer(table, write_dof_values, {"DAREA", "DELAY", "DPHASE"});
  set_writer(table, write_lseqs, {"LSEQ"});
  set_writer(table, write_tics, {"TIC"});
}

const DynamicParserTable& get_dynamic_parsers() {
  static const DynamicParserTable table = [] {
    DynamicParserTable t;
    add_dynamic_loads(t);
    add_dynamic_tables(t);
    add_dynamic_lists(t);
    add_frequency_table_parsers(t);
    return t;
  }();
  return table;
}

}  // namespace bough::nastran::detail
