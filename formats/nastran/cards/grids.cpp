#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {
namespace {

using records::CoordKind;
using records::CoordSystem;

void parse_grid(Card& card, Reading& r) {
  records::Grid grid;
  grid.id = card.read_id(0, "ID");
  grid.cp = card.read_reference(1, "CP", r.grid_defaults.cp);
  grid.x = card.read_vector(2, "X1 X2 X3");
  const bool is_fluid = card.get(5) == "-1";
  grid.cd = is_fluid ? 0 : card.read_reference(5, "CD", r.grid_defaults.cd);
  card.use(5);
  grid.ps = card.read_components(6, "PS", r.grid_defaults.ps);
  card.use(7);  // SEID
  grid.at = card.get_location();
  if (!r.claim(IdSpace::Grid, grid.id, card)) return;
  if (is_fluid && r.fluid_grids.empty()) r.first_fluid = grid.at;
  if (is_fluid)
    r.fluid_grids.insert(grid.id);
  else
    r.deck.grids.push_back(grid);
}

void parse_grdset(Card& card, Reading& r) {
  r.grid_defaults.cp = card.read_reference(1, "CP");
  r.grid_defaults.cd = card.read_reference(5, "CD");
  r.grid_defaults.ps = card.read_components(6, "PS", 0);
  for (const int i : {0, 7}) card.use(i);  // some decks put a word there; SEID
}

template <CoordKind kind>
void parse_cord1(Card& card, Reading& r) {
  for (int first : {0, 4}) {
    if (first > 0 && card.is_blank(first, first + 4)) break;
    CoordSystem system;
    system.id = card.read_id(first, "CID");
    system.kind = kind;
    system.by_grids = true;
    for (int i = 0; i < 3; ++i) system.grids[static_cast<std::size_t>(i)] = card.read_id(first + 1 + i, "G1 G2 G3");
    system.at = card.get_location();
    if (r.claim(IdSpace::CoordSystem, system.id, card, first, 4)) r.deck.coord_systems.push_back(system);
  }
}

template <CoordKind kind>
void parse_cord2(Card& card, Reading& r) {
  CoordSystem system;
  system.id = card.read_id(0, "CID");
  system.kind = kind;
  system.rid = card.read_reference(1, "RID");
  system.a = card.read_vector(2, "A1 A2 A3");
  system.b = card.read_vector(5, "B1 B2 B3");
  system.c = card.read_vector(8, "C1 C2 C3");
  system.at = card.get_location();
  if (r.claim(IdSpace::CoordSystem, system.id, card)) r.deck.coord_systems.push_back(system);
}

}  // namespace

void add_grid_parsers(ParserTable& table) {
  table["GRID"] = {parse_grid, nullptr, "ID CP X1 X2 X3 CD PS SEID"};
  table["GRDSET"] = parse_grdset;
  table["CORD1R"] = parse_cord1<CoordKind::Rectangular>;
  table["CORD1C"] = parse_cord1<CoordKind::Cylindrical>;
  table["CORD1S"] = parse_cord1<CoordKind::Spherical>;
  table["CORD2R"] = parse_cord2<CoordKind::Rectangular>;
  table["CORD2C"] = parse_cord2<CoordKind::Cylindrical>;
  table["CORD2S"] = parse_cord2<CoordKind::Spherical>;
}

}  // namespace bough::nastran::detail
