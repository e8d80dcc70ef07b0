/// Loads over frequency and time. Source of the fields: MSC Nastran Quick Reference Guide, the entries named.
#include <algorithm>
#include <cmath>

#include "formats/nastran/detail/dynamic_cards.hpp"
#include "formats/nastran/detail/parsers.hpp"
#include "formats/nastran/detail/table_points.hpp"
#include "formats/nastran/detail/text.hpp"
#include "formats/nastran/detail/unit_converter.hpp"

namespace bough::nastran::detail {
namespace {

using records::DynamicCards;
using records::DynamicLoad;

/// A set where the field is an integer, else a number.
void read_set_or_number(Card& card, int i, const char* what, int& set, double& value) {
  if (card.is_integer(i))
    set = card.read_reference(i, what);
  else
    value = card.read_real(i, what, 0.0);
}

/// TYPE: 0 to 3, or the first letters of LOAD, DISP, VELO, ACCE.
DynamicLoad::Excitation read_excitation(Card& card, int i) {
  static const std::vector<std::string> words{"LOAD", "DISP", "VELO", "ACCE"};
  const auto word = card.get_upper(i);
  for (int kind = 0; kind < 4; ++kind)
    if (word == std::to_string(kind) || (!word.empty() && words[static_cast<std::size_t>(kind)].starts_with(word)))
      return static_cast<DynamicLoad::Excitation>(kind);
  if (!word.empty()) card.read_word(i, "TYPE", "LOAD", words);
  return DynamicLoad::Excitation::Force;
}

DynamicLoad read_head(Card& card, DynamicLoad::Kind kind) {
  DynamicLoad load;
  load.kind = kind;
  load.sid = card.read_id(0, "SID");
  load.excite = card.read_id(1, "EXCITEID");
  read_set_or_number(card, 2, "DELAY", load.delay_set, load.delay);
  load.at = card.get_location();
  return load;
}

void add_load(Card& card, DynamicCards& r, DynamicLoad load) {
  add_unique(card, r.loads, load, &std::remove_reference_t<decltype(load)>::sid);
}

/// The fields of RLOAD1 and RLOAD2, whose two functions of frequency have the names `a` and `b`.
DynamicLoad read_frequency_load(Card& card, DynamicLoad::Kind kind, const char* a, const char* b) {
  auto load = read_head(card, kind);
  read_set_or_number(card, 3, "DPHASE", load.phase_set, load.phase_deg);
  read_set_or_number(card, 4, a, load.table_a, load.a);
  read_set_or_number(card, 5, b, load.table_b, load.b);
  load.excitation = read_excitation(card, 6);
  return load;
}

/// SID EXCITEID DELAY DPHASE TC TD TYPE.
void parse_rload1(Card& card, DynamicCards& r) {
  const auto load = read_frequency_load(card, DynamicLoad::Kind::Rload1, "TC", "TD");
  if (card.is_ok() && card.is_blank(4, 6))
    card.fail("deck.missing-field", 4, "TC and TD are blank, expected a table or a number at least");
  add_load(card, r, load);
}

/// SID EXCITEID DELAY DPHASE TB TP TYPE.
void parse_rload2(Card& card, DynamicCards& r) {
  const auto load = read_frequency_load(card, DynamicLoad::Kind::Rload2, "TB", "TP");
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

/// SID EXCITEID DELAY TYPE TID US0 VS0.
void parse_tload1(Card& card, DynamicCards& r) {
  auto load = read_head(card, DynamicLoad::Kind::Tload1);
  load.excitation = read_excitation(card, 3);
  read_set_or_number(card, 4, "TID", load.table_a, load.a);
  card.demand(!card.is_blank(4), 4, "TID", "a table or a number");
  refuse_start(card, 5, load.excitation);
  add_load(card, r, load);
}

/// SID EXCITEID DELAY TYPE T1 T2 F P, C B US0 VS0.
void parse_tload2(Card& card, DynamicCards& r) {
  auto load = read_head(card, DynamicLoad::Kind::Tload2);
  load.excitation = read_excitation(card, 3);
  card.read_reals(4, {{"T1", load.t1, 0.0},
                      {"T2", load.t2, {}},
                      {"F", load.frequency_hz, 0.0},
                      {"P", load.phase_deg, 0.0},
                      {"C", load.growth, 0.0},
                      {"B", load.power, 0.0}});
  if (card.is_ok()) card.demand(load.t2 > load.t1, 5, "T2", "a time after T1");
  if (card.is_ok()) card.demand(load.power >= 0, 9, "B", "zero or above");
  refuse_start(card, 10, load.excitation);
  add_load(card, r, load);
}

void parse_dload(Card& card, DynamicCards& r) {
  records::DynamicLoadSum sum;
  sum.sid = card.read_id(0, "SID");
  sum.s = card.read_real(1, "S");
  sum.terms = read_load_terms(card);
  sum.at = card.get_location();
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

void parse_lseq(Card& card, DynamicCards& r) {
  records::StaticExcitation s;
  card.read_ids(0, {{"SID", s.sid}, {"EXCITEID", s.excite}});
  s.load = card.read_reference(2, "LID");
  s.temperature = card.read_reference(3, "TID");
  s.at = card.get_location();
  if (card.is_ok()) r.lseq.push_back(s);
}

void parse_tic(Card& card, DynamicCards& r) {
  records::InitialMotion m;
  card.read_ids(0, {{"SID", m.sid}, {"G", m.g}});
  m.c = card.read_component(2, "C");
  card.read_reals(3, {{"U0", m.u0, 0.0}, {"V0", m.v0, 0.0}});
  m.at = card.get_location();
  if (card.is_ok()) r.initial.push_back(m);
}

template <class Record>
Record read_kind_head(Card& card, int Record::*id, const char* what, int kind) {
  Record record;
  record.*id = card.read_id(0, what);
  record.kind = kind;
  record.at = card.get_location();
  return record;
}
void add_table(Card& card, DynamicCards& r, int kind) {
  auto table = read_function_table(card, kind);
  add_unique(card, r.tables, std::move(table), &records::DynamicTable::id);
}
void parse_tabled1(Card& card, DynamicCards& r) { add_table(card, r, 1); }
void parse_tabled2(Card& card, DynamicCards& r) { add_table(card, r, 2); }
void parse_tabled3(Card& card, DynamicCards& r) { add_table(card, r, 3); }
void parse_tabled4(Card& card, DynamicCards& r) { add_table(card, r, 4); }

void parse_tabdmp1(Card& card, DynamicCards& r) {
  records::DampingCurve t;
  t.id = card.read_id(0, "TID");
  t.type = card.read_word(1, "TYPE", "G", {"G", "CRIT", "Q"});
  t.at = card.get_location();
  t.points = read_points(card, 8);
  refuse_jumps_at_ends(card, t.points);
  for (const auto& [hz, value] : t.points)
    if (card.is_ok() && t.type == "Q" && value <= 0) card.fail("deck.field-range", 8, "a quality Q is not above 0");
  add_unique(card, r.damping, std::move(t), &std::remove_reference_t<decltype(t)>::id);
}

records::FrequencyList read_list_head(Card& card, int kind) {
  return read_kind_head(card, &records::FrequencyList::sid, "SID", kind);
}
void add_list(Card& card, DynamicCards& r, records::FrequencyList list) {
  if (card.is_ok()) r.frequencies.push_back(std::move(list));
}

void parse_freq(Card& card, DynamicCards& r) {
  auto list = read_list_head(card, 0);
  for (int i = 1; i < card.get_size(); ++i) {
    if (card.is_blank(i)) continue;
    list.values.push_back(card.read_real(i, "F"));
    if (card.is_ok()) card.demand(list.values.back() >= 0, i, "F", "zero or above");
  }
  if (card.is_ok() && list.values.empty()) card.fail("deck.missing-field", 1, "no frequency is given");
  add_list(card, r, std::move(list));
}
/// SID F1 DF NDF.
void parse_freq1(Card& card, DynamicCards& r) {
  auto list = read_list_head(card, 1);
  list.f1 = card.read_real(1, "F1");
  list.f2 = card.read_real(2, "DF");
  list.count = card.read_int(3, "NDF", 1);
  if (card.is_ok()) card.demand(list.f1 >= 0, 1, "F1", "zero or above");
  if (card.is_ok()) card.demand(list.f2 > 0, 2, "DF", "a number above 0");
  if (card.is_ok()) card.demand(list.count > 0 && list.count <= 1'000'000, 3, "NDF", "1 to 1000000");
  add_list(card, r, std::move(list));
}
/// SID F1 F2, and the further fields of FREQ2 to FREQ4.
records::FrequencyList read_range(Card& card, int kind, bool starts_above_zero) {
  auto list = read_list_head(card, kind);
  list.f1 = kind == 4 ? card.read_real(1, "F1", 0.0) : card.read_real(1, "F1");
  list.f2 = card.read_real(2, "F2", list.f1);
  if (card.is_ok() && starts_above_zero) card.demand(list.f1 > 0, 1, "F1", "a number above 0");
  if (card.is_ok()) card.demand(list.f1 >= 0, 1, "F1", "zero or above");
  if (card.is_ok()) card.demand(list.f2 >= list.f1 && list.f2 > 0, 2, "F2", "a number above 0, not below F1");
  return list;
}
void parse_freq2(Card& card, DynamicCards& r) {
  auto list = read_range(card, 2, true);
  list.count = card.read_int(3, "NF", 1);
  if (card.is_ok()) card.demand(list.count > 0 && list.count <= 1'000'000, 3, "NF", "1 to 1000000");
  add_list(card, r, std::move(list));
}
void parse_freq3(Card& card, DynamicCards& r) {
  const bool is_log = card.read_word(3, "TYPE", "LINEAR", {"LINEAR", "LOG"}) == "LOG";
  auto list = read_range(card, 3, is_log);
  list.is_log = is_log;
  list.count = card.read_int(4, "NEF", 10);
  list.spread = card.read_real(5, "CLUSTER", 1.0);
  if (card.is_ok()) card.demand(list.count > 1 && list.count <= 100'000, 4, "NEF", "2 to 100000");
  if (card.is_ok()) card.demand(list.spread > 0, 5, "CLUSTER", "a number above 0");
  add_list(card, r, std::move(list));
}
void parse_freq4(Card& card, DynamicCards& r) {
  auto list = read_range(card, 4, false);
  list.spread = card.read_real(3, "FSPD", 0.1);
  list.count = card.read_int(4, "NFM", 3);
  if (card.is_ok()) card.demand(list.spread > 0 && list.spread < 1, 3, "FSPD", "a number between 0 and 1");
  if (card.is_ok()) card.demand(list.count > 0 && list.count <= 100'000, 4, "NFM", "1 to 100000");
  add_list(card, r, std::move(list));
}
/// SID F1 F2 FR1 FR2 ...
void parse_freq5(Card& card, DynamicCards& r) {
  auto list = read_list_head(card, 5);
  list.f1 = card.read_real(1, "F1", 0.0);
  list.f2 = card.read_real(2, "F2", 1e20);
  for (int i = 3; i < card.get_size(); ++i) {
    if (card.is_blank(i)) continue;
    list.values.push_back(card.read_real(i, "FR"));
    if (card.is_ok()) card.demand(list.values.back() > 0, i, "FR", "a number above 0");
  }
  if (card.is_ok() && list.values.empty()) card.fail("deck.missing-field", 3, "no fraction is given");
  if (card.is_ok()) card.demand(list.f2 >= list.f1, 2, "F2", "a number not below F1");
  add_list(card, r, std::move(list));
}

/// SID N1 DT1 NO1; from the second line on in the same fields.
void parse_tstep(Card& card, DynamicCards& r) {
  records::TimeSteps steps;
  steps.sid = card.read_id(0, "SID");
  steps.at = card.get_location();
  for (int i = 1; i < std::max(card.get_size(), 4); i += 8) {
    if (i > 1 && card.is_blank(i, i + 3)) continue;
    records::TimeSteps::Part part;
    part.count = card.read_id(i, "N");
    part.step = card.read_real(i + 1, "DT");
    part.every = card.read_id(i + 2, "NO", 1);
    if (card.is_ok()) card.demand(part.step > 0, i + 1, "DT", "a number above 0");
    if (card.is_ok()) card.demand(part.count <= 10'000'000, i, "N", "1 to 10000000");
    steps.parts.push_back(part);
  }
  add_unique(card, r.steps, std::move(steps), &std::remove_reference_t<decltype(steps)>::sid);
}

/// SID NDT DT NO: the time steps, as those of TSTEP; the other fields control the iterations. The sign of sid tells
/// TSTEPNL from TSTEP, whose ids are separate.
void parse_tstepnl(Card& card, DynamicCards& r) {
  records::TimeSteps steps;
  steps.sid = -card.read_id(0, "SID");
  steps.at = card.get_location();
  records::TimeSteps::Part part;
  part.count = card.read_id(1, "NDT");
  part.step = card.read_real(2, "DT");
  part.every = card.read_int(3, "NO", 1);
  if (card.is_ok()) card.demand(part.step > 0, 2, "DT", "a number above 0");
  if (card.is_ok()) card.demand(part.count <= 10'000'000, 1, "NDT", "1 to 10000000");
  if (part.every <= 0) part.every = part.count;  // output at the last step
  card.use(4, card.get_size());
  steps.parts.push_back(part);
  add_unique(card, r.steps, std::move(steps), &std::remove_reference_t<decltype(steps)>::sid);
}

/// SID J K X Y TID.
void parse_randps(Card& card, DynamicCards& r) {
  records::SpectralTerm t;
  card.read_ids(0, {{"SID", t.sid}, {"J", t.j}, {"K", t.k}});
  card.read_reals(3, {{"X", t.x, 0.0}, {"Y", t.y, 0.0}});
  t.table = card.read_reference(5, "TID");
  t.at = card.get_location();
  if (card.is_ok())
    card.demand(t.k >= t.j, 2, "K", "J or a subcase above it: the other half of the matrix is its conjugate");
  if (card.is_ok() && t.j == t.k) {
    card.demand(t.x >= 0, 3, "X", "zero or above: an auto-spectral density is not negative");
    card.demand(t.y == 0, 4, "Y", "zero: an auto-spectral density is real");
  }
  if (card.is_ok()) r.spectral_terms.push_back(t);
}

/// SID N T0 TMAX.
void parse_randt1(Card& card, DynamicCards& r) {
  records::TimeLags lags;
  card.read_ids(0, {{"SID", lags.sid}, {"N", lags.count}});
  card.read_reals(2, {{"T0", lags.first, 0.0}, {"TMAX", lags.last}});
  lags.at = card.get_location();
  if (card.is_ok()) card.demand(lags.count <= 100'000, 1, "N", "1 to 100000");
  if (card.is_ok()) card.demand(lags.first >= 0, 2, "T0", "zero or above");
  if (card.is_ok()) card.demand(lags.last > lags.first, 3, "TMAX", "a number above T0");
  add_unique(card, r.lags, std::move(lags), &std::remove_reference_t<decltype(lags)>::sid);
}

/// SID RTYPE1 ID1 COMP1 RTYPE2 ID2 COMP2 CURID. A blank field of one output is that of the other.
void parse_rcross(Card& card, DynamicCards& r) {
  static const std::vector<std::string> types{"DISP", "VELO",   "ACCE",   "OLOAD", "SPCF",
                                              "MPCF", "STRESS", "STRAIN", "FORCE", "VAR"};
  records::CrossRequest request;
  request.sid = card.read_id(0, "SID");
  request.a = {card.read_word(1, "RTYPE1", "", types), card.read_reference(2, "ID1"), card.read_reference(3, "COMP1")};
  request.b = {card.read_word(4, "RTYPE2", "", types), card.read_reference(5, "ID2"), card.read_reference(6, "COMP2")};
  request.curve = card.read_reference(7, "CURID");
  request.at = card.get_location();
  const auto share = [](auto& a, auto& b, const auto& none) {
    if (a == none) a = b;
    if (b == none) b = a;
    return a != none;
  };
  const bool has_type = share(request.a.quantity, request.b.quantity, std::string());
  const bool has_id = share(request.a.id, request.b.id, 0);
  const bool has_component = share(request.a.component, request.b.component, 0);
  if (card.is_ok()) card.demand(has_type, 1, "RTYPE1", "a type of output here or in field 6");
  if (card.is_ok()) card.demand(has_id, 2, "ID1", "a grid here or in field 7");
  if (card.is_ok()) card.demand(has_component, 3, "COMP1", "a component here or in field 8");
  if (card.is_ok()) r.crosses.push_back(std::move(request));
}

/// TID XAXIS YAXIS FLAT, pairs from the second line on.
void parse_tabrnd1(Card& card, DynamicCards& r) {
  auto t = read_kind_head(card, &records::DynamicTable::id, "TID", 1);
  read_axes(card, t, "FLAT");
  add_unique(card, r.spectra, std::move(t), &std::remove_reference_t<decltype(t)>::id);
}

/// TID TYPE LU WG.
void parse_tabrndg(Card& card, DynamicCards& r) {
  records::GustSpectrum t;
  t.id = card.read_id(0, "TID");
  const int type = card.read_int(1, "TYPE", 1);
  t.is_dryden = type == 2;
  t.length_over_speed = card.read_real(2, "L/U");
  t.rms = card.read_real(3, "WG");
  t.at = card.get_location();
  if (card.is_ok()) card.demand(type == 1 || type == 2, 1, "TYPE", "1 (von Karman) or 2 (Dryden)");
  if (card.is_ok()) card.demand(t.length_over_speed > 0, 2, "L/U", "a number above 0");
  add_unique(card, r.gust_spectra, std::move(t), &std::remove_reference_t<decltype(t)>::id);
}

/// Digits of the components, none for a scalar point; ascending.
std::string read_digits(Card& card, int i) {
  const unsigned bits = card.read_components(i, "C", 0);
  std::string digits;
  for (int c = 1; c <= 6; ++c)
    if (bits & 1U << static_cast<unsigned>(c - 1)) digits += static_cast<char>('0' + c);
  return digits;
}

/// Pairs ID C from field `first` of the line on.
void read_residual_pairs(Card& card, int first, DynamicCards& r) {
  std::vector<records::ResidualDofs> read;
  for (int i = first; i + 1 < std::max(card.get_size() + 1, 8); i += 2) {
    if (card.is_blank(i, i + 2)) continue;
    const int g = card.read_id(i, "ID");
    read.push_back({g, g, read_digits(card, i + 1), card.get_location()});
  }
  if (read.empty() && card.is_ok()) card.fail("deck.missing-field", first, "ID is blank, expected a grid at least");
  if (card.is_ok()) r.residual_dofs.insert(r.residual_dofs.end(), read.begin(), read.end());
}
/// C ID1 ID2 ... or C ID1 THRU ID2, with BY and EXCEPT; an id alone between exceptions must exist.
void read_residual_list(Card& card, int first, DynamicCards& r) {
  const auto digits = read_digits(card, first);
  const auto list = read_id_list(card, first + 1, card.get_size(), "ID");
  if (!card.is_ok()) return;
  if (list.empty()) card.fail("deck.missing-field", first + 1, "ID is blank, expected a grid at least");
  for (const auto& range : list) {
    // Each piece between the exceptions is a range.
    auto except = range.except;
    if (range.step > 1)
      for (long id = range.first; id <= range.last; ++id)
        if ((id - range.first) % range.step != 0) except.push_back(static_cast<int>(id));
    std::sort(except.begin(), except.end());
    int from = range.first;
    const auto add = [&](int to) {
      if (from <= to) r.residual_dofs.push_back({from, to, digits, card.get_location()});
    };
    for (const int id : except) {
      add(id - 1);
      from = std::max(from, id + 1);
    }
    add(range.last);
  }
}

/// U6 of USET and USET1 asks for residual vectors; other sets belong to DMAP of the user.
bool is_residual_set(Card& card) {
  const auto set = card.get_upper(0);
  if (set == "U6") return true;
  card.use(0, card.get_size());
  card.warn("deck.user-set", 0, "the set " + set + " is not used", "U6 alone counts: residual vectors of its dofs");
  return false;
}
void parse_uset(Card& card, DynamicCards& r) {
  if (is_residual_set(card)) read_residual_pairs(card, 1, r);
}
void parse_uset1(Card& card, DynamicCards& r) {
  if (is_residual_set(card)) read_residual_list(card, 1, r);
}
void parse_rvdof(Card& card, DynamicCards& r) { read_residual_pairs(card, 0, r); }
void parse_rvdof1(Card& card, DynamicCards& r) { read_residual_list(card, 0, r); }

// Conversion of units. Tables are pure numbers over hertz or time: the units of a load are those of its DAREA, static
// loads or SPCD.

/// TYPE of a load over frequency or time: 0 force, 1 motion, 2 velocity, 3 acceleration.
int find_excitation(const std::string& type) {
  const auto word = make_upper(type);
  const char first = word.empty() ? 'L' : word[0];
  return first == 'D' || first == '1' ? 1 : first == 'V' || first == '2' ? 2 : first == 'A' || first == '3' ? 3 : 0;
}
void note_rload(const UnitConverter& u, UnitNotes& notes) {
  for (const int field : {4, 5}) notes.table_axes[u.get(field)].insert("Hz");
  notes.enforced[u.get(1)].insert(find_excitation(u.get(6)));
}
void note_tload(const UnitConverter& u, UnitNotes& notes) {
  notes.enforced[u.get(1)].insert(find_excitation(u.get(3)));
}
void note_tload1(const UnitConverter& u, UnitNotes& notes) {
  notes.table_axes[u.get(4)].insert("T");
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
void convert_freq(UnitConverter& u) { u.scale(1, u.size() - 1, "Hz"); }
void convert_tstep(UnitConverter& u) {
  for (int line = 0; line < u.size(); line += 8) u.scale(line + 2, "T");
}
/// Per hertz, as G of a table.
void convert_randps(UnitConverter& u) {
  if (u.get_int(5) == 0) u.scale(3, 4, "T");
}
void convert_tabrnd1(UnitConverter& u) {
  for (int i = 8; i < u.size(); i += 2) {
    u.scale(i, "Hz");
    u.scale(i + 1, "T");
  }
}
void convert_tabdmp1(UnitConverter& u) {
  for (int i = 8; i < u.size(); i += 2) u.scale(i, "Hz");
}

/// Dimension of the argument of a table by the loads that name it.
std::string find_table_axis(const UnitConverter& u) {
  const auto& axes = u.get_notes().table_axes;
  const auto found = axes.find(u.get(0));
  if (found != axes.end() && found->second.size() == 1) return *found->second.begin();
  return u.keeps_time() ? "." : "?";
}
void convert_tabled1(UnitConverter& u) {
  const auto axis = find_table_axis(u), value = find_table_value(u);
  for (int i = 8; i < u.size(); i += 2) {
    u.scale(i, axis);
    u.scale(i + 1, value);
  }
}
void convert_tabled2(UnitConverter& u) {
  u.scale(1, find_table_axis(u));
  convert_tabled1(u);
}
void scale_table_values(UnitConverter& u, int first, int step) {
  const auto value = find_table_value(u);
  for (int i = first; i < u.size(); i += step) u.scale(i, value);
}
/// Scales X1 and X2; the table is one of (x - X1) / X2.
void convert_tabled3(UnitConverter& u) {
  u.scale(1, 2, find_table_axis(u));
  scale_table_values(u, 9, 2);
}
void convert_tabled4(UnitConverter& u) {
  u.scale(1, 4, find_table_axis(u));
  scale_table_values(u, 8, 1);
}

}  // namespace

const DynamicParserTable& get_dynamic_parsers() {
  static const DynamicParserTable table = [] {
    DynamicParserTable all{{"RLOAD1", {parse_rload1, nullptr, convert_load, note_rload}},
                           {"RLOAD2", {parse_rload2, nullptr, convert_load, note_rload}},
                           {"TLOAD1", {parse_tload1, nullptr, convert_tload1, note_tload1}},
                           {"TLOAD2", {parse_tload2, nullptr, convert_tload2, note_tload}},
                           {"DLOAD", {parse_dload, ""}},
                           {"DAREA", {parse_darea, nullptr, convert_darea}},
                           {"DELAY", {parse_delay, ". . . T . . T"}},
                           {"DPHASE", {parse_dphase, ""}},
                           {"LSEQ", {parse_lseq, ""}},
                           {"TIC", {parse_tic, nullptr, convert_tic}},
                           {"TABLED1", {parse_tabled1, nullptr, convert_tabled1}},
                           {"TABLED2", {parse_tabled2, nullptr, convert_tabled2}},
                           {"TABLED3", {parse_tabled3, nullptr, convert_tabled3}},
                           {"TABLED4", {parse_tabled4, nullptr, convert_tabled4}},
                           {"TABDMP1", {parse_tabdmp1, nullptr, convert_tabdmp1}},
                           {"FREQ", {parse_freq, nullptr, convert_freq}},
                           {"FREQ1", {parse_freq1, ". Hz Hz ."}},
                           {"FREQ2", {parse_freq2, ". Hz Hz ."}},
                           {"FREQ3", {parse_freq3, ". Hz Hz . . ."}},
                           {"FREQ4", {parse_freq4, ". Hz Hz . ."}},
                           {"FREQ5", {parse_freq5, ". Hz Hz"}},
                           {"TSTEP", {parse_tstep, nullptr, convert_tstep}},
                           {"TSTEPNL", {parse_tstepnl, ". . T"}},
                           {"USET", {parse_uset, ""}},
                           {"USET1", {parse_uset1, ""}},
                           {"RVDOF", {parse_rvdof, ""}},
                           {"RVDOF1", {parse_rvdof1, ""}},
                           {"RANDPS", {parse_randps, nullptr, convert_randps}},
                           {"RANDT1", {parse_randt1, ". . T T"}},
                           {"RCROSS", {parse_rcross, ""}},
                           {"TABRND1", {parse_tabrnd1, nullptr, convert_tabrnd1}},
                           {"TABRNDG", {parse_tabrndg, ". . T ?"}}};
    add_frequency_table_parsers(all);
    return all;
  }();
  return table;
}

int records::DynamicSelection::*find_selection_of(std::string_view card) {
  using records::DynamicSelection;
  if (card.substr(0, 4) == "FREQ") return &DynamicSelection::frequency;
  if (card == "TSTEP" || card == "TSTEPNL") return &DynamicSelection::tstep;
  if (card == "TIC") return &DynamicSelection::ic;
  if (card == "RANDPS" || card == "RANDT1") return &DynamicSelection::random;
  if (card == "RCROSS") return &DynamicSelection::rcross;
  if (card == "TABDMP1") return &DynamicSelection::sdamping;
  if (card == "EIGC") return &DynamicSelection::cmethod;
  if (card == "TF") return &DynamicSelection::tfl;
  if (card == "RGYRO") return &DynamicSelection::rgyro;
  if (card == "ROTORD") return &DynamicSelection::rmethod;
  return nullptr;
}

}  // namespace bough::nastran::detail
