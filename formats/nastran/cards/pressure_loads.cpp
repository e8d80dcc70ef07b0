#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {
namespace {

constexpr int kMaxElements = 1'000'000;

/// SID G F G1 G2 (G3 G4).
void parse_directed(Card& card, Reading& r, bool is_moment, bool is_cross) {
  records::DirectedLoad load;
  load.is_moment = is_moment;
  load.is_cross = is_cross;
  load.sid = card.read_id(0, "SID");
  load.g = card.read_id(1, "G");
  load.f = card.read_real(2, is_moment ? "M" : "F", 0.0);
  static const char* const names[] = {"G1", "G2", "G3", "G4"};
  for (int i = 0; i < (is_cross ? 4 : 2); ++i) load.grids[static_cast<std::size_t>(i)] = card.read_id(3 + i, names[i]);
  load.at = card.get_location();
  if (card.is_ok()) r.deck.load_cards.directed.push_back(load);
}
void parse_force1(Card& card, Reading& r) { parse_directed(card, r, false, false); }
void parse_force2(Card& card, Reading& r) { parse_directed(card, r, false, true); }
void parse_moment1(Card& card, Reading& r) { parse_directed(card, r, true, false); }
void parse_moment2(Card& card, Reading& r) { parse_directed(card, r, true, true); }

/// SID P G1 G2 G3 G4.
void parse_pload(Card& card, Reading& r) {
  records::GridPressure load;
  load.sid = card.read_id(0, "SID");
  load.p = card.read_real(1, "P");
  load.grids = {card.read_id(2, "G1"), card.read_id(3, "G2"), card.read_id(4, "G3")};
  if (const int g4 = card.read_id(5, "G4", 0); g4 > 0) load.grids.push_back(g4);
  load.at = card.get_location();
  if (card.is_ok()) r.deck.load_cards.grid_pressures.push_back(std::move(load));
}

/// SID EID TYPE SCALE X1 P1 X2 P2.
void parse_pload1(Card& card, Reading& r) {
  static const std::vector<std::string> types{"FX", "FY", "FZ", "FXE", "FYE", "FZE",
                                              "MX", "MY", "MZ", "MXE", "MYE", "MZE"};
  records::BeamLoad load;
  load.sid = card.read_id(0, "SID");
  load.element = card.read_id(1, "EID");
  const std::string type = card.read_word(2, "TYPE", "", types);
  const std::string scale = card.read_word(3, "SCALE", "", {"LE", "FR", "LEPR", "FRPR"});
  if (card.is_ok() && type.empty()) card.fail("deck.missing-field", 2, "TYPE is blank, expected FX to MZE");
  if (card.is_ok() && scale.empty())
    card.fail("deck.missing-field", 3, "SCALE is blank, expected LE, FR, LEPR or FRPR");
  load.x1 = card.read_real(4, "X1", 0.0);
  load.p1 = card.read_real(5, "P1", 0.0);
  load.x2 = card.read_optional_real(6, "X2");
  load.p2 = card.read_real(7, "P2", 0.0);  // not P1: MSC and NX taper to zero
  load.at = card.get_location();
  card.demand(load.x1 >= 0, 4, "X1", "zero or more");
  card.demand(!load.x2 || *load.x2 >= load.x1, 6, "X2", "X1 or more");
  if (!card.is_ok()) return;
  load.is_moment = type[0] == 'M';
  load.axis = type[1] - 'X';
  load.in_element_axes = type.size() == 3;
  load.is_fraction = scale[0] == 'F';
  load.is_projected = scale.size() == 4;
  r.deck.load_cards.beams.push_back(load);
}

/// The ids of "EID1 THRU EID2" become one record each; those that do not exist are skipped.
void add_range(Card& card, Reading& r, records::ElementPressure load, int first, int last, int field) {
  if (last < first || last - first > kMaxElements) {
    card.fail("deck.bad-list", field,
              "the range " + std::to_string(first) + " THRU " + std::to_string(last) + " is empty or too long",
              "give the smaller id first");
    return;
  }
  load.skip_if_missing = true;
  for (load.element = first; load.element <= last; ++load.element) r.deck.load_cards.pressures.push_back(load);
}

/// SID P EID1 ... EID6, or SID P EID1 THRU EID2.
void parse_pload2(Card& card, Reading& r) {
  records::ElementPressure load;
  load.sid = card.read_id(0, "SID");
  load.p.fill(card.read_real(1, "P"));
  load.at = card.get_location();
  if (card.is_word(3, "THRU")) {
    card.use(3);
    const int first = card.read_id(2, "EID1"), last = card.read_id(4, "EID2");
    if (card.is_ok()) add_range(card, r, load, first, last, 4);
    return;
  }
  const auto elements = read_ids(card, 2, card.get_size(), "EID");
  if (elements.empty() && card.is_ok()) card.fail("deck.missing-field", 2, "EID1 is blank, expected an element");
  if (!card.is_ok()) return;
  for (const int element : elements) {
    load.element = element;
    r.deck.load_cards.pressures.push_back(load);
  }
}

/// SID EID P1 P2 P3 P4 G1 G3/G4 (or THRU EID2), CID N1 N2 N3 SORL LDIR.
void parse_pload4(Card& card, Reading& r) {
  records::ElementPressure load;
  load.sid = card.read_id(0, "SID");
  load.element = card.read_id(1, "EID");
  load.p[0] = card.read_real(2, "P1", 0.0);
  static const char* const names[] = {"P1", "P2", "P3", "P4"};
  for (int i = 1; i < 4; ++i) load.p[static_cast<std::size_t>(i)] = card.read_real(2 + i, names[i], load.p[0]);
  const bool is_range = card.is_word(6, "THRU");
  int last = 0;
  if (is_range) {
    card.use(6);
    last = card.read_id(7, "EID2");
  } else {
    load.g1 = card.read_id(6, "G1", 0);
    load.g34 = card.read_id(7, "G3 or G4", 0);
  }
  load.cid = card.read_reference(8, "CID");
  card.use(13);  // LDIR
  if (const Eigen::Vector3d n = card.read_vector(9, "N1 N2 N3"); !n.isZero(0)) load.n = n;
  if (card.read_word(12, "SORL", "SURF", {"SURF", "LINE"}) == "LINE")
    card.fail("deck.bad-word", 12, "SORL is LINE: loads along edges are not supported, expected SURF",
              "give the edge load as forces on its grids");
  load.at = card.get_location();
  if (!card.is_ok()) return;
  if (is_range)
    add_range(card, r, load, load.element, last, 7);
  else
    r.deck.load_cards.pressures.push_back(load);
}

/// PLOAD3 of NASTRAN-95: SID P EID1 G11 G12 EID2 G21 G22, positive outward on the face with the corners G11 and G12
/// (User's Manual, PLOAD3, remark 4).
void parse_pload3(Card& card, Reading& r) {
  records::ElementPressure load;
  load.sid = card.read_id(0, "SID");
  load.p.fill(-card.read_real(1, "P"));
  load.at = card.get_location();
  for (const int i : {2, 5}) {
    if (i > 2 && card.is_blank(i, i + 3)) break;
    load.element = card.read_id(i, "EID");
    load.g1 = card.read_id(i + 1, "G1");
    load.g34 = card.read_id(i + 2, "G2");
    if (card.is_ok()) r.deck.load_cards.pressures.push_back(load);
  }
}

/// SID G CID A R1 R2 R3 METHOD, RACC.
void parse_rforce(Card& card, Reading& r) {
  records::Rotation load;
  load.sid = card.read_id(0, "SID");
  load.g = card.read_reference(1, "G");
  load.cid = card.read_reference(2, "CID");
  load.a = card.read_real(3, "A", 0.0);
  load.r = card.read_vector(4, "R1 R2 R3");
  load.racc = card.read_real(8, "RACC", 0.0);
  card.use(7);      // METHOD
  card.use(9, 11);  // MB, IDRF
  load.at = card.get_location();
  if (card.is_ok() && load.r.isZero(0) && (load.a != 0 || load.racc != 0))
    card.fail("deck.field-range", 4, "R1 R2 R3 are all zero", "give the axis of rotation");
  if (card.is_ok()) r.deck.load_cards.rotations.push_back(load);
}

/// SID G1 C1 D1 G2 C2 D2.
void parse_spcd(Card& card, Reading& r) { parse_motions(card, r.deck.load_cards.spcd); }

/// SID S1 F1 S2 F2 S3 F3.
void parse_sload(Card& card, Reading& r) {
  const int sid = card.read_id(0, "SID");
  for (const int i : {1, 3, 5}) {
    if (i > 1 && card.is_blank(i, i + 2)) continue;
    const int point = card.read_id(i, "S");
    const double f = card.read_real(i + 1, "F");
    if (card.is_ok()) r.deck.load_cards.scalar.push_back({sid, point, f, card.get_location()});
  }
}

using records::ElementPressure;

void write_beam_load(const records::BeamLoad& load, CardSink& sink) {
  std::string type{load.is_moment ? 'M' : 'F', static_cast<char>('X' + load.axis)};
  if (load.in_element_axes) type += 'E';
  std::string scale = load.is_fraction ? "FR" : "LE";
  if (load.is_projected) scale += "PR";
  CardFields card("PLOAD1");
  card.add(load.sid).add(load.element).add_word(type).add_word(scale).add(load.x1).add(load.p1);
  card.add(load.x2);
  sink.put(card.add(load.p2));
}

/// Equal but for the element, which is the next one.
bool follows(const ElementPressure& a, const ElementPressure& b) {
  return b.skip_if_missing && b.element == a.element + 1 && b.sid == a.sid && b.p == a.p && b.cid == a.cid &&
         b.n == a.n;
}

/// PLOAD2 and PLOAD4 are one record; ranges become ranges again.
void write_pressures(const std::vector<ElementPressure>& loads, CardSink& sink) {
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const auto& load = loads[i];
    CardFields card("PLOAD4");
    card.add(load.sid).add(load.element);
    for (const double p : load.p) card.add(p);
    if (load.skip_if_missing) {
      while (i + 1 < loads.size() && follows(loads[i], loads[i + 1])) ++i;
      card.add_word("THRU").add(loads[i].element);
    } else {
      card.add_id(load.g1).add_id(load.g34);
    }
    card.add_id(load.cid);
    if (load.n) card.add(*load.n);
    sink.put(card);
  }
}

