#pragma once
/// \file ALPHA of rigid elements.
#include <algorithm>

#include "formats/nastran/detail/reading.hpp"

namespace bough::nastran::detail {

/// Says once a deck with TEMPERATURE(LOAD) that rigid elements do not expand (as with RIGID = LINEAR, Nastran's
/// default).
inline void note_expansion(const Card& card, Reading& r, double alpha) {
  const auto is_reported = [](const Diagnostic& item) { return item.id == "deck.rigid-expansion"; };
  const auto is_heated = [](const records::Subcase& subcase) { return subcase.temperature != 0; };
  const auto& reported = r.diagnostics.items();
  const auto& subcases = r.deck.subcases;
  if (alpha == 0 || std::none_of(subcases.begin(), subcases.end(), is_heated) ||
      std::any_of(reported.begin(), reported.end(), is_reported))
    return;
  r.diagnostics.note("deck.rigid-expansion", r.deck.locate(card.get_location()),
                     std::string(card.get_name()) + " has ALPHA, which is not used: rigid elements do not expand",
                     "as with RIGID = LINEAR; where the link should grow with its temperature, use a stiff bar");
}

}  // namespace bough::nastran::detail
