#pragma once
/// \file Options of the verbs that make a finite-element model of a deck.
#include <string>
#include <vector>

#include "fe/model/model.hpp"

namespace CLI {
class App;
}

namespace bough::cli {

struct DeckModelOptions {
  int subcase = 0;
  bool free = false;
  std::string mass = "deck";
  std::vector<std::string> ignore_cards;
};

void add_model_options(CLI::App& verb, DeckModelOptions& options);
fe::ModelOptions make_model_options(const DeckModelOptions& options);

/// The stress that STATSUB of the subcase of `options` asks for; nullptr for none.
std::shared_ptr<const fe::Prestress> calc_prestress(const records::Deck& deck, const fe::ModelOptions& options,
                                                    Diagnostics& diagnostics);

}  // namespace bough::cli