void write_directed(const records::Deck& deck, CardSink& sink) {
  for (const auto& load : deck.load_cards.directed) {
    CardFields card(std::string(load.is_moment ? "MOMENT" : "FORCE") + (load.is_cross ? "2" : "1"));
    card.add(load.sid).add(load.g).add(load.f);
    for (const int grid : load.grids) card.add_id(grid);
    sink.put(card);
  }
}

void write_beam_loads(const records::Deck& deck, CardSink& sink) {
  for (const auto& load : deck.load_cards.beams) write_beam_load(load, sink);
}

void write_grid_pressures(const records::Deck& deck, CardSink& sink) {
  for (const auto& load : deck.load_cards.grid_pressures) {
    CardFields card("PLOAD");
    card.add(load.sid).add(load.p);
    for (const int grid : load.grids) card.add(grid);
    sink.put(card);
  }
}

void write_element_pressures(const records::Deck& deck, CardSink& sink) {
  write_pressures(deck.load_cards.pressures, sink);
}

void write_rotations(const records::Deck& deck, CardSink& sink) {
  for (const auto& load : deck.load_cards.rotations)
    sink.put(CardFields("RFORCE").add(load.sid).add(load.g).add_id(load.cid).add(load.a).add(load.r).add_blank().add(
        load.racc));
}

