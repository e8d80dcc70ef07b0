#include <algorithm>

#include "formats/nastran/detail/card_sink.hpp"

namespace bough::nastran::detail {
namespace {

using records::CoordKind;

const char* get_letter(CoordKind kind) {
  return kind == CoordKind::Rectangular ? "R" : kind == CoordKind::Cylindrical ? "C" : "S";
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

}  // namespace

void write_points(const records::Deck& deck, CardSink& sink) {
  for (const auto& system : deck.coord_systems) {
    CardFields card(std::string(system.by_grids ? "CORD1" : "CORD2") + get_letter(system.kind));
    card.add(system.id);
    if (system.by_grids)
      card.add(system.grids[0]).add(system.grids[1]).add(system.grids[2]);
    else
      card.add_id(system.rid).add(system.a).add(system.b).add(system.c);
    sink.put(card);
  }
  for (const auto& grid : deck.grids)
    sink.put(CardFields("GRID").add(grid.id).add_id(grid.cp).add(grid.x).add_id(grid.cd).add_components(grid.ps));
  auto points = deck.scalar_points;
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  for (const int id : points) sink.put(CardFields("SPOINT").add(id));
}

/// Adds a blank for a TREF that was not given: TEMPERATURE(INITIAL) may take its place.
CardFields& add_tref(CardFields& card, const std::optional<double>& tref) {
  return tref ? card.add(*tref) : card.add_blank();
}

void write_materials(const records::Deck& deck, CardSink& sink) {
  for (const auto& mat : deck.mat1) {
    CardFields card("MAT1");
    card.add(mat.id);
    add_moduli(mat, card);
    add_tref(card.add(mat.rho).add(mat.alpha), mat.tref).add(mat.ge);
    if (mat.st != 0 || mat.sc != 0 || mat.ss != 0) card.add(mat.st).add(mat.sc).add(mat.ss);
    sink.put(card);
  }
  for (const auto& mat : deck.mat2) {
    CardFields card("MAT2");
    card.add(mat.id);
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) card.add(mat.G(i, j));
    sink.put(add_tref(card.add(mat.rho).add(mat.alpha), mat.tref).add(mat.ge));
  }
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
  for (const auto& mat : deck.mat9) {
    CardFields card("MAT9");
    card.add(mat.id);
    for (int i = 0; i < 6; ++i)
      for (int j = i; j < 6; ++j) card.add(mat.G(i, j));
    card.add(mat.rho);
    for (int i = 0; i < 6; ++i) card.add(mat.alpha[i]);
    sink.put(add_tref(card, mat.tref).add(mat.ge));
  }
}

}  // namespace bough::nastran::detail
