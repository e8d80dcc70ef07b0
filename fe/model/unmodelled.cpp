#include "fe/model/unmodelled.hpp"

#include <map>

namespace bough::fe {

void report_unmodelled(const records::Deck& deck, const std::set<std::string>& made, Diagnostics& diagnostics) {
  if (diagnostics.num_errors() > 0) return;
  struct Cards {
    int count = 0;
    records::CardLocation first;
  };
  std::map<std::string, Cards> given;
  const auto add = [&](const std::string& name, const auto& card) {
    auto& cards = given[name];
    if (cards.count++ == 0) cards.first = card.at;
  };
  for (const auto& card : deck.shells) add(card.card, card);
  for (const auto& card : deck.solids) add(card.card, card);
  for (const auto& card : deck.shear_panels) add("CSHEAR", card);
  for (const auto& card : deck.cbush1d) add("CBUSH1D", card);
  if (given.empty()) return;
  for (const auto& [name, cards] : given)
    if (made.count(name) == 0)
      diagnostics.error("fe.not-modelled", deck.locate(cards.first),
                        name + " is read but there is no element for it (" + std::to_string(cards.count) +
                            (cards.count == 1 ? " card)" : " cards, the first here)"),
                        "replace it, or --ignore " + name + " to compute without it");
}

}  // namespace bough::fe
