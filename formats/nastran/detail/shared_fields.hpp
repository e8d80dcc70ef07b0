#pragma once
/// \file Fields that cards of two files have in common.
#include <vector>

#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {

/// A J C NSM of a rod from field `first` on: of PROD and CONROD. Then where the card is.
template <class Rod>
void read_rod_section(Card& card, int first, Rod& rod) {
  card.read_reals(first, {{"A", rod.A, 0.0}, {"J", rod.J, 0.0}, {"C", rod.c, 0.0}, {"NSM", rod.nsm, 0.0}});
  rod.at = card.get_location();
  card.demand(rod.A >= 0, first, "A", "an area that is not negative");
  card.demand(rod.J >= 0, first + 1, "J", "a value that is not negative");
}

/// SID CID A N1 N2 N3 of an acceleration: of GRAV and ACCEL1.
template <class Acceleration>
void read_acceleration(Card& card, Acceleration& load) {
  load.sid = card.read_id(0, "SID");
  load.cid = card.read_reference(1, "CID");
  load.a = card.read_real(2, "A", 0.0);
  load.n = card.read_vector(3, "N1 N2 N3");
}

/// Calls add(components, range) for C ID1 ID2 ... or C ID1 THRU ID2 from field `first` on; nothing if the card has an
/// error.
template <class Add>
void read_components_of_ids(Card& card, int first, const char* what, const Add& add) {
  const unsigned c = card.read_components(first, "C", 0);
  const auto list = read_id_list(card, first + 1, card.get_size(), what);
  if (list.empty() && card.is_ok())
    card.fail("deck.missing-field", first + 1, std::string(what) + " is blank, expected a grid at least");
  if (!card.is_ok()) return;
  for (const auto& range : list) add(c, range);
}

/// Adds an element of NASTRAN-95 as the card `today`. \param property  "PQUAD2", "PIHEX"; empty: it names a material.
template <class Shape>
void add_old_element(Card& card, Reading& r, Shape&& e, const char* today, const char* property, IdSpace space,
                     std::vector<Shape>& elements, std::vector<OldElements::Use>& uses) {
  e.card = today;
  e.at = card.get_location();
  if (!r.claim(space, e.id, card)) return;
  uses.push_back({elements.size(), property});
  r.old_elements.count(card, today);
  elements.push_back(std::move(e));
}

}  // namespace bough::nastran::detail
