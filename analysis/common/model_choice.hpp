#pragma once
/// \file Choice of the finite-element model of a deck: subcase, supports, mass matrix, ignored cards.
#include <memory>
#include <string>
#include <vector>

#include "fe/model/model.hpp"
#include "formats/records/deck.hpp"

namespace bough::analysis {

struct ModelChoice {
  int subcase = 0;            ///< whose SPC, MPC, LOAD and METHOD are used; 0: the first
  bool free = false;          ///< without the SPC sets
  std::string mass = "deck";  ///< "deck" (PARAM,COUPMASS), "lumped" or "consistent"
  std::vector<std::string> ignore_cards;
};

/// Converts the choice to options of the model builder; mass "deck" leaves the kind of mass matrix to PARAM,COUPMASS.
fe::ModelOptions make_model_options(const ModelChoice& choice);

/// The stress that STATSUB of the subcase of `options` asks for; nullptr for none.
std::shared_ptr<const fe::Prestress> calc_prestress(const records::Deck& deck, const fe::ModelOptions& options,
                                                    Diagnostics& diagnostics);

}  // namespace bough::analysis
