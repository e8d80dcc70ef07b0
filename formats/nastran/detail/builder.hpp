#pragma once
/// \file From card images to card texts: joins lines, carries out replication, hands each card to its parser.
#include "formats/nastran/detail/images.hpp"
#include "formats/nastran/detail/reading.hpp"
#include "formats/nastran/reader.hpp"
#include "formats/records/deck_dynamics.hpp"

namespace bough::nastran::detail {

/// Reads the bulk data from `first_line` on into deck. Adds deck.orphan-continuation, deck.unreadable-line,
/// deck.too-many-fields, deck.bad-replication, deck.unsupported-card, deck.ignored-card, deck.unused-card,
/// deck.unknown-card and what the parsers add. `dynamics`: where the cards of responses go; without it they are not
/// read.
void read_bulk(const Source& source, std::size_t first_line, const ReadOptions& options, records::Deck& deck,
               Diagnostics& diagnostics, records::DynamicDeck* dynamics = nullptr);

}  // namespace bough::nastran::detail
