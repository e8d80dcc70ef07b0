#pragma once
/// \file Where the case control selects a set.
#include "formats/records/deck.hpp"

namespace bough::records {

/// Where the case control selects set `set` by `command` (SPC, MPC, LOAD, TEMPERATURE, METHOD, SUPORT1, NSM): the
/// first place, for messages; line 0 if none does.
CardLocation find_selection(const Deck& deck, const std::string& command, int set);

}  // namespace bough::records
