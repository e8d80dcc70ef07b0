#pragma once
/// \file Blocks of lagged stiffening for the bodies of a system file.
#include <memory>
#include <vector>

#include "solver/builder/build.hpp"
#include "solver/signals/block.hpp"

namespace bough::solver {

/// The scheme of NASA-CR-202063, eq. 18, for each flexible body that is to be stiffened: every stiffening_step it
/// measures A_I at the body's origin (12 outputs) and the loads FCONI at its nodes with locators, and until the next
/// time puts -(Σ K_G1 A_I + Σ K_G2 FCONI) η on the modes. Loads are those of hinges and of [[force]] without a type;
/// warns "system.lagged-loads" of others, and "system.lagged-hinges" where there are hinges among them.
std::vector<std::unique_ptr<Block>> make_lagged_stiffening(const records::SystemSpec& spec, const System& system,
                                                           const FlexMap& flex, Diagnostics& diagnostics);

}  // namespace bough::solver
