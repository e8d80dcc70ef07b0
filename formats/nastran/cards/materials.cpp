#include <cmath>

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
  mat.ge = card.read_real(7, "GE", 0.0);
  mat.st = card.read_real(8, "ST", 0.0);
  mat.sc = card.read_real(9, "SC", 0.0);
  mat.ss = card.read_real(10, "SS", 0.0);
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
  } else if (!E && G && nu) {
    mat.E = 2 * (1 + *nu) * *G;
  } else if (E && G && !nu) {
    mat.nu = *G > 0 ? *E / (2 * *G) - 1 : 0.0;
  }
  if (E && G && nu && *G > 0 && std::abs(1 - *E / (2 * (1 + *nu) * *G)) > 0.01)
    card.warn("deck.inconsistent-material", 1, "E, G and NU differ from E = 2(1+NU)G by more than 1 %",
              "they are used as given");
  if (r.claim(IdSpace::Material, mat.id, card)) r.deck.mat1.push_back(mat);
}

}  // namespace

void add_material_parsers(ParserTable& table) { table["MAT1"] = parse_mat1; }

}  // namespace bough::nastran::detail
