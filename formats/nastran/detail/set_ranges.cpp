#include <algorithm>

#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {

void expand_ranges(Reading& r) {
  if (r.spc_ranges.empty() && r.set_ranges.empty()) return;
  std::vector<int> ids;
  ids.reserve(r.deck.grids.size() + r.deck.scalar_points.size());
  for (const auto& grid : r.deck.grids) ids.push_back(grid.id);
  ids.insert(ids.end(), r.deck.scalar_points.begin(), r.deck.scalar_points.end());
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  for (const auto& spc : r.spc_ranges)
    for (auto id = std::lower_bound(ids.begin(), ids.end(), spc.range.first); id != ids.end() && *id <= spc.range.last;
         ++id)
      if (spc.range.contains(*id)) r.deck.spc.push_back({spc.sid, *id, spc.c, 0.0, true, spc.at});
  for (const auto& set : r.set_ranges) {
    const auto before = set.terms->size();
    for (auto id = std::lower_bound(ids.begin(), ids.end(), set.range.first); id != ids.end() && *id <= set.range.last;
         ++id)
      if (set.range.contains(*id)) set.terms->push_back({*id, set.c, set.at});
    if (set.terms->size() == before && set.terms != &r.deck.qset && set.terms != &r.deck.bset &&
        set.terms != &r.deck.cset)
      r.diagnostics.error("deck.bad-list", r.deck.locate(set.at),
                          std::to_string(set.range.first) + " THRU " + std::to_string(set.range.last) +
                              " holds no grid or scalar point of the deck",
                          "correct the ids");
  }
}

}  // namespace bough::nastran::detail
