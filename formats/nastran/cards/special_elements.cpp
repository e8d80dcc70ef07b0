#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {
namespace {

using records::GridComponent;

/// PID MID A I1 I2 I12 J NSM, K1 K2 M1 M2 N1 N2 SECTION, then lines Y Z C MID.
void parse_pbcomp(Card& card, Reading& r) {
  records::Pbcomp p;
  p.id = card.read_id(0, "PID");
  p.mid = card.read_id(1, "MID");
  card.read_reals(2, {{"A", p.A, 0.0}, {"I1", p.I1, 0.0}, {"I2", p.I2, 0.0}, {"I12", p.I12, 0.0}});
  card.read_reals(6, {{"J", p.J, 0.0}, {"NSM", p.nsm, 0.0}, {"K1", p.k1, 1.0}, {"K2", p.k2, 1.0}});
  p.m = card.read_point(10, "M1 M2");
  p.n = card.read_point(12, "N1 N2");
  p.section = card.read_int(14, "SECTION", 0);
  p.at = card.get_location();
  card.demand(p.A > 0, 2, "A", "a positive area");
  card.demand(p.section >= 0 && p.section <= 5, 14, "SECTION", "0 to 5");
  for (int i = 16; i < card.get_size(); i += 8) {
    if (card.is_blank(i, i + 8)) continue;
    records::Pbcomp::Lump lump;
    lump.r = card.read_point(i, "Y Z");
    lump.fraction = card.read_real(i + 2, "C", 0.0);
    lump.mid = card.read_id(i + 3, "MID", p.mid);
    card.demand(lump.fraction >= 0, i + 2, "C", "a fraction that is not negative");
    p.lumps.push_back(lump);
  }
  if (r.claim(IdSpace::BeamProperty, p.id, card)) r.deck.special.pbcomp.push_back(std::move(p));
}

bool is_section_word(const Card& card, int i) {
  return card.is_word(i, "UD") || card.is_word(i, "K") || card.is_word(i, "Z") || card.is_word(i, "S");
}

/// Pairs G C up to the next section; the first line of a section has a blank after its word.
int read_pairs(Card& card, int i, std::vector<GridComponent>& pairs) {
  while (i < card.get_size() && !is_section_word(card, i)) {
    if (card.is_blank(i)) {
      ++i;
      continue;
    }
    const int g = card.read_id(i, "U");
    pairs.push_back({g, card.read_component(i + 1, "C")});
    i += 2;
  }
  return i;
}

/// EID, pairs UI C; UD, pairs; K or Z with the columns from the diagonal on; S by rows.
void parse_genel(Card& card, Reading& r) {
  records::Genel e;
  e.id = card.read_id(0, "EID");
  e.at = card.get_location();
  int i = read_pairs(card, 2, e.ui);
  if (card.is_word(i, "UD")) i = read_pairs(card, i + 1, e.ud);
  card.use(1, card.get_size());  // superfluous fields are reported below
  const auto m = static_cast<Eigen::Index>(e.ui.size()), n = static_cast<Eigen::Index>(e.ud.size());
  if (card.is_ok() && m == 0) card.fail("deck.missing-field", 2, "UI1 is blank, expected a component at least");
  if (card.is_ok() && !card.is_word(i, "K") && !card.is_word(i, "Z"))
    card.fail("deck.missing-field", i, "neither K nor Z is given", "begin a line with K or Z and its terms");
  if (!card.is_ok()) return;
  e.is_flexibility = card.is_word(i, "Z");
  e.matrix.setZero(m, m);
  for (Eigen::Index column = 0; column < m; ++column)
    for (Eigen::Index row = column; row < m; ++row)
      e.matrix(row, column) = e.matrix(column, row) = card.read_real(++i, "KZ", 0.0);
  while (++i < card.get_size() && card.is_blank(i)) {
  }
  if (card.is_word(i, "S")) {
    e.s.setZero(m, n);
    for (Eigen::Index row = 0; row < m; ++row)
      for (Eigen::Index column = 0; column < n; ++column) e.s(row, column) = card.read_real(++i, "S", 0.0);
    ++i;
  }
  if (card.is_ok() && i < card.get_size())
    card.fail("deck.too-many-fields", i, "more fields than K or Z and S of its components have",
              "K or Z has " + std::to_string(m * (m + 1) / 2) + " terms, S has " + std::to_string(m * n));
  if (r.claim(IdSpace::General, e.id, card)) r.deck.special.genel.push_back(std::move(e));
}

/// EID PID GA GB: PID blank is EID.
template <class Element>
void read_two_ends(Card& card, Element& e) {
  card.read_ids(0, {{"EID", e.id}, {"PID", e.pid, &e.id}, {"GA", e.ga}, {"GB", e.gb}});
}

/// EID PID GA GB X1 X2 X3 CID; X1 alone is a grid.
void parse_cgap(Card& card, Reading& r) {
  records::Cgap e;
  read_two_ends(card, e);
  if (card.is_integer(4) && card.is_blank(5, 7))
    e.g0 = card.read_id(4, "G0");
  else if (!card.is_blank(4, 7))
    e.v = card.read_vector(4, "X1 X2 X3");
  if (!card.is_blank(7)) e.cid = card.read_reference(7, "CID");
  e.at = card.get_location();
  if (r.claim(IdSpace::Gap, e.id, card)) r.deck.special.cgap.push_back(e);
}

/// PID U0 F0 KA KB KT MU1 MU2; KB = 1e-14 KA, KT = MU1 KA.
void parse_pgap(Card& card, Reading& r) {
  records::Pgap p;
  p.id = card.read_id(0, "PID");
  card.read_reals(1, {{"U0", p.u0, 0.0}, {"F0", p.f0, 0.0}, {"KA", p.ka, 0.0}});
  p.kb = card.read_real(4, "KB", 1e-14 * p.ka);
  p.kt = card.read_real(5, "KT", card.read_real(6, "MU1", 0.0) * p.ka);
  card.use(6, card.get_size());  // friction, adaptive gaps
  p.at = card.get_location();
  for (const auto& [field, value] : {std::pair(3, p.ka), std::pair(4, p.kb), std::pair(5, p.kt)})
    card.demand(value >= 0, field, "KA KB KT", "stiffnesses that are not negative");
  if (r.claim(IdSpace::GapProperty, p.id, card)) r.deck.special.pgap.push_back(p);
}

/// EID PID GA GB X1 X2 X3 GEOM; X1 alone is a grid.
void parse_cbend(Card& card, Reading& r) {
  records::Cbend e;
  read_two_ends(card, e);
  if (card.is_integer(4) && card.is_blank(5, 7))
    e.g0 = card.read_id(4, "G0");
  else
    e.v = card.read_vector(4, "X1 X2 X3");
  e.geom = card.read_int(7, "GEOM");
  e.at = card.get_location();
  card.demand(e.geom >= 1 && e.geom <= 4, 7, "GEOM", "1 to 4");
  if (r.claim(IdSpace::Bend, e.id, card)) r.deck.special.cbend.push_back(e);
}

/// PID MID A I1 I2 J RB THETAB, points C to F, K1 K2 NSM RC ZC DELTAN; or a pipe: PID MID FSI RM T P RB THETAB, blank
/// blank NSM RC ZC.
void parse_pbend(Card& card, Reading& r) {
  records::Pbend p;
  p.id = card.read_id(0, "PID");
  p.mid = card.read_id(1, "MID");
  p.is_pipe = card.is_integer(2);
  if (p.is_pipe) {
    p.fsi = card.read_int(2, "FSI");
    p.rm = card.read_real(3, "RM");
    p.t = card.read_real(4, "T");
    p.pressure = card.read_real(5, "P", 0.0);
  } else {
    card.read_reals(2, {{"A", p.A}, {"I1", p.I1}, {"I2", p.I2}, {"J", p.J, 0.0}});
    card.read_reals(16, {{"K1", p.k1, 0.0}, {"K2", p.k2, 0.0}});
    p.delta_n = card.read_optional_real(21, "DELTAN");
  }
  p.rb = card.read_real(6, "RB", 0.0);
  p.theta_b_deg = card.read_real(7, "THETAB", 0.0);
  const int last = p.is_pipe ? 10 : 18;
  card.read_reals(last, {{"NSM", p.nsm, 0.0}, {"RC", p.rc, 0.0}, {"ZC", p.zc, 0.0}});
  card.use(8, 16);  // C to F; of a pipe SACL, ALPHA and further
  p.at = card.get_location();
  if (r.claim(IdSpace::BendProperty, p.id, card)) r.deck.special.pbend.push_back(p);
}

/// PCOMPS: PID CORDM PSDIR SB NB TREF GE, plies GPLYID MID TR THETA. Plies of one material are a solid of it.
void parse_pcomps(Card& card, Reading& r) {
  records::Psolid p;
  p.id = card.read_id(0, "PID");
  p.cordm = card.read_int(1, "CORDM", 0);
  card.use(2, card.get_size());  // PSDIR to GE; the plies are read below
  p.at = card.get_location();
  for (int i = 8; i < card.get_size(); i += 8) {
    if (card.is_blank(i, i + 8)) continue;
    const int mid = card.read_id(i + 1, "MID", p.mid);
    if (card.read_real(i + 3, "THETA", 0.0) != 0 || (p.mid != 0 && mid != p.mid)) {
      card.fail("deck.field-range", i + 1,
                "the plies differ in material or have angles, expected one material at angle 0",
                "model each ply by solids of its own, with a PSOLID");
      break;
    }
    p.mid = mid;
  }
  if (card.is_ok() && p.mid == 0) card.fail("deck.missing-field", 9, "the laminate has no ply", "give MID1");
  if (r.claim(IdSpace::SolidProperty, p.id, card)) r.deck.psolid.push_back(p);
}

void write_pbcomp(const records::Pbcomp& p, CardSink& sink) {
  CardFields card("PBCOMP");
  card.add(p.id).add(p.mid).add(p.A).add(p.I1).add(p.I2).add(p.I12).add(p.J).add(p.nsm);
  card.add(p.k1).add(p.k2).add(p.m[0]).add(p.m[1]).add(p.n[0]).add(p.n[1]).add(p.section);
  for (const auto& lump : p.lumps) card.end_line().add(lump.r[0]).add(lump.r[1]).add(lump.fraction).add(lump.mid);
  sink.put(card);
}

void add_pairs(CardFields& card, const std::vector<records::GridComponent>& pairs) {
  for (const auto& pair : pairs) card.add(pair.g).add(pair.c);
}

void write_genel(const records::Genel& e, CardSink& sink) {
  CardFields card("GENEL");
  card.add(e.id).add_blank();
  add_pairs(card, e.ui);
  if (!e.ud.empty()) {
    card.end_line().add_word("UD").add_blank();
    add_pairs(card, e.ud);
  }
  card.end_line().add_word(e.is_flexibility ? "Z" : "K");
  for (Eigen::Index column = 0; column < e.matrix.cols(); ++column)
    for (Eigen::Index row = column; row < e.matrix.rows(); ++row) card.add(e.matrix(row, column));
  if (e.s.size() > 0) {
    card.end_line().add_word("S");
    for (Eigen::Index row = 0; row < e.s.rows(); ++row)
      for (Eigen::Index column = 0; column < e.s.cols(); ++column) card.add(e.s(row, column));
  }
  sink.put(card);
}

void write_cgap(const records::Cgap& e, CardSink& sink) {
  CardFields card("CGAP");
  card.add(e.id).add(e.pid).add(e.ga).add(e.gb);
  if (e.v)
    card.add(*e.v);
  else
    card.add_id(e.g0).add_blank(2);
  if (e.cid) card.add(*e.cid);
  sink.put(card);
}

void write_cbend(const records::Cbend& e, CardSink& sink) {
  CardFields card("CBEND");
  card.add(e.id).add(e.pid).add(e.ga).add(e.gb);
  if (e.g0 != 0)
    card.add(e.g0).add_blank(2);
  else
    card.add(e.v);
  sink.put(card.add(e.geom));
}

void write_pbend(const records::Pbend& p, CardSink& sink) {
  CardFields card("PBEND");
  card.add(p.id).add(p.mid);
  if (p.is_pipe)
    card.add(p.fsi).add(p.rm).add(p.t).add(p.pressure);
  else
    card.add(p.A).add(p.I1).add(p.I2).add(p.J);
  card.add(p.rb).add(p.theta_b_deg);
  if (p.is_pipe)
    card.add_blank(2);
  else
    card.add_blank(8).add(p.k1).add(p.k2);
  card.add(p.nsm).add(p.rc).add(p.zc);
  if (p.delta_n) card.add(*p.delta_n);
  sink.put(card);
}

void write_pbcomps(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.special.pbcomp) write_pbcomp(p, sink);
}

