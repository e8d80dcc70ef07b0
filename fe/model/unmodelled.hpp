#pragma once
/// \file No element card of a deck gets lost between the reader and the model.
#include <set>
#include <string>

#include "fe/elements/element.hpp"

namespace bough::fe {

/// Reports fe.not-modelled for each kind of element card of which the deck has some but which is not among `made`,
/// unless there are errors that say why.
void report_unmodelled(const records::Deck& deck, const std::set<std::string>& made, Diagnostics& diagnostics);

}  // namespace bough::fe
