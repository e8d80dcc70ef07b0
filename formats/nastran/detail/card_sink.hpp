#pragma once
/// \file Target of the writers of cards.
#include <string>

#include "formats/nastran/detail/card_text.hpp"

namespace bough::nastran::detail {

/// Where the cards of one deck go.
struct CardSink {
  FieldFormat format = FieldFormat::Large;
  std::string out;
  /// Appends the lines of a card to `out`.
  void put(const CardFields& card) { card.write(format, out); }
};

}  // namespace bough::nastran::detail
