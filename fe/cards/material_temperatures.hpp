#pragma once
/// \file Materials over temperature (MATT1, MATT2, MATT8, MATT9) at the temperatures of the elements.
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "fe/elements/element.hpp"

namespace bough::fe {

/// A deck with copies of materials and properties for each temperature, to which the elements refer.
struct EvaluatedDeck {
  std::unique_ptr<const records::Deck> deck;  ///< nullptr: no material is evaluated
  /// Material or property of the deck, and the temperature, by the id of each copy.
  std::map<int, std::pair<int, double>> copies;

  /// Text with the ids of the deck in place of those of copies: "MAT1 4" is "MAT1 1 at temperature 50".
  std::string name_originals(const std::string& text) const;
};

/// Evaluates the tables of materials at the mean temperature of each element, in the set that
/// TEMPERATURE(MATERIAL), (BOTH) or, without them, (INITIAL) of the subcase selects. The temperature of a CWELD is the
/// mean of the grids of its two shells.
///
/// \param nodes  of the deck: where a CWELD is on the shells of a property.
/// \return no deck if no material has a table or no set is selected. Elements keep their ids and order.
/// Reports fe.missing-load (no card in the set), fe.missing-temperature, fe.missing-material-table, fe.missing-material
/// (a MATTi whose MATi the deck has not), fe.material-tables-unused (warning).
EvaluatedDeck evaluate_materials(const records::Deck& deck, const records::Subcase& subcase, const NodeTable& nodes,
                                 Diagnostics& diagnostics);

}  // namespace bough::fe
