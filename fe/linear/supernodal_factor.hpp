#pragma once
/// \file LLᵀ of large matrices by CHOLMOD, packed, in two parts where there are two threads.
///
/// Internal to linear.
#include "fe/linear/factor_solver.hpp"
#include "fe/linear/symmetric_matrix.hpp"

namespace bough::linear {

/// Smaller matrices gain nothing.
constexpr PetscInt kMinSupernodalRows = 20000;

struct SupernodalFactor {
  FactorSolverHandle solver;  ///< null if another type of factor is required
  bool is_definite = true;    ///< false: A is not positive definite, however it is factored
  int num_parts = 0;
};

/// LLᵀ of A in the order of its dissection. With two threads by its first dissection: the rows of two parts 1, 2 that
/// do not couple, and s between them. The parts are factored at the same time, each with D_p = K_ss / 2 + δ in the
/// place of K_ss, whose trailing block gives L_ss L_ssᵀ = D_p - K_sp K_pp⁻¹ K_ps; their sum less 2δ is the Schur
/// complement of s, factored as a dense matrix (substructures: Przemieniecki, AIAA J. 1 (1963) 138). δ
/// (calc_separator_shift) makes D_p definite whatever the other part carries. Empty: several processes, matrices that
/// are small or have no groups of rows. One part where many rows lie between. Deterministic, but the last digits are
/// those of the parts.
SupernodalFactor make_supernodal_factor(const SymmetricMatrix& A, PetscInt min_rows = kMinSupernodalRows);

}  // namespace bough::linear
