#include <array>
#include <cmath>
#include <string>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {
namespace {

void parse_mat2(Card& card, Reading& r) {
  records::Mat2 mat;
  mat.id = card.read_id(0, "MID");
  static constexpr int kPlace[6][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}};
  for (int i = 0; i < 6; ++i)
    mat.G(kPlace[i][0], kPlace[i][1]) = mat.G(kPlace[i][1], kPlace[i][0]) = card.read_real(1 + i, "Gij", 0.0);
  mat.rho = card.read_real(7, "RHO", 0.0);
  mat.alpha = card.read_vector(8, "A1 A2 A3");
  mat.tref = card.read_optional_real(11, "TREF");
  mat.ge = card.read_real(12, "GE", 0.0);
  card.use(13, 17);  // stress limits, MCSID
  mat.at = card.get_location();
  if (r.claim(IdSpace::Material, mat.id, card)) r.deck.mat2.push_back(mat);
}

void parse_mat8(Card& card, Reading& r) {
  records::Mat8 mat;
  mat.id = card.read_id(0, "MID");
  mat.E1 = card.read_real(1, "E1");
  mat.E2 = card.read_real(2, "E2");
  mat.nu12 = card.read_real(3, "NU12", 0.0);
  mat.G12 = card.read_real(4, "G12", 0.0);
  mat.G1z = card.read_real(5, "G1Z", 0.0);
  mat.G2z = card.read_real(6, "G2Z", 0.0);
  mat.rho = card.read_real(7, "RHO", 0.0);
  mat.a1 = card.read_real(8, "A1", 0.0);
  mat.a2 = card.read_real(9, "A2", 0.0);
  mat.tref = card.read_optional_real(10, "TREF");
  mat.ge = card.read_real(16, "GE", 0.0);
  auto& s = mat.strength;
  s.Xt = card.read_real(11, "Xt", 0.0);
  s.Xc = std::abs(card.read_real(12, "Xc", s.Xt));
  s.Yt = card.read_real(13, "Yt", 0.0);
  s.Yc = std::abs(card.read_real(14, "Yc", s.Yt));
  s.S = card.read_real(15, "S", 0.0);
  s.F12 = card.read_real(17, "F12", 0.0);
  s.is_strain = card.read_real(18, "STRN", 0.0) == 1;
  card.use(19, card.get_size());
  mat.at = card.get_location();
  if (r.claim(IdSpace::Material, mat.id, card)) r.deck.mat8.push_back(mat);
}

void parse_mat9(Card& card, Reading& r) {
  records::Mat9 mat;
  mat.id = card.read_id(0, "MID");
  int field = 1;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) mat.G(i, j) = mat.G(j, i) = card.read_real(field++, "Gij", 0.0);
  mat.rho = card.read_real(field++, "RHO", 0.0);
  for (int i = 0; i < 6; ++i) mat.alpha[i] = card.read_real(field++, "Ai", 0.0);
  mat.tref = card.read_optional_real(field, "TREF");
  mat.ge = card.read_real(field + 1, "GE", 0.0);
  mat.at = card.get_location();
  if (r.claim(IdSpace::Material, mat.id, card)) r.deck.mat9.push_back(mat);
}