void write_spcd(const records::Deck& deck, CardSink& sink) {
  for (const auto& load : deck.load_cards.spcd)
    sink.put(CardFields("SPCD").add(load.sid).add(load.g).add_components(load.c).add(load.d));
}

void write_scalar_loads(const records::Deck& deck, CardSink& sink) {
  for (const auto& load : deck.load_cards.scalar)
    sink.put(CardFields("SLOAD").add(load.sid).add(load.point).add(load.f));
}

void convert_pload1(UnitConverter& u) {
  const auto type = make_upper(u.get(2)), kind = make_upper(u.get(3));
  const bool is_moment = type.starts_with("M");
  const bool is_point = u.get(6).empty() || u.get(6) == u.get(4);
  const char* word = is_moment ? (is_point ? "Q" : "F") : (is_point ? "F" : "K");
  u.scale(5, word);
  u.scale(7, word);
  if (!kind.starts_with("LE")) return;
  u.scale(4, "L");
  u.scale(6, "L");
}
/// Where an SPCD is the excitation of a load of TYPE VELO or ACCE it is a velocity or acceleration.
void convert_spcd(UnitConverter& u) {
  const auto& enforced = u.get_notes().enforced;
  const auto found = enforced.find(u.get(0));
  const bool is_excited = found != enforced.end();
  const int order = is_excited && *found->second.begin() > 0 ? *found->second.begin() - 1 : 0;
  static constexpr const char *length[] = {"L", "V", "G"}, *angle[] = {".", "Hz", "Hz2"};
  for (const int first : {1, 4}) {
    if (parse_real(u.get(first + 2)).value_or(0) == 0) continue;
    if (is_excited && found->second.size() > 1 && !u.keeps_time())
      u.scale(first + 2, "?");
    else
      u.scale_by(u.find_components(first + 1), first + 2, length[order], angle[order], "?");
  }
}
void convert_sload(UnitConverter& u) {
  for (const int i : {1, 3, 5})
    if (!u.get(i).empty()) u.scale(i + 1, u.get_notes().grids.count(u.get(i)) > 0 ? "F" : "?");
}

}  // namespace

