#pragma once
/// \file From a deck to a model that can be solved: the order of the steps.
#include "fe/model/model.hpp"

namespace bough::fe {

/// Model of a deck with its a-set and the check of its prestress. Throws InputError with every error of the deck that
/// concerns fe, ComputationError "fe.preload-buckles" if K with K_G0 of the prestress is not definite. Collective.
Model build_model(const records::Deck& deck, const ModelOptions& options, Diagnostics& diagnostics);
/// Model with elements from `elements` instead of make_elements().
Model build_model(const records::Deck& deck, const ModelOptions& options, const ElementFactory& elements,
                  Diagnostics& diagnostics);

}  // namespace bough::fe
