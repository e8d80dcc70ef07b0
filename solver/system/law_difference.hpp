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
/// \return Difference::kink holds the effect of functions with two slopes at f(0).
/// \throws as solver::differentiate.
Difference differentiate_system(SystemData& data, LawTangents& tangents, const std::function<VectorXd(double)>& f,
                                double step, std::vector<LawKink>* kinks = nullptr);

/// Returns displacements that are large but not absurd, by row of u: 0.1 rad, 5 % of the size of the bodies, of a mode
/// what deflects or rotates its body by as much.
VectorXd calc_displacement_steps(const Tree& tree);

}  // namespace bough::solver
