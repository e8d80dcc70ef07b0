#pragma once
/// \file One table of the element cards: where they are in a deck, their grids, and what they are to programs that do
/// not compute them.
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "formats/records/deck.hpp"

namespace bough::records {

enum class ElementShape { None, Line, Surface, Solid };

/// One element, rigid element or MPC.
struct ElementView {
  int id = 0;                   ///< of MPC the set
  int property = 0;             ///< 0: the card has none
  std::string card;             ///< "CELAS2"
  std::vector<int> grids;       ///< in the card's order; 0: the ground, or a blank field
  std::size_t num_corners = 0;  ///< the first grids are corners of the shape
  ElementShape shape = ElementShape::None;
  int orientation = 0;                              ///< grid of the orientation vector
  bool is_grounded = false;                         ///< one end is the ground
  bool has_moments = false;                         ///< transfers moments at its grids
  std::vector<std::pair<int, unsigned>> dependent;  ///< of rigid elements: (grid, components that it eliminates)
  int centre = 0;                                   ///< of a rigid element that is drawn as a spider; 0: not drawn
  std::vector<int> spokes;                          ///< grids around the centre
  CardLocation at;
};

enum class ElementRole {
  Element,  ///< has stiffness, damping or mass
  Rigid,    ///< rigid elements and MPC
  Drawn,    ///< PLOTEL
};

/// One vector of cards of a deck.
struct ElementKind {
  ElementRole role = ElementRole::Element;
  bool is_always_made = false;  ///< a card without an element in fe is the error fe.not-modelled
  std::function<std::size_t(const Deck&)> count;
  std::function<void(const Deck&, const std::function<void(const ElementView&)>&)> visit;
  std::function<void(const Deck&, const std::function<void(int id, int property)>&)> visit_properties;
  /// Erases the cards for which `is_kept` returns false; called in the order of the cards.
  std::function<void(Deck&, const std::function<bool()>&)> keep;
};

/// A row for each kind; a new element card is a row here.
const std::vector<ElementKind>& list_element_kinds();

/// Calls `f` for each card of the roles, kind by kind.
void visit_elements(const Deck& deck, const std::vector<ElementRole>& roles,
                    const std::function<void(const ElementView&)>& f);
/// Number of cards of a role.
std::size_t count_elements(const Deck& deck, ElementRole role);
/// Erases the cards of the roles whose flag is 0, one flag per card in the order of visit_elements().
void keep_elements(Deck& deck, const std::vector<ElementRole>& roles, const std::vector<char>& is_kept);
/// Erases all cards of a role.
void clear_elements(Deck& deck, ElementRole role);

}  // namespace bough::records
