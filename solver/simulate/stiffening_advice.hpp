#pragma once
/// \file Loads and spins that would stiffen or buckle a flexible body whose stiffening is off.
#include <set>

#include "base/diagnostic.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {

/// Share of its critical loads that a body without stiffening may carry: there a bending frequency is off by 30 %.
inline constexpr double kLoadLimit = 0.5;

/// Warns "run.unstiffened-load" of each body with `stiffening = false` whose loads exceed kLoadLimit of the critical
/// ones: K + λ K_G singular at λ < 1/kLoadLimit, K_G of all inertial, hinge, constraint and node loads and load
/// patterns (docs/theory/when-stiffening-matters.md). Loads are those in the state at the start, with forces of time at
/// the start and at their extreme values between start and end, prescribed motions likewise where no loop is closed.
/// Warns "run.unstiffened-spin" at the same times as ModalRangeMonitor does. Allocates.
/// \return the bodies whose spin was reported
std::set<int> warn_of_unstiffened_bodies(const System& system, double start, double end, const SourceLocation& at,
                                         Diagnostics& diagnostics);

}  // namespace bough::solver
