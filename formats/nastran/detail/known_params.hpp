#pragma once
/// \file Names and values of PARAM in the Nastran family.
#include "formats/records/deck.hpp"

namespace bough::nastran::detail {

/// Values of the PARAM that Bough uses that are none of their kind (fe.bad-param): an error, after which the card is
/// left out of the deck, or a warning with what it is taken as. One note with every PARAM that has no effect here, by
/// line (deck.unused-params), and a warning for each name that no Nastran knows, with the nearest that one does
/// (deck.unknown-param).
/// A value that changes the answer and that Bough does not honour is an error, a warning where `ignored` has the name
/// (deck.unsupported-param).
/// `of_responses`: those of responses have an effect too.
void report_params(records::Deck& deck, const std::vector<std::string>& ignored, Diagnostics& diagnostics,
                   bool of_responses = false);

/// Returns true if the parameter changes the answer; with `of_responses`, that of a response.
bool is_used_param(std::string_view name, bool of_responses);

}  // namespace bough::nastran::detail
