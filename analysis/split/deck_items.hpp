#pragma once
/// \file Elements, rigid elements and their grids of a deck, each kind visited in one order.
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
};

/// Calls f(vector of one kind) for each kind of element, in the order of list_elements.
template <class Deck, class F>
void visit_elements(Deck& deck, F&& f) {
  f(deck.beams), f(deck.crod), f(deck.conrod), f(deck.ctube), f(deck.special.cbend);
  f(deck.springs), f(deck.cbush), f(deck.cbush1d), f(deck.dampers), f(deck.cvisc), f(deck.special.cgap);
  f(deck.shells), f(deck.shear_panels), f(deck.solids), f(deck.special.genel);
  f(deck.scalar_masses), f(deck.conm1), f(deck.conm2), f(deck.plotel);
}

/// Calls f(vector of one kind) for each kind of rigid element and for MPC, in the order of list_rigid.
template <class Deck, class F>
void visit_rigid(Deck& deck, F&& f) {
  f(deck.rbe2), f(deck.rbe3), f(deck.rbar), f(deck.rrod), f(deck.rbe1), f(deck.special.rspline), f(deck.mpc);
}

std::vector<DeckItem> list_elements(const records::Deck& deck);
std::vector<DeckItem> list_rigid(const records::Deck& deck);

/// Keeps the elements (rigid: rigid elements and MPC) with is_kept[index in the list of the deck].
void keep_elements(records::Deck& deck, const std::vector<char>& is_kept);
void keep_rigid(records::Deck& deck, const std::vector<char>& is_kept);

/// Grids that carry no load of the card: orientations, coordinate systems by grids, lines of action of loads.
std::vector<int> list_reference_grids(const records::Deck& deck);

/// (grid, component mask) that rigid elements and MPC make dependent.
std::vector<std::pair<int, unsigned>> list_dependent(const records::Deck& deck);

/// "CQUAD4 17"
std::string name_item(const DeckItem& item);

}  // namespace bough::analysis::splitting
