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

/// A column of a DMIG that P2G adds to the loads of a subcase.
struct LoadColumn {
  double scale = 1;
  std::string matrix;
  int column = 1;
};
using LoadColumns = std::map<int, std::vector<LoadColumn>>;  ///< by subcase

/// P2G of each subcase with the names of its sets: the k-th subcase that selects a matrix has column k of it (MSC adds
/// the matrix of loads, a column for each load case). Adds deck.case-control-value.
LoadColumns choose_load_columns(const records::Deck& deck, const std::map<int, MatrixList>& selected,
                                const NamedSets& sets, const records::CardLocation& at, Diagnostics& diagnostics);
/// Makes a load set of the LOAD and of the columns of each such subcase: FORCE and MOMENT in the displacement systems
/// of the grids, SLOAD, times PARAM,CP2, with the LOAD times PARAM,CP1. The matrices are gone then. Adds
/// deck.load-columns, deck.load-matrix.
void add_load_columns(const LoadColumns& columns, records::Deck& deck, Diagnostics& diagnostics);

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
/// Selects as choose_matrices does. `joins_model`: the matrices are added to K2GG, M2GG and B2GG of every subcase.
void add_direct_input(records::DynamicDeck& deck, const NamedSets& sets, const records::CardLocation& at,
                      Diagnostics& diagnostics, bool joins_model);

}  // namespace bough::nastran::detail
