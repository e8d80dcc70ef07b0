#include <array>
#include <cmath>
#include <string>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {
namespace {

/// The missing one of E, G, nu from E = 2(1+nu)G; with two missing (nu and one modulus) both are zero, as in the Quick
/// Reference Guide.
void parse_mat1(Card& card, Reading& r) {
  records::Mat1 mat;
  mat.id = card.read_id(0, "MID");
  const auto E = card.read_optional_real(1, "E"), G = card.read_optional_real(2, "G"),
             nu = card.read_optional_real(3, "NU");
  mat.rho = card.read_real(4, "RHO", 0.0);
  mat.alpha = card.read_real(5, "A", 0.0);
  mat.tref = card.read_optional_real(6, "TREF");
  card.read_reals(7, {{"GE", mat.ge, 0.0}, {"ST", mat.st, 0.0}, {"SC", mat.sc, 0.0}, {"SS", mat.ss, 0.0}});
  card.use(11);  // MCSID
  mat.at = card.get_location();
  card.demand(!E || *E >= 0, 1, "E", "a modulus that is not negative");
  card.demand(!G || *G >= 0, 2, "G", "a modulus that is not negative");
  if (!E && !G) card.fail("deck.missing-field", 1, "E and G are both blank", "give one of them");
  mat.E = E.value_or(0.0);
  mat.G = G.value_or(0.0);
  mat.nu = nu.value_or(0.0);
  if (E && !G && nu) {
    card.demand(*nu > -1, 3, "NU", "a value above -1");
    mat.G = *nu > -1 ? *E / (2 * (1 + *nu)) : 0.0;
    mat.filled = 'G';
  } else if (!E && G && nu) {
    mat.E = 2 * (1 + *nu) * *G;
    mat.filled = 'E';
  } else if (E && G && !nu) {
    mat.nu = *G > 0 ? *E / (2 * *G) - 1 : 0.0;
    mat.filled = 'N';
  }
  if (E && G && nu && *G > 0 && std::abs(1 - *E / (2 * (1 + *nu) * *G)) > 0.01)
    card.warn("deck.inconsistent-material", 1, "E, G and NU differ from E = 2(1+NU)G by more than 1 %",
              "they are used as given");
  if (r.claim(IdSpace::Material, mat.id, card)) r.deck.mat1.push_back(mat);
}

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
  card.read_reals(1, {{"E1", mat.E1}, {"E2", mat.E2}, {"NU12", mat.nu12, 0.0}, {"G12", mat.G12, 0.0}});
  card.read_reals(5, {{"G1Z", mat.G1z, 0.0}, {"G2Z", mat.G2z, 0.0}, {"RHO", mat.rho, 0.0}});
  card.read_reals(8, {{"A1", mat.a1, 0.0}, {"A2", mat.a2, 0.0}});
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

/// MAT11, an orthotropic solid, becomes a MAT9 of equal elasticity.
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

/// The reader's rule for the blank one of E, G, NU; what it gives back bit for bit is left blank, so that a derived
/// value does not lose digits in the width of a field.
void add_moduli(const records::Mat1& mat, CardFields& card) {
  if (mat.G == 0 && mat.nu == 0)
    card.add(mat.E).add_blank(2);
  else if (mat.E == 0 && mat.nu == 0)
    card.add_blank().add(mat.G).add_blank();
  else if (mat.nu > -1 && mat.E / (2 * (1 + mat.nu)) == mat.G)
    card.add(mat.E).add_blank().add(mat.nu);
  else if (2 * (1 + mat.nu) * mat.G == mat.E)
    card.add_blank().add(mat.G).add(mat.nu);
  else if (mat.G > 0 && mat.E / (2 * mat.G) - 1 == mat.nu)
    card.add(mat.E).add(mat.G).add_blank();
  else
    card.add(mat.E).add(mat.G).add(mat.nu);
}

/// Adds TREF, blank if it was not given: then TEMPERATURE(INITIAL) may replace it.
CardFields& add_tref(CardFields& card, const std::optional<double>& tref) {
  return tref ? card.add(*tref) : card.add_blank();
}

void write_mat1(const records::Deck& deck, CardSink& sink) {
  for (const auto& mat : deck.mat1) {
    CardFields card("MAT1");
    card.add(mat.id);
    add_moduli(mat, card);
    add_tref(card.add(mat.rho).add(mat.alpha), mat.tref).add(mat.ge);
    if (mat.st != 0 || mat.sc != 0 || mat.ss != 0) card.add(mat.st).add(mat.sc).add(mat.ss);
    sink.put(card);
  }
}

/// The upper triangle by rows.
void add_upper(CardFields& card, const Eigen::MatrixXd& G) {
  for (int i = 0; i < G.rows(); ++i)
    for (int j = i; j < G.rows(); ++j) card.add(G(i, j));
}

void write_mat2(const records::Deck& deck, CardSink& sink) {
  for (const auto& mat : deck.mat2) {
    CardFields card("MAT2");
    add_upper(card.add(mat.id), mat.G);
    sink.put(add_tref(card.add(mat.rho).add(mat.alpha), mat.tref).add(mat.ge));
  }
}

void write_mat8(const records::Deck& deck, CardSink& sink) {
  for (const auto& mat : deck.mat8) {
    CardFields card("MAT8");
    card.add(mat.id).add(mat.E1).add(mat.E2).add(mat.nu12).add(mat.G12).add(mat.G1z).add(mat.G2z).add(mat.rho);
    add_tref(card.add(mat.a1).add(mat.a2), mat.tref);
    const auto& s = mat.strength;
    const bool is_strong = s.Xt != 0 || s.Xc != 0 || s.Yt != 0 || s.Yc != 0 || s.S != 0;
    if (is_strong)
      card.add(s.Xt).add(s.Xc).add(s.Yt).add(s.Yc).add(s.S).add(mat.ge).add(s.F12);
    else if (mat.ge != 0)
      card.add_blank(5).add(mat.ge);
    if (is_strong && s.is_strain) card.add(1.0);
    sink.put(card);
  }
}

void write_mat9(const records::Deck& deck, CardSink& sink) {
  for (const auto& mat : deck.mat9) {
    CardFields card("MAT9");
    add_upper(card.add(mat.id), mat.G);
    card.add(mat.rho);
    for (int i = 0; i < 6; ++i) card.add(mat.alpha[i]);
    sink.put(add_tref(card, mat.tref).add(mat.ge));
  }
}

/// Strengths are strains with STRN = 1.
void convert_mat8(UnitConverter& u) {
  for (const int field : {1, 2, 4, 5, 6}) u.scale(field, "P");
  u.scale(7, "R");
  if (parse_real(u.get(18)).value_or(0) == 1) return;
  u.scale(11, 15, "P");
  u.scale(17, "1/P2");
}

}  // namespace

