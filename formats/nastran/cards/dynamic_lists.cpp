/// Lists of frequencies and times, random excitation, residual vectors. Source of the fields: MSC Nastran Quick
/// Reference Guide, the entries named.
#include <algorithm>

#include "formats/nastran/detail/card_sink.hpp"
#include "formats/nastran/detail/dynamic_cards.hpp"
#include "formats/nastran/detail/field_list.hpp"
#include "formats/nastran/detail/text.hpp"
#include "formats/nastran/detail/unit_converter.hpp"
#include "formats/nastran/detail/write_order.hpp"

namespace bough::nastran::detail {
namespace {

using records::DynamicCards;

using records::FrequencyList;

FrequencyList read_list(Card& card, int kind, void (*list)(FieldList&, FrequencyList&)) {
  FrequencyList frequencies;
  frequencies.kind = kind;
  read_fields(card, list, frequencies);
  return frequencies;
}
void add_list(Card& card, DynamicCards& r, FrequencyList list) {
  if (card.is_ok()) r.frequencies.push_back(std::move(list));
}

void list_freq(FieldList& f, FrequencyList& list) { f.id("SID", list.sid); }
void parse_freq(Card& card, DynamicCards& r) {
  auto list = read_list(card, 0, list_freq);
  for (int i = 1; i < card.get_size(); ++i) {
    if (card.is_blank(i)) continue;
    list.values.push_back(card.read_real(i, "F"));
    if (card.is_ok()) card.demand(list.values.back() >= 0, i, "F", "zero or above");
  }
  if (card.is_ok() && list.values.empty()) card.fail("deck.missing-field", 1, "no frequency is given");
  add_list(card, r, std::move(list));
}

void list_freq1(FieldList& f, FrequencyList& list) {
  f.id("SID", list.sid).real("F1", list.f1).real("DF", list.f2).integer("NDF", list.count, 1);
}
void parse_freq1(Card& card, DynamicCards& r) {
  auto list = read_list(card, 1, list_freq1);
  if (card.is_ok()) card.demand(list.f1 >= 0, 1, "F1", "zero or above");
  if (card.is_ok()) card.demand(list.f2 > 0, 2, "DF", "a number above 0");
  if (card.is_ok()) card.demand(list.count > 0 && list.count <= 1'000'000, 3, "NDF", "1 to 1000000");
  add_list(card, r, std::move(list));
}

/// SID F1 F2 of FREQ2 to FREQ4; F2 is F1 if blank.
FieldList& list_range(FieldList& f, FrequencyList& list) {
  f.id("SID", list.sid);
  if (list.kind == 4)
    f.real("F1", list.f1, 0.0);
  else
    f.real("F1", list.f1);
  return f.real("F2", list.f2, list.f1);
}
void list_freq2(FieldList& f, FrequencyList& list) { list_range(f, list).integer("NF", list.count, 1); }
void list_freq3(FieldList& f, FrequencyList& list) {
  list_range(f, list).flag("TYPE", list.is_log, "LINEAR", "LOG").integer("NEF", list.count, 10);
  f.real("CLUSTER", list.spread, 1.0);
}
void list_freq4(FieldList& f, FrequencyList& list) {
  list_range(f, list).real("FSPD", list.spread, 0.1).integer("NFM", list.count, 3);
}
void demand_range(Card& card, const FrequencyList& list, bool starts_above_zero) {
  if (card.is_ok() && starts_above_zero) card.demand(list.f1 > 0, 1, "F1", "a number above 0");
  if (card.is_ok()) card.demand(list.f1 >= 0, 1, "F1", "zero or above");
  if (card.is_ok()) card.demand(list.f2 >= list.f1 && list.f2 > 0, 2, "F2", "a number above 0, not below F1");
}
void parse_freq2(Card& card, DynamicCards& r) {
  auto list = read_list(card, 2, list_freq2);
  demand_range(card, list, true);
  if (card.is_ok()) card.demand(list.count > 0 && list.count <= 1'000'000, 3, "NF", "1 to 1000000");
  add_list(card, r, std::move(list));
}
void parse_freq3(Card& card, DynamicCards& r) {
  auto list = read_list(card, 3, list_freq3);
  demand_range(card, list, list.is_log);
  if (card.is_ok()) card.demand(list.count > 1 && list.count <= 100'000, 4, "NEF", "2 to 100000");
  if (card.is_ok()) card.demand(list.spread > 0, 5, "CLUSTER", "a number above 0");
  add_list(card, r, std::move(list));
}
void parse_freq4(Card& card, DynamicCards& r) {
  auto list = read_list(card, 4, list_freq4);
  demand_range(card, list, false);
  if (card.is_ok()) card.demand(list.spread > 0 && list.spread < 1, 3, "FSPD", "a number between 0 and 1");
  if (card.is_ok()) card.demand(list.count > 0 && list.count <= 100'000, 4, "NFM", "1 to 100000");
  add_list(card, r, std::move(list));
}

void list_freq5(FieldList& f, FrequencyList& list) {
  f.id("SID", list.sid).real("F1", list.f1, 0.0).real("F2", list.f2, 1e20);
}
void parse_freq5(Card& card, DynamicCards& r) {
  auto list = read_list(card, 5, list_freq5);
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
  card.use_unkept(4, card.get_size());
  steps.parts.push_back(part);
  add_unique(card, r.steps, std::move(steps), &std::remove_reference_t<decltype(steps)>::sid);
}

void list_randps(FieldList& f, records::SpectralTerm& t) {
  f.id("SID", t.sid).id("J", t.j).id("K", t.k).real("X", t.x, 0.0).real("Y", t.y, 0.0).reference("TID", t.table);
}
void parse_randps(Card& card, DynamicCards& r) {
  records::SpectralTerm t;
  read_fields(card, list_randps, t);
  if (card.is_ok())
    card.demand(t.k >= t.j, 2, "K", "J or a subcase above it: the other half of the matrix is its conjugate");
  if (card.is_ok() && t.j == t.k) {
    card.demand(t.x >= 0, 3, "X", "zero or above: an auto-spectral density is not negative");
    card.demand(t.y == 0, 4, "Y", "zero: an auto-spectral density is real");
  }
  if (card.is_ok()) r.spectral_terms.push_back(t);
}

void list_randt1(FieldList& f, records::TimeLags& lags) {
  f.id("SID", lags.sid).id("N", lags.count).real("T0", lags.first, 0.0).real("TMAX", lags.last);
}
void parse_randt1(Card& card, DynamicCards& r) {
  records::TimeLags lags;
  read_fields(card, list_randt1, lags);
  if (card.is_ok()) card.demand(lags.count <= 100'000, 1, "N", "1 to 100000");
  if (card.is_ok()) card.demand(lags.first >= 0, 2, "T0", "zero or above");
  if (card.is_ok()) card.demand(lags.last > lags.first, 3, "TMAX", "a number above T0");
  add_unique(card, r.lags, std::move(lags), &std::remove_reference_t<decltype(lags)>::sid);
}

void list_output(FieldList& f, records::CrossRequest::Output& output, const char* const names[3]) {
  f.word(names[0], output.quantity, "",
         {"DISP", "VELO", "ACCE", "OLOAD", "SPCF", "MPCF", "STRESS", "STRAIN", "FORCE", "VAR"});
  f.reference(names[1], output.id).reference(names[2], output.component);
}
void list_rcross(FieldList& f, records::CrossRequest& request) {
  static constexpr const char* const first[] = {"RTYPE1", "ID1", "COMP1"};
  static constexpr const char* const second[] = {"RTYPE2", "ID2", "COMP2"};
  f.id("SID", request.sid);
  list_output(f, request.a, first);
  list_output(f, request.b, second);
  f.reference("CURID", request.curve);
}
/// A blank field of one output is that of the other.
void parse_rcross(Card& card, DynamicCards& r) {
  records::CrossRequest request;
  read_fields(card, list_rcross, request);
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

void write_frequencies(const DynamicCards& cards, CardSink& sink) {
  for (const auto& list : cards.frequencies) {
    auto card = list.kind == 0   ? make_fields("FREQ", list_freq, list)
                : list.kind == 1 ? make_fields("FREQ1", list_freq1, list)
                : list.kind == 2 ? make_fields("FREQ2", list_freq2, list)
                : list.kind == 3 ? make_fields("FREQ3", list_freq3, list)
                : list.kind == 4 ? make_fields("FREQ4", list_freq4, list)
                                 : make_fields("FREQ5", list_freq5, list);
    for (const double value : list.values) card.add(value);
    sink.put(card);
  }
}
void write_time_steps(const DynamicCards& cards, CardSink& sink) {
  for (const auto& steps : cards.steps) {
    CardFields card(steps.sid < 0 ? "TSTEPNL" : "TSTEP");
    card.add(std::abs(steps.sid));
    for (const auto& part : steps.parts) {
      if (&part != &steps.parts.front()) card.end_line().add_blank();
      card.add(part.count).add(part.step).add(part.every);
    }
    sink.put(card);
  }
}
void write_random_cards(const DynamicCards& cards, CardSink& sink) {
  for (const auto& t : cards.spectral_terms) sink.put(make_fields("RANDPS", list_randps, t));
  for (const auto& lags : cards.lags) sink.put(make_fields("RANDT1", list_randt1, lags));
  for (const auto& request : cards.crosses) sink.put(make_fields("RCROSS", list_rcross, request));
}
/// A point is written as RVDOF, a range of points as RVDOF1.
void write_residual_dofs(const DynamicCards& cards, CardSink& sink) {
  for (const auto& dofs : cards.residual_dofs) {
    const bool is_range = dofs.last > dofs.first;
    CardFields card(is_range ? "RVDOF1" : "RVDOF");
    const auto add_components = [&] { dofs.components.empty() ? card.add_blank() : card.add_word(dofs.components); };
    if (is_range) add_components();
    card.add(dofs.first);
    if (is_range)
      card.add_word("THRU").add(dofs.last);
    else
      add_components();
    sink.put(card);
  }
}

void convert_freq(UnitConverter& u) { u.scale(1, u.size() - 1, "Hz"); }
void convert_tstep(UnitConverter& u) {
  for (int line = 0; line < u.size(); line += 8) u.scale(line + 2, "T");
}
/// Per hertz, as G of a table.
void convert_randps(UnitConverter& u) {
  if (u.get_int(5) == 0) u.scale(3, 4, "T");
}

}  // namespace

void add_dynamic_lists(DynamicParserTable& table) {
  table["FREQ"] = {parse_freq, nullptr, convert_freq};
  table["FREQ"].names = name_fields(list_freq);
  table["FREQ1"] = {parse_freq1, ". Hz Hz ."};
  table["FREQ1"].names = name_fields(list_freq1);
  table["FREQ2"] = {parse_freq2, ". Hz Hz ."};
  table["FREQ2"].names = name_fields(list_freq2);
  table["FREQ3"] = {parse_freq3, ". Hz Hz . . ."};
  table["FREQ3"].names = name_fields(list_freq3);
  table["FREQ4"] = {parse_freq4, ". Hz Hz . ."};
  table["FREQ4"].names = name_fields(list_freq4);
  table["FREQ5"] = {parse_freq5, ". Hz Hz"};
  table["FREQ5"].names = name_fields(list_freq5);
  table["TSTEP"] = {parse_tstep, nullptr, convert_tstep};
  table["TSTEP"].names = "SID N DT NO";
  table["TSTEPNL"] = {parse_tstepnl, ". . T"};
  table["TSTEPNL"].names = "SID NDT DT NO";
  table["USET"] = {parse_uset, ""};
  table["USET1"] = {parse_uset1, ""};
  table["RVDOF"] = {parse_rvdof, ""};
  table["RVDOF"].names = "ID1 C1 ID2 C2 ID3 C3 ID4 C4";
  table["RVDOF1"] = {parse_rvdof1, ""};
  table["RANDPS"] = {parse_randps, nullptr, convert_randps};
  table["RANDPS"].names = name_fields(list_randps);
  table["RANDT1"] = {parse_randt1, ". . T T"};
  table["RANDT1"].names = name_fields(list_randt1);
  table["RCROSS"] = {parse_rcross, ""};
  table["RCROSS"].names = name_fields(list_rcross);
  set_writer(table, write_frequencies, {"FREQ", "FREQ1", "FREQ2", "FREQ3", "FREQ4", "FREQ5"});
  set_writer(table, write_time_steps, {"TSTEP", "TSTEPNL"});
  set_writer(table, write_random_cards, {"RANDPS", "RANDT1", "RCROSS"});
  set_writer(table, write_residual_dofs, {"RVDOF", "RVDOF1"});
  table["USET"].written_as = "RVDOF";
  table["USET1"].written_as = "RVDOF1";
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
