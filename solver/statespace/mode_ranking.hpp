#pragma once
/// \file Choice of the modes of a body by component cost (docs/theory/linear.md).
#include <string>
#include <vector>

#include "formats/records/flex_body.hpp"
#include "solver/statespace/cost.hpp"
#include "solver/statespace/spectrum.hpp"

namespace bough::statespace {

/// A unit force (1..3) or moment (4..6) at an output node, or the displacement or rotation there, or its rate.
struct NodeDirection {
  int node = 0;          ///< id
  int direction = 0;     ///< 1..6, body axes
  bool is_rate = false;  ///< of outputs
  double weight = 1;     ///< of the output, or of the amplitude of the input
};

struct ModeCost {
  double cost = 0;         ///< V_i: of the mode's displacement and rate together
  double closed_form = 0;  ///< of the mode alone, lightly damped; 0 if it has no damping or stiffness
};

struct ModeRanking {
  std::vector<ModeCost> modes;  ///< one per mode of the body
  double total = 0;             ///< V
  double other = 0;             ///< V minus the sum over the modes: hinges, other bodies; 0 for a body alone
};

/// M η̈ + D η̇ + K η = Bᵀu, y = C_d η + C_r η̇ of the body held in its frame, x = [η; η̇]. Modes without damping get
/// `otherwise_damping` as their ratio.
StateSpace make_state_space(const records::FlexBody& body, const std::vector<NodeDirection>& inputs,
                            const std::vector<NodeDirection>& outputs, double otherwise_damping);

/// White noise at the inputs of that, or noise of a spectrum, and the mean square of its outputs. Throws
/// ComputationError "select.unstable".
ModeRanking rank_modes(const records::FlexBody& body, const std::vector<NodeDirection>& inputs,
                       const std::vector<NodeDirection>& outputs, double otherwise_damping,
                       const Spectrum* spectrum = nullptr);

/// The Hankel singular value of each mode alone, lightly damped (two states have it each):
/// |b| sqrt(|c_d|² + ω² |c_r|²) / (4 ζ ω²). 0 if it has no damping or stiffness.
Eigen::VectorXd calc_modal_hankel(const records::FlexBody& body, const std::vector<NodeDirection>& inputs,
                                  const std::vector<NodeDirection>& outputs, double otherwise_damping);

/// Properties of a mode on which its choice depends, apart from its cost.
struct ModeTraits {
  records::ModeKind kind = records::ModeKind::Normal;
  bool is_rigid = false;  ///< eigenvalue below 1e-12 of the largest of its body
  double frequency_hz = 0;
  int body = 0;  ///< modes of different bodies are never of one group
};

/// Appends the modes of a body. \param number  of the body, from 0.
void add_traits(const records::FlexBody& body, int number, std::vector<ModeTraits>& traits);

/// Returns the number of each mode's group. Modes of one body and one frequency (to `closeness` of it) that share their
/// cost are a group: solvers of decks rotate such modes among each other by chance, and their single costs with them. A
/// mode with less than a thousandth of the group's largest cost is a group alone: the others move without it.
std::vector<int> group_modes(const std::vector<ModeTraits>& traits, const ModeRanking& ranking,
                             double closeness = 1e-3);
/// Each mode's cost, of a group the mean of its costs.
std::vector<double> calc_modified_costs(const ModeRanking& ranking, const std::vector<int>& groups);

/// Ranks modes for several configurations: the largest cost of each mode, relative to V. total is 1.
ModeRanking combine_worst(const std::vector<ModeRanking>& rankings);

struct SelectionRules {
  int number = 0;                ///< number of modes to retain, 0: no such rule
  double tolerance = 0;          ///< drop modes that together cost at most this part of V
  double below_hz = 0;           ///< drop modes above it, 0: no such rule
  bool by_cost = true;           ///< false: only below_hz counts
  std::vector<int> pinned = {};  ///< modes, from 0, that stay
};

struct Choice {
  bool kept = true;
  std::string reason;
  bool within_tolerance = false;  ///< it went, by that rule
  bool by_cost = false;           ///< its cost has decided, no other rule
};

/// Modes to truncate, the lowest cost first, as far as the rules allow; of a rule by tolerance the caller may retain
/// some (`keep_dearest`). Modes that are not normal (constraint, attachment, residual), those at zero frequency and
/// those that are pinned are always retained. Modes of one frequency are ranked by their mean cost, and truncated
/// together by the tolerance or not at all. Costs that differ by less than 1e-7 are equal: then the first mode goes.
std::vector<Choice> choose_modes(const std::vector<ModeTraits>& traits, const ModeRanking& ranking,
                                 const SelectionRules& rules);

/// Takes back all but the `num_dropped` cheapest of those that went within the tolerance, and with one of one frequency
/// the others.
void keep_dearest(const std::vector<ModeTraits>& traits, const ModeRanking& ranking, std::size_t num_dropped,
                  std::vector<Choice>& choices);

/// ‖C (K⁻¹ - K_r⁻¹) Bᵀ‖ / ‖C K⁻¹ Bᵀ‖: what the static response loses with the modes that go.
double calc_static_error(const records::FlexBody& body, const std::vector<int>& kept,
                         const std::vector<NodeDirection>& inputs, const std::vector<NodeDirection>& outputs);

}  // namespace bough::statespace