/// MAT11, an orthotropic solid, becomes the MAT9 of the same law.
void parse_mat11(Card& card, Reading& r) {
  records::Mat9 mat;
  mat.id = card.read_id(0, "MID");
  const double E1 = card.read_real(1, "E1"), E2 = card.read_real(2, "E2"), E3 = card.read_real(3, "E3");
  const double nu12 = card.read_real(4, "NU12"), nu13 = card.read_real(5, "NU13"), nu23 = card.read_real(6, "NU23");
  const std::array<double, 3> shear{card.read_real(7, "G12"), card.read_real(9, "G23"), card.read_real(8, "G13")};
  mat.rho = card.read_real(10, "RHO", 0.0);
  for (int i = 0; i < 3; ++i) mat.alpha[i] = card.read_real(11 + i, "Ai", 0.0);
  mat.tref = card.read_optional_real(14, "TREF");
  mat.ge = card.read_real(15, "GE", 0.0);
  mat.at = card.get_location();
  if (card.is_ok()) {
    Eigen::Matrix3d compliance;
    compliance << 1 / E1, -nu12 / E1, -nu13 / E1,  //
        -nu12 / E1, 1 / E2, -nu23 / E2,            //
        -nu13 / E1, -nu23 / E2, 1 / E3;
    const bool is_law = E1 > 0 && E2 > 0 && E3 > 0 && Eigen::LLT<Eigen::Matrix3d>(compliance).info() == Eigen::Success;
    if (!is_law)
      card.fail("deck.field-range", 1, "the law of E1 to NU23 is not positive definite", "correct the material");
    else
      mat.G.topLeftCorner<3, 3>() = compliance.inverse();
    for (int i = 0; i < 3; ++i) mat.G(3 + i, 3 + i) = shear[static_cast<std::size_t>(i)];
  }
  if (r.claim(IdSpace::Material, mat.id, card)) r.deck.mat9.push_back(mat);
}

void parse_pshell(Card& card, Reading& r) {
  records::Pshell p;
  p.id = card.read_id(0, "PID");
  p.mid1 = card.read_id(1, "MID1", 0);
  p.t = card.read_optional_real(2, "T");
  p.mid2 = card.read_int(3, "MID2", 0);
  p.bending_ratio = card.read_real(4, "12I/T**3", 1.0);
  p.mid3 = card.read_id(5, "MID3", 0);
  p.shear_ratio = card.read_real(6, "TS/T", 5.0 / 6);
  p.nsm = card.read_real(7, "NSM", 0.0);
  p.mid4 = card.read_id(10, "MID4", 0);
  p.z1 = card.read_optional_real(8, "Z1");
  p.z2 = card.read_optional_real(9, "Z2");
  p.at = card.get_location();
  card.demand(p.mid2 >= -1, 3, "MID2", "a material id, blank or -1");
  if (p.mid1 == 0 && p.mid2 <= 0)
    card.fail("deck.missing-field", 1, "MID1 and MID2 are both blank", "give one of them");
  if (r.claim(IdSpace::ShellProperty, p.id, card)) r.deck.pshell.push_back(p);
}

void set_layup(const std::string& lam, records::Pcomp& p) {
  if (lam == "SMEAR") p.layup = records::Layup::Smeared;
  if (lam == "SMCORE") p.layup = records::Layup::SmearedCore;
}

void check_core(const records::Pcomp& p, Card& card) {
  if (p.layup == records::Layup::SmearedCore && p.plies.size() == 1)
    card.fail("deck.missing-field", 8, "LAM is SMCORE, but there is one ply only",
              "give the faces first and the core as the last ply");
}

/// SB and FT. A criterion that is not supported is left out, with a message.
void read_failure(Card& card, records::Pcomp& p) {
  p.sb = card.read_real(3, "SB", 0.0);
  p.failure = card.get_upper(4);
  card.use(4);
  if (p.failure.empty() || p.failure == "HILL" || p.failure == "HOFF" || p.failure == "TSAI" || p.failure == "STRN")
    return;
  card.warn("deck.failure-theory", 4, "FT is '" + p.failure + "': no failure index of that kind is computed",
            "HILL, HOFF, TSAI and STRN are");
  p.failure.clear();
}

