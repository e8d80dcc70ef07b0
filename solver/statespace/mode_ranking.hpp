#pragma once
/// \file Which modes of a body to keep, by component cost (docs/theory/linear.md).
#include <string>
#include <vector>

#include "formats/records/flex_body.hpp"
#include "solver/statespace/cost.hpp"

namespace bough::statespace {

/// A unit force (1..3) or moment (4..6) at an output node, or the displacement or rotation there.
struct NodeDirection {
  int node = 0;       ///< id
  int direction = 0;  ///< 1..6, body axes
};

struct ModeCost {
  double cost = 0;         ///< V_i: of the mode's displacement and rate together
  double closed_form = 0;  ///< of the mode alone, lightly damped; 0 where it has no damping or stiffness
};

struct ModeRanking {
  std::vector<ModeCost> modes;  ///< one per mode of the body
  double total = 0;             ///< V
  double other = 0;             ///< V less the sum over the modes: hinges, other bodies; 0 for a body alone
};

/// M η̈ + D η̇ + K η = Bᵀu, y = C η of the body held in its frame, x = [η; η̇]. Modes without damping get
/// `otherwise_damping` as their ratio.
StateSpace make_state_space(const records::FlexBody& body, const std::vector<NodeDirection>& inputs,
                            const std::vector<NodeDirection>& outputs, double otherwise_damping);

/// White noise at the inputs of that, the mean square of its outputs. Throws ComputationError "select.unstable".
ModeRanking rank_modes(const records::FlexBody& body, const std::vector<NodeDirection>& inputs,
                       const std::vector<NodeDirection>& outputs, double otherwise_damping);

struct SelectionRules {
  int number = 0;        ///< keep so many, 0: no such rule
  double tolerance = 0;  ///< drop modes that together cost at most this part of V
  double below_hz = 0;   ///< drop modes above it, 0: no such rule
  bool by_cost = true;   ///< false: only below_hz counts
};

struct Choice {
  bool kept = true;
  std::string reason;
  bool within_tolerance = false;  ///< it went, by that rule
};

/// What goes, the cheapest first as far as the rules let it; of a rule by tolerance the caller may take back some
/// (`keep_dearest`). Modes that are no normal modes (constraint, attachment, residual) and those at zero frequency stay
/// always.
std::vector<Choice> choose_modes(const records::FlexBody& body, const ModeRanking& ranking,
                                 const SelectionRules& rules);

/// Takes back all but the `num_dropped` cheapest of those that went within the tolerance.
void keep_dearest(const ModeRanking& ranking, std::size_t num_dropped, std::vector<Choice>& choices);

/// ‖C (K⁻¹ - K_r⁻¹) Bᵀ‖ / ‖C K⁻¹ Bᵀ‖: what the static response loses with the modes that go.
double calc_static_error(const records::FlexBody& body, const std::vector<int>& kept,
                         const std::vector<NodeDirection>& inputs, const std::vector<NodeDirection>& outputs);

}  // namespace bough::statespace
