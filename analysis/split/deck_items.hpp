#pragma once
/// \file Elements, rigid elements and their grids of a deck.
#include <string>
#include <utility>
#include <vector>

#include "formats/records/deck.hpp"

namespace bough::analysis::splitting {

/// A card with what partitioning needs of it.
struct DeckItem {
  int id = 0, property = 0;
  std::string card;
  std::vector<int> grids;    ///< grids and scalar points, each once
  bool is_grounded = false;  ///< one end is the ground
  bool is_drawn = false;     ///< PLOTEL
  bool has_moments = false;  ///< transfers moments at its grids
  records::CardLocation at;
  int centre = 0;           ///< reference grid of an RBE3; hub of other rigid elements
  std::vector<int> shells;  ///< of CFAST and CWELD: ids of the shells whose motion its ends follow; none by grids
};

// The kinds are rows of formats/records/element_cards.cpp.
/// Lists the elements of the deck, then its PLOTEL elements; the grids of each are ascending, without repetition and
/// without 0.
std::vector<DeckItem> list_elements(const records::Deck& deck);
/// Lists the rigid elements and MPC equations of the deck.
std::vector<DeckItem> list_rigid(const records::Deck& deck);

/// Keeps the elements (rigid: rigid elements and MPC) with is_kept[index in the list of the deck].
void keep_elements(records::Deck& deck, const std::vector<char>& is_kept);
void keep_rigid(records::Deck& deck, const std::vector<char>& is_kept);

/// Grids that carry no load of the card: orientations, places of connectors, coordinate systems by grids, lines of
/// action of loads.
std::vector<int> list_reference_grids(const records::Deck& deck);

/// (grid, component mask) that rigid elements and MPC make dependent.
std::vector<std::pair<int, unsigned>> list_dependent(const records::Deck& deck);

/// "CQUAD4 17"
std::string name_item(const DeckItem& item);

}  // namespace bough::analysis::splitting
