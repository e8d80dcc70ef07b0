#pragma once
/// \file No element card of a deck gets lost between the reader and the model.
#include <memory>
#include <vector>

#include "fe/elements/element.hpp"

namespace bough::fe {

/// Reports fe.not-modelled for each kind of element card of which the deck has some and `elements` none, unless there
/// are errors that say why.
void report_unmodelled(const records::Deck& deck, const std::vector<std::unique_ptr<const Element>>& elements,
                       Diagnostics& diagnostics);

}  // namespace bough::fe
