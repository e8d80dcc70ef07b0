#include "fe/model/unmodelled.hpp"

#include <map>

#include "formats/records/element_cards.hpp"

namespace bough::fe {

void report_unmodelled(const records::Deck& deck, const std::set<std::string>& made, Diagnostics& diagnostics) {
  if (diagnostics.num_errors() > 0) return;
  struct Cards {
    int count = 0;
    records::CardLocation first;
  };
  std::map<std::string, Cards> given;
  for (const auto& kind : records::list_element_kinds())
    if (kind.is_always_made)
      kind.visit(deck, [&](const records::ElementView& view) {
        auto& cards = given[view.card];
        if (cards.count++ == 0) cards.first = view.at;
      });
  if (given.empty()) return;
  for (const auto& [name, cards] : given)
    if (made.count(name) == 0)
      diagnostics.error("fe.not-modelled", deck.locate(cards.first),
                        name + " is read but there is no element for it (" + std::to_string(cards.count) +
                            (cards.count == 1 ? " card)" : " cards, the first here)"),
                        "replace it, or --ignore " + name + " to compute without it");
}

}  // namespace bough::fe
