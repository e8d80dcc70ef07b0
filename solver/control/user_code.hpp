#pragma once
/// \file Blocks that have opened code of the user, and their end.
#include "solver/signals/block.hpp"

namespace bough::solver {

class SignalGraph;

/// A block that has opened something outside Bough, which the destructor closes at the latest.
class UserBlock : public Block {
 public:
  /// Closes it, once; nothing else may be called after it. Throws ComputationError "control.library-failed".
  virtual void close() const = 0;
  /// Returns true if it cannot continue from the discrete state of another run.
  virtual bool is_forward_only() const { return false; }
};

/// Returns true if the system has any UserBlock: code of others that may end the program.
bool has_user_blocks(const SignalGraph& signals);

/// Reports controllers that cannot go on from the memory of another run: call it before results are changed. Throws
/// InputError "control.cannot-resume".
void demand_resumable(const SignalGraph& signals);

/// Closes every UserBlock of the system, which can only be destroyed after it. A program that marks results as
/// completed calls it first. Throws ComputationError "control.library-failed".
void close_user_blocks(const SignalGraph& signals);

}  // namespace bough::solver