/// Fields 1..7 of PCOMP and PCOMPG, then plies; `stride` fields a ply, material first after `skip`.
void parse_laminate(Card& card, Reading& r, int skip, int stride) {
  records::Pcomp p;
  p.id = card.read_id(0, "PID");
  const auto z0 = card.read_optional_real(1, "Z0");
  p.nsm = card.read_real(2, "NSM", 0.0);
  p.tref = card.read_real(5, "TREF", 0.0);
  p.ge = card.read_real(6, "GE", 0.0);
  read_failure(card, p);
  const std::string lam = card.read_word(7, "LAM", "", {"", "ALL", "SYM", "MEM", "SYMMEM", "BEND", "SMEAR", "SMCORE"});
  p.membrane = lam != "BEND";
  p.bending = lam != "MEM" && lam != "SYMMEM";
  set_layup(lam, p);
  p.at = card.get_location();
  for (int i = 8; i < card.get_size(); i += stride) {
    if (card.is_blank(i, i + stride)) continue;
    records::Ply ply = p.plies.empty() ? records::Ply{} : p.plies.back();
    ply.mid = p.plies.empty() ? card.read_id(i + skip, "MID1") : card.read_id(i + skip, "MIDi", ply.mid);
    ply.t = p.plies.empty() ? card.read_real(i + skip + 1, "T1") : card.read_real(i + skip + 1, "Ti", ply.t);
    ply.theta_deg = card.read_real(i + skip + 2, "THETAi", 0.0);
    card.use(i + skip + 3);     // SOUT
    if (skip > 0) card.use(i);  // GPLYID
    p.plies.push_back(ply);
  }
  if (p.plies.empty()) card.fail("deck.missing-field", 8, "the laminate has no ply", "give MID1, T1, THETA1");
  check_core(p, card);
  if (lam == "SYM" || lam == "SYMMEM") p.plies.insert(p.plies.end(), p.plies.rbegin(), p.plies.rend());
  double total = 0;
  for (const auto& ply : p.plies) total += ply.t;
  p.z0 = z0.value_or(-0.5 * total);
  if (r.claim(IdSpace::ShellProperty, p.id, card)) r.deck.pcomp.push_back(p);
}
void parse_pcomp(Card& card, Reading& r) { parse_laminate(card, r, 0, 4); }
void parse_pcompg(Card& card, Reading& r) { parse_laminate(card, r, 1, 8); }

/// PCOMP1: PID Z0 NSM SB FT MID T LAM, angles. PCOMP2: PID Z0 NSM SB FT MID blank LAM, pairs of T and angle.
void parse_equal_plies(Card& card, Reading& r) {
  const bool is_constant = card.get_name() == "PCOMP1";
  records::Pcomp p;
  p.id = card.read_id(0, "PID");
  const auto z0 = card.read_optional_real(1, "Z0");
  p.nsm = card.read_real(2, "NSM", 0.0);
  read_failure(card, p);
  records::Ply ply;
  ply.mid = card.read_id(5, "MID");
  if (is_constant) ply.t = card.read_real(6, "T");
  const std::string lam = card.read_word(7, "LAM", "", {"", "ALL", "SYM", "MEM", "SYMMEM", "BEND", "SMEAR", "SMCORE"});
  p.bending = lam != "MEM" && lam != "SYMMEM";
  p.membrane = lam != "BEND";
  set_layup(lam, p);
  p.at = card.get_location();
  const int stride = is_constant ? 1 : 2;
  for (int i = 8; i < card.get_size(); i += stride) {
    if (card.is_blank(i, i + stride) && !is_constant) continue;
    if (!is_constant) ply.t = card.read_real(i, "Ti", ply.t);
    ply.theta_deg = card.read_real(i + stride - 1, "THi", ply.theta_deg);
    p.plies.push_back(ply);
  }
  if (p.plies.empty()) card.fail("deck.missing-field", 8, "the laminate has no ply", "give its angles");
  check_core(p, card);
  if (lam == "SYM" || lam == "SYMMEM") p.plies.insert(p.plies.end(), p.plies.rbegin(), p.plies.rend());
  double total = 0;
  for (const auto& each : p.plies) total += each.t;
  p.z0 = z0.value_or(-0.5 * total);
  if (r.claim(IdSpace::ShellProperty, p.id, card)) r.deck.pcomp.push_back(p);
}

