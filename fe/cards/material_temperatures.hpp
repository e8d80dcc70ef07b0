#pragma once
/// \file Materials over temperature (MATT1, MATT2, MATT8, MATT9) at the temperatures of the elements.
#include <memory>

#include "fe/elements/element.hpp"

namespace bough::fe {

/// Evaluates the tables of materials at the mean temperature of each element, in the set that
/// TEMPERATURE(MATERIAL), (BOTH) or, without them, (INITIAL) of the subcase selects. The temperature of a CWELD is the
/// mean of the grids of its two shells.
///
/// \param nodes  of the deck: where a CWELD is on the shells of a property.
/// \return the deck with materials and properties for each temperature, to which the elements refer; nullptr if no
///   material of the deck has a table or no set is selected. Elements keep their ids and order.
/// Reports fe.missing-load (no card in the set), fe.missing-temperature, fe.missing-material-table, fe.missing-material
/// (a MATTi whose MATi the deck has not), fe.material-tables-unused (warning).
std::unique_ptr<const records::Deck> evaluate_materials(const records::Deck& deck, const records::Subcase& subcase,
                                                        const NodeTable& nodes, Diagnostics& diagnostics);

}  // namespace bough::fe