void write_genels(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.special.genel) write_genel(e, sink);
}

void write_cbends(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.special.cbend) write_cbend(e, sink);
}

void write_pbends(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.special.pbend) write_pbend(p, sink);
}

void write_cgaps(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.special.cgap) write_cgap(e, sink);
}

void write_pgaps(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.special.pgap)
    sink.put(CardFields("PGAP").add(p.id).add(p.u0).add(p.f0).add(p.ka).add(p.kb).add(p.kt));
}

/// K1 K2 M1 M2 N1 N2 SECTION, then lines of Y Z C MID.
void convert_pbcomp(UnitConverter& u) {
  u.scale(2, "A");
  u.scale(3, 6, "I");
  u.scale(7, "N");
  u.scale(10, 13, "L");
  for (int line = 16; line < u.size(); line += 8) u.scale(line, line + 1, "L");
}

/// A card with its section, or with that of a pipe (FSI, RM, T, P).
void convert_pbend(UnitConverter& u) {
  const bool is_pipe = !u.get(2).empty() && parse_int(u.get(2));
  if (is_pipe) {
    u.scale(3, 4, "L");
    u.scale(5, "P");
    u.scale(6, "L");
    u.scale(8, 9, "?");
    u.scale(10, "N");
    u.scale(11, 12, "L");
    return;
  }
  u.scale(2, "A");
  u.scale(3, 5, "I");
  u.scale(6, "L");
  u.scale(8, 15, "L");
  u.scale(18, "N");
  u.scale(19, 21, "L");
}

