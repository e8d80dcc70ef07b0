#pragma once
/// \file A [[force]] that follows a signal.
#include <memory>

#include "solver/forces/applied.hpp"
#include "solver/signals/block.hpp"

namespace bough::solver {

/// A [[force]] whose value is a signal. `force` outlives it.
std::unique_ptr<Block> make_driven_force(const AppliedForce& force, const SourceLocation& at);

}  // namespace bough::solver