void add_pressure_parsers(ParserTable& table) {
  table["FORCE1"] = {parse_force1, ". . F"};
  table["FORCE2"] = {parse_force2, ". . F"};
  table["MOMENT1"] = {parse_moment1, ". . Q"};
  table["MOMENT2"] = {parse_moment2, ". . Q"};
  table["PLOAD"] = {parse_pload, ". P"};
  table["PLOAD1"] = {parse_pload1, nullptr, "SID EID TYPE SCALE X1 P1 X2 P2"};
  table["PLOAD2"] = {parse_pload2, ". P", "SID P"};
  table["PLOAD3"] = {parse_pload3, ". P"};
  table["PLOAD4"] = {parse_pload4, ". . P P P P", "SID EID P1 P2 P3 P4"};
  table["RFORCE"] = {parse_rforce, ". . . Hz . . . . Hz2", "SID G CID A R1 R2 R3 METHOD RACC"};
  table["SPCD"] = {parse_spcd, nullptr, "SID G1 C1 D1 G2 C2 D2"};
  table["SLOAD"] = {parse_sload, nullptr};
  table["PLOAD1"].convert = convert_pload1;
  table["SPCD"].convert = convert_spcd;
  table["SLOAD"].convert = convert_sload;
  write_by(table, write_directed, {"FORCE1", "FORCE2", "MOMENT1", "MOMENT2"});
  write_by(table, {{"PLOAD1", write_beam_loads}, {"PLOAD", write_grid_pressures}, {"PLOAD4", write_element_pressures}});
  write_as(table, "PLOAD4", {"PLOAD2", "PLOAD3"});
  write_by(table, {{"RFORCE", write_rotations}, {"SPCD", write_spcd}, {"SLOAD", write_scalar_loads}});
}

}  // namespace bough::nastran::detail
