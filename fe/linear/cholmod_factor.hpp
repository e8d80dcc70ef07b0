#pragma once
/// \file LLᵀ of a sparse symmetric matrix on one process by CHOLMOD.
///
/// Internal to linear.
#include <string>

#include "base/diagnostic.hpp"
#include "fe/linear/factor_solver.hpp"
#include "fe/linear/symmetric_matrix.hpp"

namespace bough::linear {

/// "fe.out-of-memory" of a factor; `what` says why, empty: it does not fit.
ComputationError make_out_of_memory(const std::string& what = "");

/// Throws "fe.out-of-memory" where CHOLMOD's status says that memory or its 32-bit indices do not suffice.
void check_cholmod(int status);

/// LLᵀ of A (MATSEQAIJ); null where A is not positive definite. Throws as check_cholmod(), and before the work where
/// the factor needs more memory than there is.
FactorSolverHandle factor_by_cholmod(const SymmetricMatrix& A);

}  // namespace bough::linear
