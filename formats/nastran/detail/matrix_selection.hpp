#pragma once
/// \file K2GG, M2GG, B2GG of the case control: lists of names of DMIG with factors.
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/records/deck.hpp"

namespace bough::nastran::detail {

using MatrixList = std::vector<std::pair<double, std::string>>;  ///< (factor, name)
using NamedSets = std::map<std::string, MatrixList>;             ///< SETs of names, by id

/// "K1, K2" or "1.25*K1, 0.82*K2", also between blanks; false when it is neither.
bool read_matrix_names(std::string_view text, MatrixList& matrices);
/// Replaces ids of sets (the one name of a list, in digits) and gives every subcase the matrices of the first: they
/// belong to the model (Quick Reference Guide, M2GG). Adds deck.case-control-value, deck.case-control-later.
void choose_matrices(records::Deck& deck, const NamedSets& sets, const records::CardLocation& at,
                     Diagnostics& diagnostics);

}  // namespace bough::nastran::detail