/// SB NB are stresses; nothing tells whether TR is a thickness or a share of one.
void convert_pcomps(UnitConverter& u) {
  u.scale(3, 4, "P");
  for (int ply = 8; ply < u.size(); ply += 8) u.scale(ply + 2, "?");
}

/// UI and UD by pairs of grid and component; K or Z by columns from the diagonal on; S by rows.
void convert_genel(UnitConverter& u) {
  const auto is = [&](int i, const char* word) { return make_upper(u.get(i)) == word; };
  std::vector<std::string> ui, ud;
  const auto read_pairs = [&](int first, std::vector<std::string>& components) {
    int i = first;
    for (; i < u.size() && !is(i, "UD") && !is(i, "K") && !is(i, "Z"); ++i)
      if (!u.get(i).empty()) components.push_back(u.get(++i));
    return i;
  };
  int i = read_pairs(2, ui);
  if (is(i, "UD")) i = read_pairs(i + 1, ud);
  const bool is_stiffness = is(i, "K");
  ++i;
  for (std::size_t column = 0; column < ui.size(); ++column)
    for (std::size_t row = column; row < ui.size() && i < u.size(); ++row, ++i) {
      const auto motion = UnitConverter::find_motion(ui[row], ui[column], true);
      is_stiffness ? u.scale_by(motion, i, "K", "Q", "F") : u.scale_by(motion, i, "1/K", "1/Q", "1/F");
    }
  while (i < u.size() && !is(i, "S")) ++i;
  ++i;
  for (const auto& row : ui)
    for (std::size_t column = 0; column < ud.size() && i < u.size(); ++column, ++i) {
      const bool is_rotation = UnitConverter::find_motion(row, "", false) == Motion::Rotation;
      u.scale_by(UnitConverter::find_motion(row, ud[column], true), i, ".", ".", is_rotation ? "1/L" : "L");
    }
}

}  // namespace

void add_special_element_parsers(ParserTable& table) {
  table["PBCOMP"] = {parse_pbcomp, nullptr, "PID MID A I1 I2 I12 J NSM K1 K2 M1 M2 N1 N2 SECTION"};
  table["GENEL"] = {parse_genel, nullptr};
  table["PCOMPS"] = {parse_pcomps, nullptr};
  table["CBEND"] = {parse_cbend, ""};
  table["PBEND"] = {parse_pbend, nullptr};
  table["CGAP"] = {parse_cgap, ""};
  table["PGAP"] = {parse_pgap, ". L F K K K . . L . ."};
  table["PBCOMP"].convert = convert_pbcomp;
  table["GENEL"].convert = convert_genel;
  table["PCOMPS"].convert = convert_pcomps;
  table["PBEND"].convert = convert_pbend;
  write_by(table, {{"PBCOMP", write_pbcomps},
                   {"GENEL", write_genels},
                   {"CBEND", write_cbends},
                   {"PBEND", write_pbends},
                   {"CGAP", write_cgaps},
                   {"PGAP", write_pgaps}});
  write_as(table, "PSOLID", {"PCOMPS"});
}

}  // namespace bough::nastran::detail
