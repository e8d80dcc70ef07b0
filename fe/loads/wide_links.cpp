#include "fe/loads/wide_links.hpp"

#include <set>

namespace bough::fe {

void report_wide_links(const records::Deck& deck, Diagnostics& diagnostics) {
  for (const auto& card : deck.rbe3) {
    std::set<int> moved, turned;
    for (const auto& group : card.groups) {
      if (group.c & 7u) moved.insert(group.grids.begin(), group.grids.end());
      if (group.c & 56u) turned.insert(group.grids.begin(), group.grids.end());
    }
    if (3 * (moved.size() + turned.size()) <= kMaxLinkDofs) continue;
    moved.merge(turned);
    diagnostics.warning("fe.wide-link", deck.locate(card.at),
                        "RBE3 " + std::to_string(card.id) + " joins " + std::to_string(moved.size()) +
                            " grids: its second order, which would couple all of them, is left out of the geometric "
                            "stiffness matrix",
                        "join fewer grids, or reduce the deck, which takes every link");
  }
}

}  // namespace bough::fe
