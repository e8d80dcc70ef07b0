#pragma once
/// \file Derivatives of functions that evaluate a system, by differences with tangents in place of its functions; their
/// steps.
#include <functional>
#include <vector>

#include "solver/state/difference.hpp"
#include "solver/state/law_tangents.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {

/// Computes f'(0) of a function that evaluates the system of `data`.
///
/// Laws are their tangents at f(0) (solver/state/law_tangents.hpp), so that `step` need suit the geometry only.
///
/// \param tangents  scratch.
/// \param kinks  gains the functions with two slopes that have an effect; nullptr: not requested.
/// \param has_large_terms  f is a small difference of its terms (lies_far()) or of the positions of closed loops: its
///     round-off is measured, by eight evaluations more.
/// \return Difference::kink holds the effect of functions with two slopes at f(0).
/// \throws as solver::differentiate.
Difference differentiate_system(SystemData& data, LawTangents& tangents, const std::function<VectorXd(double)>& f,
                                double step, bool has_large_terms, std::vector<LawKink>* kinks = nullptr);

/// Returns displacements that are large but not absurd, by row of u: 0.1 rad; 5 % of the size of the largest body that
/// a translation moves; of a mode, the amplitude that deflects its body by as much of its size, or rotates a node by
/// 0.05 rad. The size of a body is the extent of its mass and nodes: origins of frames and places of hinges have no
/// effect, except where no body that moves has an extent.
VectorXd calc_displacement_steps(const Tree& tree);

/// [L] Shortest first displacement of a difference by a translation: roundoff of positions, 1e-16 of the largest
/// distance of a body's origin from the inertial one, is 1e-10 of it. After the positions of `data`.
double calc_far_step(const TreeData& data);

/// Returns true if a body is more than 1,000 sizes of the largest one from the inertial origin, as in orbit:
/// accelerations next to an equilibrium are then small differences of their terms. After the positions of `data`.
bool lies_far(const Tree& tree, const TreeData& data);

}  // namespace bough::solver
