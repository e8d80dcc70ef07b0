#pragma once
/// \file Subcases that SOL 103 solves, pairs of SOL 105, and the load factors of a pair.
#include "fe/statics/static_case.hpp"
#include "modal/eigen.hpp"

namespace bough::modal {

/// Returns true for SOL 105, 5, SEBUCKL and BUCKLING.
bool is_buckling_solution(const records::Deck& deck);

/// Lists the subcases that SOL 103 solves, each with its METHOD, SPC and MPC, without those that select the same as an
/// earlier one. Otherwise one id (0: the first subcase).
std::vector<int> list_mode_subcases(const records::Deck& deck);

/// The static subcase carries LOAD or TEMPERATURE(LOAD), the buckling one METHOD and perhaps STATSUB.
struct BucklingCases {
  records::Subcase statics, buckling;
};

/// Every pair of subcases that SOL 105 solves: those with STATSUB, else those with METHOD and without a load of their
/// own, else those with METHOD, each with the static subcase that it names or with the first. `requested`: a subcase of
/// the pair, 0 for all. Throws InputError cli.no-static-load.
std::vector<BucklingCases> list_buckling_cases(const records::Deck& deck, int requested);

/// The load that the factors multiply: "load factors of LOAD 3, TEMPERATURE 5 (subcase 1)".
std::string describe_load(const records::Subcase& statics);

/// The buckling subcase with the preload that its load factors count from: STATSUB(PRELOAD), 0 for none.
records::Subcase get_preloaded(const records::Deck& deck, const BucklingCases& cases);

/// The lowest load factors by magnitude on `model`, which is held and preloaded as the buckling subcase says
/// (and `model_options` too); with V1 and V2 (min_hz,
/// max_hz of `eigen`) as many between them, though others are nearer to zero.
EigenPairs solve_buckling(const records::Deck& deck, const BucklingCases& cases, fe::ModelOptions model_options,
                          const fe::Model& model, EigenOptions eigen, Diagnostics& diagnostics);

}  // namespace bough::modal
