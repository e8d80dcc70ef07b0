#pragma once
/// \file Card fields of the property names of DVPREL1, DVMREL1 and DVCREL1.
#include <string>

#include "formats/nastran/detail/card.hpp"

namespace bough::nastran::detail {

/// The first field of the entry `id` on the card (PELAS, PMASS, PDAMP and PVISC hold several), or -1.
int find_entry(const CardText& text, int id);
/// Index of the data field that `name` ("T", "DIM2", "THETA3", or the number of a field as the manuals count) means on
/// the entry that begins at field `first`, or -1.
int find_design_field(const CardText& text, const std::string& name, int first);

}  // namespace bough::nastran::detail
