#pragma once
/// \file Executive and case control: which solution, which sets.
#include <cstddef>

#include "formats/nastran/detail/lines.hpp"
#include "formats/nastran/reader.hpp"
#include "formats/records/deck_dynamics.hpp"

namespace bough::nastran::detail {

/// Reads what stands before the bulk data into deck.sol, deck.subcases and (PARAM in case control) deck.params.
/// Returns the index of the first bulk data line. A text without CEND and BEGIN BULK is bulk data from its first line.
/// Adds deck.no-begin-bulk, deck.unsupported-section, deck.case-control-value, deck.case-control-ignored.
/// `dynamics`: where what concerns responses goes; without it those commands are named as not used. With it
/// deck.unsupported-command, a warning for what `options` ignores.
std::size_t read_control(const Source& source, records::Deck& deck, Diagnostics& diagnostics,
                         records::DynamicDeck* dynamics = nullptr, const ReadOptions& options = {});

}  // namespace bough::nastran::detail
