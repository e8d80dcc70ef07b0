#include "modal/eigen.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "fe/linear/memory_need.hpp"
#include "modal/element_strain.hpp"
#include "modal/eps_types.hpp"
#include "modal/normal_modes.hpp"
#include "modal/null_motions.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal {

namespace {

using detail::Answer;
using detail::NormalModes;

/// Solves by the chosen EPS type (choose_solver), and again by block Lanczos if Krylov-Schur has missed modes.
Answer solve_twice(NormalModes& modes, const EigenOptions& options) {
  Answer answer = modes.solve(options.solver);
  if (!answer.is_valid && modes.has_second_solver()) answer = modes.solve(detail::kBlockLanczos);
  return answer;
}

/// The plan of every solution: first from K shifted by a little M, the rigid-body motions of the whole known; where
/// that leaves a doubt, every zero-energy motion known before, of parts too, with supports in K in place of the
/// shift. The second answer counts where it is sound and better.
Answer find_answer(const fe::System& system, const EigenOptions& options) {
  std::optional<Answer> answer;
  std::optional<ComputationError> refusal;
  try {
    NormalModes modes(system, options, detail::find_rigid_motions);
    answer = solve_twice(modes, options);
    if (answer->is_accurate()) return std::move(*answer);
  } catch (const ComputationError& error) {
    if (error.items().front().id == "modal.no-mass") throw;
    refusal = error;
  }
  try {
    NormalModes modes(system, options, detail::find_null_motions);
    if (modes.knows_motions()) {
      Answer other = solve_twice(modes, options);
      const bool is_better = !answer || !answer->is_valid || other.worst() < answer->worst();
      if (is_better && other.is_valid && other.worst_roundoff < detail::kVagueRoundoff) answer = std::move(other);
    }
  } catch (const ComputationError&) {  // keep the first diagnostics: they are closer to the model
  }
  if (!answer) throw *refusal;
  return std::move(*answer);
}

/// All modes of a model up to this many dofs are found, however many were asked for.
constexpr int most_whole = 1000;

/// Recomputes ill-conditioned modes from the strain of the elements. Soft modes that are not requested may mix with
/// requested ones if K does not separate them: further modes are computed as long as this reduces the error.
detail::Restored find_soft(const fe::System& system, const EigenOptions& options, EigenPairs& pairs) {
  constexpr int max_modes = 400;
  const auto number = static_cast<int>(pairs.lambda.size());
  auto restored = detail::restore_digits(system, number, !options.min_hz, pairs);
  if (options.min_hz || options.max_hz) return restored;
  for (int more = 2 * number + 10; more < max_modes; more = 2 * more + 10) {
    if (!restored.is_done || restored.error <= detail::kSureError) break;
    EigenOptions wider = options;
    wider.num_modes = std::min(more, system.model.num_fdofs());
    try {
      auto others = find_answer(system, wider).pairs;
      const auto again = detail::restore_digits(system, number, true, others);
      if (again.is_done && again.error < restored.error && others.lambda.size() >= number) {
        restored = again;
        pairs.lambda = others.lambda.head(number);
        pairs.residual = others.residual.head(number);
        pairs.Phi = others.Phi.leftCols(number);
        pairs.modal_mass.resize(0), pairs.energy_share.resize(0);
        pairs.num_rigid = std::min(number, others.num_rigid);
        pairs.solvers = others.solvers;
      }
    } catch (const ComputationError&) {
      break;  // keep the modes of the first pass, with their diagnostics
    }
    if (wider.num_modes == system.model.num_fdofs()) break;
  }
  return restored;
}

/// Says which springs took the last free dofs from AUTOSPC's point of view, where that is why there are none.
[[noreturn]] void refuse_held_model(const fe::Model& model) {
  std::string what = "the model has no free dof", advice = "check its SPC sets and rigid elements";
  if (!model.autospc().empty()) {
    const auto& first = model.autospc().front();
    what += ": AUTOSPC holds " + std::to_string(model.autospc().size()) + " without stiffness, the first at grid " +
            std::to_string(first.node);
  }
  throw ComputationError("modal.no-dofs", {}, what, advice);
}

void check_request(const fe::Model& model, const EigenOptions& options) {
  if (model.num_fdofs() == 0) refuse_held_model(model);
  if (model.num_fdofs() > most_whole && options.num_modes > model.num_fdofs() && !options.max_hz)
    throw InputError("modal.more-than-dofs", {},
                     std::to_string(options.num_modes) + " modes are asked for, the model has " +
                         std::to_string(model.num_fdofs()) + " free dofs",
                     "ask for as many as the motion needs: all of them would take a dense matrix of every dof");
}

/// The first element of the deck with negative stiffness; empty: none.
std::string describe_first_negative(const fe::Model& model) {
  std::string text;
  MatrixXd K;
  for (std::size_t e = 0; e < model.elements().size() && text.empty(); ++e) {
    const auto& element = model.elements()[e];
    K.setZero(element->num_dofs(), element->num_dofs());
    model.add_stiffness(*element, K);
    if (K.size() == 0 || K.diagonal().minCoeff() >= 0) continue;
    text = "; " + element->card() + " " + std::to_string(element->id()) + " has negative stiffness";
  }
  return text;
}

/// A motion whose stiffness is negative grows by itself; a model on negative springs may well want to show it.
void warn_of_negative(const fe::Model& model, const EigenPairs& pairs, Diagnostics& diagnostics) {
  const auto kept = pairs.lambda.size() - std::min<Eigen::Index>(pairs.num_rigid, pairs.lambda.size());
  if (kept == 0) return;
  const auto lambda = pairs.lambda.tail(kept).array();
  const auto number = (lambda < -detail::kNegative * lambda.abs().maxCoeff()).count();
  if (number == 0) return;
  auto what = std::to_string(number) + (number == 1 ? " mode has" : " modes have") +
              " negative stiffness: the model is not in stable equilibrium";
  what += describe_first_negative(model);
  diagnostics.warning("modal.unstable", {}, what,
                      "correct the sign of its springs and loads, unless that is what you look for");
}

}  // namespace

EigenPairs calc_normal_modes(const fe::Model& model, const EigenOptions& options, Diagnostics& diagnostics) {
  check_request(model, options);
  return calc_normal_modes(fe::System(model), options, diagnostics);
}

EigenPairs calc_normal_modes(const fe::System& system, const EigenOptions& options, Diagnostics& diagnostics) {
  check_request(system.model, options);
  detail::initialize_slepc();
  auto answer = find_answer(system, options);
  if (answer.pairs.Phi.cols() > detail::kColumnsAtOnce) linear::release_freed_memory();
  const auto restored = find_soft(system, options, answer.pairs);
  for (const auto& item : answer.diagnostics.items())
    if (!restored.is_done || item.id != "modal.roundoff") diagnostics.add(item);
  detail::warn_of_lost_digits(restored, diagnostics);
  linear::check_residuals(answer.pairs.residual, "mode", diagnostics);
  warn_of_negative(system.model, answer.pairs, diagnostics);
  return std::move(answer.pairs);
}

}  // namespace bough::modal