void add_material_parsers(ParserTable& table) {
  table["MAT1"] = {parse_mat1, ". P P . R . . . P P P .", "MID E G NU RHO A TREF GE ST SC SS MCSID"};
  table["MAT2"] = {parse_mat2, ". P P P P P P R . . . . . P P P .",
                   "MID G11 G12 G13 G22 G23 G33 RHO A1 A2 A3 TREF GE ST SC SS MCSID"};
  table["MAT8"] = {parse_mat8, nullptr, "MID E1 E2 NU12 G12 G1Z G2Z RHO A1 A2 TREF XT XC YT YC S GE F12 STRN"};
  table["MAT9"] = {parse_mat9, ". P P P P P P P P P P P P P P P P P P P P P R . . . . . . . ."};
  table["MAT6"] = {parse_mat9, ". P P P P P P P P P P P P P P P P P P P P P R . . . . . . . ."};  // NASTRAN-95
  table["MAT11"] = {parse_mat11, ". P P P . . . P P P R . . . . ."};
  table["MAT8"].convert = convert_mat8;
  write_by(table, {{"MAT1", write_mat1}, {"MAT2", write_mat2}, {"MAT8", write_mat8}, {"MAT9", write_mat9}});
  write_as(table, "MAT9", {"MAT6", "MAT11"});
}

}  // namespace bough::nastran::detail
