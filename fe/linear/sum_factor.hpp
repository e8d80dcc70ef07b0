#pragma once
/// \file Solutions with A_0 + U W Uᵀ by a factor of A_0, as a PETSc matrix that stands for the factor of the sum.
#include "fe/linear/low_rank_sum.hpp"

namespace bough::fe {

/// A⁻¹ = A_0⁻¹ - Y S⁻¹ Yᵀ, Y = A_0⁻¹U, S = W⁻¹ + UᵀY (Sherman, Morrison & Woodbury; Hager, SIAM Rev. 31 (1989) 221).
/// `factor` of A_0; costs k solutions and n x k numbers, k the rank.
PetscMat make_sum_factor(PetscMat factor, const LowRankPart& part);

/// Negative eigenvalues of A less those of A_0: (A_0 U; Uᵀ -W⁻¹) has the inertia of A_0 and -S together, and that of
/// -W⁻¹ and A (Haynsworth, Linear Algebra Appl. 1 (1968) 73). Zero for a factor of a sparse matrix.
int count_extra_negative(Mat factor);

bool is_sum_factor(Mat factor);
/// X with A X = B where `factor` stands for a sum; false, and nothing done, where it is PETSc's own.
bool solve_sum(Mat factor, const Eigen::Ref<const Eigen::MatrixXd>& B, Eigen::MatrixXd& X);

}  // namespace bough::fe
