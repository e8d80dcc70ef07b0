#pragma once
/// \file records::Deck to a Nastran deck.
#include <string>

#include "formats/records/deck.hpp"

namespace bough::nastran {

enum class FieldFormat {
  Large,  ///< a card in 8 columns where every number is exact there, else in 16: ten digits at least, mostly all
  Small,  ///< always 8 columns: as many digits of a real as fit, for old programs
  Free    ///< between commas with 17 digits where needed: read back bit for bit
};

struct WriteOptions {
  FieldFormat fields = FieldFormat::Large;
};

/// The deck as text: executive and case control, then every card, defaults (GRDSET, BAROR), lists and replication
/// written out. Reading it again gives the same record (reals as `fields` says).
/// Adds "deck.not-written" (error) for a card that the record holds and the writer does not know, and
/// "deck.left-out" (warning) for cards that the record never held. Units and frames are the deck's.
std::string write_deck(const records::Deck& deck, const WriteOptions& options, Diagnostics& diagnostics);

}  // namespace bough::nastran
