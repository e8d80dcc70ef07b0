#pragma once
/// \file LLᵀ of large matrices by CHOLMOD, solved with from memory, in two parts where there are two threads.
#include "fe/linear/petsc.hpp"

namespace bough::fe {

/// Smaller matrices gain nothing.
constexpr PetscInt kLeastSupernodalRows = 20000;

struct SupernodalFactor {
  PetscMat factor;          ///< stands for the factor in solve_factored(); empty where another one is to be made
  bool is_definite = true;  ///< false: A is not positive definite, however it is factored
  int num_parts = 0;
};

/// LLᵀ of A in the order of its dissection. With two threads by its first dissection: the rows of two parts 1, 2 that
/// do not couple, and s between them. The parts are factored at the same time, each with D_p = K_ss / 2 + δ in the
/// place of K_ss, whose trailing block gives L_ss L_ssᵀ = D_p - K_sp K_pp⁻¹ K_ps; their sum less 2δ is the Schur
/// complement of s, factored as a dense matrix (substructures: Przemieniecki, AIAA J. 1 (1963) 138). δ
/// (calc_separator_shift) makes D_p definite whatever the other part carries. Empty: several processes, matrices that
/// are small or have no groups of rows. One part where many rows lie between. Deterministic, but the last digits are
/// those of the parts.
SupernodalFactor make_supernodal_factor(Mat A, PetscInt least = kLeastSupernodalRows);

/// X with A X = B where `factor` is supernodal; false, and nothing done, where it is another one.
bool solve_supernodal(Mat factor, const Eigen::Ref<const Eigen::MatrixXd>& B, Eigen::MatrixXd& X);
bool is_supernodal_factor(Mat factor);

}  // namespace bough::fe
