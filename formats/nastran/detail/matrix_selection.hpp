#pragma once
/// \file K2GG, M2GG, B2GG of the case control: lists of names of DMIG with factors.
#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/records/deck_dynamics.hpp"

namespace bough::nastran::detail {

using MatrixList = std::vector<std::pair<double, std::string>>;  ///< (factor, name)
using NamedSets = std::map<std::string, MatrixList>;             ///< SETs of names, by id

/// "K1, K2" or "1.25*K1, 0.82*K2", also between blanks; false when it is neither.
bool read_matrix_names(std::string_view text, MatrixList& matrices);
/// Replaces ids of sets (the one name of a list, in digits) and gives every subcase the matrices of the first: they
/// belong to the model (Quick Reference Guide, M2GG). Adds deck.case-control-value, deck.case-control-later.
void choose_matrices(records::Deck& deck, const NamedSets& sets, const records::CardLocation& at,
                     Diagnostics& diagnostics);

/// K2PP, M2PP, B2PP: direct input of responses alone.
struct DirectInput {
  const char* name;
  MatrixList records::DynamicSelection::*list;
  MatrixList records::Subcase::*model;  ///< the list of the model that they add to
};
inline constexpr std::array direct_inputs{
    DirectInput{"K2PP", &records::DynamicSelection::k2pp, &records::Subcase::k2gg},
    DirectInput{"M2PP", &records::DynamicSelection::m2pp, &records::Subcase::m2gg},
    DirectInput{"B2PP", &records::DynamicSelection::b2pp, &records::Subcase::b2gg}};
/// As choose_matrices; what they select is added to K2GG, M2GG and B2GG of every subcase.
void add_direct_input(records::DynamicDeck& deck, const NamedSets& sets, const records::CardLocation& at,
                      Diagnostics& diagnostics);

}  // namespace bough::nastran::detail
