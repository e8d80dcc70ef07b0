#pragma once
/// \file SUBCOM, SYMCOM and REPCASE: sums of the results of static subcases; extremes over subcases (MAXMIN).
#include "fe/model/model.hpp"
#include "formats/records/deck_dynamics.hpp"
#include "formats/records/static_result.hpp"

namespace bough::analysis {

/// Σ factor × result of the subcases, all of `model`'s elements. Nonlinear results are recomputed: strain energies
/// (½ uᵀKu, without what temperatures store), von Mises and principal values, failure indices, extremes. Throws
/// InputError("cli.combination-missing") where a subcase that it names was not solved.
records::StaticSubcase combine(const fe::Model& model, const records::Deck& deck,
                               const records::CaseCombination& combination,
                               const std::vector<records::StaticSubcase>& solved);

}  // namespace bough::analysis
