#include <algorithm>
#include <map>
#include <unordered_map>

#include "fe/cards/shell_card.hpp"
#include "fe/model/coordinates.hpp"

namespace bough::fe {

std::vector<std::pair<int, Vector3d>> list_neighbor_normals(const records::Deck& deck) {
  std::vector<std::pair<int, Vector3d>> normals;
  for (const auto& section : deck.super.sections) {
    std::map<int, int> joined;
    for (const auto& card : deck.super.seconct)
      for (const auto& [a, b] : card.points)
        if (card.a == section.id && card.b == 0 && b != 0) joined[a] = b;
    if (joined.empty() || section.deck->shells.empty()) continue;
    Diagnostics of_section;  // its own model reports them
    const CoordinateSystems systems(*section.deck, Vector3d::Zero(), of_section);
    std::unordered_map<int, Vector3d> places;
    for (std::size_t k = 0; k < section.deck->grids.size(); ++k)
      places[section.deck->grids[k].id] = systems.get_grid_position(static_cast<int>(k));
    for (const auto& shell : section.deck->shells) {
      const auto& g = shell.grids;
      const auto is_joined = [&](int id) { return joined.count(id) > 0; };
      const auto is_known = [&](int id) { return places.count(id) > 0; };
      if (!shell.midsides.empty() || g.size() < 3 || std::none_of(g.begin(), g.end(), is_joined) ||
          !std::all_of(g.begin(), g.end(), is_known))
        continue;
      const Vector3d side = places[g[1]] - places[g[0]], other = places[g[2]] - places[g[0]];
      const Vector3d n = g.size() == 4 ? other.cross(places[g[3]] - places[g[1]]) : side.cross(other);
      if (!(n.norm() > 0)) continue;
      for (const int id : g)
        if (is_joined(id)) normals.emplace_back(joined.at(id), n.normalized());
    }
  }
  return normals;
}

}  // namespace bough::fe
