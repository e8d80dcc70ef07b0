#include "formats/nastran/detail/leftovers.hpp"

#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {

void Leftovers::add(const Card& card) {
  int i = card.find_leftover(0);
  while (i >= 0 && parse_real(card.get(i)) == 0.0) i = card.find_leftover(i + 1);
  if (i < 0) return;
  auto& entry = entries_[{card.get_name(), i}];
  if (entry.count++ > 0) return;
  entry.where = card.locate(i);
  entry.text = Card::name_field(i) + " '" + std::string(card.get(i)) + "'";
}

void Leftovers::report(Diagnostics& diagnostics) const {
  for (const auto& [place, entry] : entries_) {
    const std::string times =
        entry.count == 1 ? "" : " (" + std::to_string(entry.count) + " cards with data there, the first here)";
    diagnostics.warning("deck.unused-field", entry.where, place.first + ": " + entry.text + " is not used" + times,
                        "the card has nothing there; check the columns");
  }
}

}  // namespace bough::nastran::detail
