#pragma once
/// \file Fill levels of flexible bodies: a System for each combination.
#include "solver/builder/build_system.hpp"

namespace bough::solver {

/// Builds the variants of a system of draft_system: one for each combination of the levels of its bodies, with equal
/// rows of states, signals and channels. Reports "system.bad-levels".
void build_variants(const records::SystemSpec& spec, const FlexMap& flex, System& system, Diagnostics& diagnostics);

}  // namespace bough::solver
