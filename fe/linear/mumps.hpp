#pragma once
/// \file LDLᵀ of a sparse symmetric matrix by MUMPS, on any number of ranks.
///
/// Internal to linear.
#include "fe/linear/factor_solver.hpp"

namespace bough::linear {

/// State in which a MUMPS factorization ended (INFOG(1), INFOG(2)).
enum class FactorState { Done, Singular, NeedsWorkspace };
/// Throws ComputationError "fe.out-of-memory" or "fe.factorization" for an error that more workspace does not cure.
FactorState judge_factorization(int status, int detail);

struct MumpsOptions {
  bool finds_null_pivots = false;  ///< pivots below 1e-15 of the scaled matrix are set aside and counted (ICNTL(24))
  bool counts_negative = false;    ///< the number of negative pivots is asked for
  bool keeps_factor = true;
};

struct MumpsFactor {
  FactorState state = FactorState::NeedsWorkspace;  ///< NeedsWorkspace: ten times the estimate is not enough
  FactorSolverHandle solver;                        ///< where `state` is Done and the factor is kept
  int num_null_pivots = 0, num_negative = 0;
};

/// Factors A (MATAIJ, both triangles), with more workspace until pivoting has enough. Collective.
MumpsFactor factor_by_mumps(Mat A, const MumpsOptions& options);

}  // namespace bough::linear