/// IN and ISOP, as words or as numbers (Quick Reference Guide, PSOLID).
void read_solid_scheme(Card& card, Reading& r, records::Psolid& p) {
  const std::string in = card.get_upper(3), isop = card.get_upper(5);
  if (in == "TWO" || in == "2")
    p.points = 2;
  else if (in == "THREE" || in == "3")
    p.points = 3;
  p.is_full = isop == "FULL" || isop == "1";
  p.is_reduced = isop == "REDUCED" || isop == "0";
  const bool knows_in = p.points > 0 || in.empty() || in == "BUBBLE" || in == "GAUSS" || in == "0" || in == "1";
  if (knows_in && (p.is_full || p.is_reduced || isop.empty())) return;
  r.diagnostics.warning("deck.solid-scheme", r.deck.locate(p.at),
                        "PSOLID " + std::to_string(p.id) + " has IN = '" + in + "', ISOP = '" + isop +
                            "'; what is unknown there is taken as blank",
                        "IN is BUBBLE, TWO or THREE, ISOP is REDUCED or FULL");
}

void parse_psolid(Card& card, Reading& r) {
  records::Psolid p;
  p.id = card.read_id(0, "PID");
  p.mid = card.read_id(1, "MID");
  p.cordm = card.is_integer(2) ? card.read_int(2, "CORDM", 0) : 0;
  p.at = card.get_location();
  read_solid_scheme(card, r, p);
  const std::string fluid = card.get_upper(6);
  card.use(2, 6);  // CORDM, IN, STRESS, ISOP
  if (!r.claim(IdSpace::SolidProperty, p.id, card)) return;
  if (fluid == "PFLUID" || fluid == "FFLUID") {
    if (r.fluid_grids.empty() && r.fluid_properties.empty()) r.first_fluid = p.at;
    r.fluid_properties.insert(p.id);
  } else {
    r.deck.psolid.push_back(p);
  }
}

void parse_solid(Card& card, Reading& r, int corners, int edges) {
  records::SolidElement e;
  e.id = card.read_id(0, "EID");
  e.pid = card.read_id(1, "PID", e.id);
  e.card = card.get_name();
  for (int i = 0; i < corners; ++i) e.corners.push_back(card.read_id(2 + i, "G1.."));
  bool any = false;
  for (int i = 0; i < edges; ++i) {
    e.midsides.push_back(card.read_id(2 + corners + i, "Gi", 0));
    any = any || e.midsides.back() > 0;
  }
  if (!any) e.midsides.clear();
  e.at = card.get_location();
  if (r.claim(IdSpace::Solid, e.id, card)) r.deck.solids.push_back(std::move(e));
}
void parse_hexa(Card& card, Reading& r) { parse_solid(card, r, 8, 12); }
void parse_penta(Card& card, Reading& r) { parse_solid(card, r, 6, 9); }
void parse_tetra(Card& card, Reading& r) { parse_solid(card, r, 4, 6); }

}  // namespace

void add_continuum_parsers(ParserTable& table) {
  table["MAT2"] = {parse_mat2, ". P P P P P P R . . . . . P P P .",
                   "MID G11 G12 G13 G22 G23 G33 RHO A1 A2 A3 TREF GE ST SC SS MCSID"};
  table["MAT8"] = {parse_mat8, nullptr, "MID E1 E2 NU12 G12 G1Z G2Z RHO A1 A2 TREF XT XC YT YC S GE F12 STRN"};
  table["MAT9"] = {parse_mat9, ". P P P P P P P P P P P P P P P P P P P P P R . . . . . . . ."};
  table["MAT6"] = {parse_mat9, ". P P P P P P P P P P P P P P P P P P P P P R . . . . . . . ."};  // NASTRAN-95
  table["MAT11"] = {parse_mat11, ". P P P . . . P P P R . . . . ."};
  table["PSHELL"] = {parse_pshell, ". . L . . . . S L L .", "PID MID1 T MID2 12I/T**3 MID3 TS/T NSM Z1 Z2 MID4"};
  table["PCOMP"] = parse_pcomp;
  table["PCOMPG"] = parse_pcompg;
  table["PCOMP1"] = table["PCOMP2"] = parse_equal_plies;
  table["PSOLID"] = {parse_psolid, "", "PID MID CORDM IN STRESS ISOP FCTN"};
  table["CHEXA"] = {parse_hexa, ""};
  table["CPENTA"] = {parse_penta, ""};
  table["CTETRA"] = {parse_tetra, ""};
}

}  // namespace bough::nastran::detail
