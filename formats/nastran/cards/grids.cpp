#include <algorithm>

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

void parse_spoint(Card& card, Reading& r) {
  const auto ids = read_ids(card, 0, card.get_size(), "ID");
  if (ids.empty() && card.is_ok()) card.fail("deck.missing-field", 0, "ID is blank, expected a scalar point at least");
  if (card.is_ok()) r.deck.scalar_points.insert(r.deck.scalar_points.end(), ids.begin(), ids.end());
}

const char* get_letter(CoordKind kind) {
  return kind == CoordKind::Rectangular ? "R" : kind == CoordKind::Cylindrical ? "C" : "S";
}

void write_coord_systems(const records::Deck& deck, CardSink& sink) {
  for (const auto& system : deck.coord_systems) {
    CardFields card(std::string(system.by_grids ? "CORD1" : "CORD2") + get_letter(system.kind));
    card.add(system.id);
    if (system.by_grids)
      card.add(system.grids[0]).add(system.grids[1]).add(system.grids[2]);
    else
      card.add_id(system.rid).add(system.a).add(system.b).add(system.c);
    sink.put(card);
  }
}

void write_grids(const records::Deck& deck, CardSink& sink) {
  for (const auto& grid : deck.grids)
    sink.put(CardFields("GRID").add(grid.id).add_id(grid.cp).add(grid.x).add_id(grid.cd).add_components(grid.ps));
}

void write_scalar_points(const records::Deck& deck, CardSink& sink) {
  auto points = deck.scalar_points;
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  for (const int id : points) sink.put(CardFields("SPOINT").add(id));
}

void convert_grid(UnitConverter& u) {
  u.scale_point(2, u.get_axes(u.get(1).empty() ? u.get_notes().default_system : u.get_int(1)));
}
void note_grid(const UnitConverter& u, UnitNotes& notes) { notes.grids.insert(u.get(0)); }
void note_grdset(const UnitConverter& u, UnitNotes& notes) { notes.default_system = u.get_int(1); }

void convert_cord2(UnitConverter& u) {
  for (const int field : {2, 5, 8}) u.scale_point(field, u.get_axes(u.get_int(1)));
}
template <Axes axes>
void note_cord1(const UnitConverter& u, UnitNotes& notes) {
  for (const int first : {0, 4})
    if (u.get_int(first) > 0) notes.axes[u.get_int(first)] = axes;
}
template <Axes axes>
void note_cord2(const UnitConverter& u, UnitNotes& notes) {
  notes.axes[u.get_int(0)] = axes;
}

}  // namespace

void add_grid_parsers(ParserTable& table) {
  constexpr const char* cord1 = "CID G1 G2 G3";
  constexpr const char* cord2 = "CID RID A1 A2 A3 B1 B2 B3 C1 C2 C3";
  table["GRID"] = {parse_grid, nullptr, "ID CP X1 X2 X3 CD PS SEID"};
  table["GRID"].convert = convert_grid;
  table["GRID"].note = note_grid;
  table["GRDSET"] = {parse_grdset, "", "- CP - - - CD PS SEID"};
  table["GRDSET"].note = note_grdset;
  table["CORD1R"] = {parse_cord1<CoordKind::Rectangular>, "", cord1};
  table["CORD1C"] = {parse_cord1<CoordKind::Cylindrical>, "", cord1};
  table["CORD1S"] = {parse_cord1<CoordKind::Spherical>, "", cord1};
  for (const char* name : {"CORD1R", "CORD1C", "CORD1S"}) table[name].entry_size = 4;
  table["CORD1C"].note = note_cord1<Axes::Cylindrical>;
  table["CORD1S"].note = note_cord1<Axes::Spherical>;
  table["CORD2R"] = {parse_cord2<CoordKind::Rectangular>, nullptr, cord2};
  table["CORD2C"] = {parse_cord2<CoordKind::Cylindrical>, nullptr, cord2};
  table["CORD2S"] = {parse_cord2<CoordKind::Spherical>, nullptr, cord2};
  for (const char* name : {"CORD2R", "CORD2C", "CORD2S"}) table[name].convert = convert_cord2;
  table["CORD2C"].note = note_cord2<Axes::Cylindrical>;
  table["CORD2S"].note = note_cord2<Axes::Spherical>;
  table["SPOINT"] = {parse_spoint, ""};
  write_by(table, write_coord_systems, {"CORD1R", "CORD1C", "CORD1S", "CORD2R", "CORD2C", "CORD2S"});
  write_by(table, write_grids, {"GRID"});
  write_as(table, "GRID", {"GRDSET"});
  write_by(table, write_scalar_points, {"SPOINT"});
}

}  // namespace bough::nastran::detail
