#pragma once
/// \file Where a card of a deck starts.

namespace bough::records {

/// Index into Deck::files, 1-based line.
struct CardLocation {
  int file = 0;
  int line = 0;
};

}  // namespace bough::records
