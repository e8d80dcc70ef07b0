#pragma once
/// \file The deck of one subcase as grids, elements and constraints that can be partitioned.
#include <map>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "analysis/split/deck_items.hpp"
#include "fe/model/model.hpp"

namespace bough::analysis::splitting {

struct Structure {
  records::Deck deck;  ///< of one subcase: its SPC and MPC sets alone, under one id each
  std::vector<DeckItem> elements, rigid;
  std::map<int, Eigen::Vector3d> position;  ///< of the grids, in basic
  std::map<int, Eigen::Matrix3d> axes;      ///< CD axes of the grids, columns in basic
  std::map<int, records::CardLocation> at;  ///< of the GRID cards
  std::set<std::pair<int, int>> pinned;     ///< CBAR or CBEAM and its grid where it releases a rotation
  std::set<int> joined;                     ///< grids and points of elements and rigid elements
  std::map<int, unsigned> held;             ///< components of joined grids that the deck holds, without common_held
  bool has_material_damping = false;        ///< GE or PARAM,G
  double alpha1 = 0, alpha2 = 0;            ///< PARAM,ALPHA1 and ALPHA2
  unsigned common_held = 0;                 ///< components that are held at every grid of an element: a planar model

  /// Returns file and line of a card of the deck.
  SourceLocation locate(const records::CardLocation& card) const { return deck.locate(card); }
  /// Returns file and line of a GRID card; the file alone for an unknown id.
  SourceLocation locate_grid(int id) const {
    const auto found = at.find(id);
    return deck.locate(found == at.end() ? records::CardLocation{} : found->second);
  }
};

/// Returns true for elements that join two grids or more.
inline bool is_structural(const DeckItem& item) { return !item.is_drawn && item.grids.size() > 1; }

/// \param model  built from `deck` for the same subcase
/// \throws InputError split.superelements, split.preload
Structure make_structure(const records::Deck& deck, const fe::Model& model, Diagnostics& diagnostics);

}  // namespace bough::analysis::splitting
