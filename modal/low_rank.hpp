#pragma once
/// \file A mass matrix of low rank: its factor, and the eigenvalues of the small matrix that it leaves.
#include <optional>

#include <Eigen/SparseCore>

#include "fe/linear/symmetric_matrix.hpp"
#include "modal/factored_transform.hpp"
#include "modal/roots.hpp"

namespace bough::modal::detail {

/// C, n x r, with M = C Cᵀ where the rank r of M (positive semi-definite, its diagonal given) is max_rank at most;
/// nothing if it is higher or M is indefinite. Cholesky of the matrix scaled to a unit diagonal, pivots from the
/// largest decade down; what is left below 3e-12 is roundoff of masses that dependent dofs shared out (Higham, Accuracy
/// and Stability of Numerical Algorithms, 2nd ed., 10.3). Touches no more than max_rank columns.
std::optional<Eigen::SparseMatrix<double>> factor_low_rank(const linear::SymmetricMatrix& M,
                                                           const Eigen::VectorXd& diagonal, int max_rank);

/// K x = λ C Cᵀ x, with vectors that are whole on every rank.
struct LowRankProblem {
  linear::SymmetricMatrix K, M;
  const Eigen::SparseMatrix<double>* C = nullptr;
  BlockApply solve;             ///< (A - σM)⁻¹X, A = K but for springs that `known` alone moves
  double shift = 0;             ///< σ
  MatrixXd known;               ///< M-orthonormal eigenvectors, kept out
  bool projects_known = false;  ///< A has such springs: the components along `known` are projected out of each solution
  int num_wanted = 1;
};

/// The lowest num_wanted eigenvalues, or as many as exist: those of Cᵀ(A - σM)⁻¹C y = θ y, x = (A - σM)⁻¹C y / θ,
/// λ = σ + 1/θ. SLEPc runs it as the EPS type "bough-low-rank" (eps_types.hpp).
Roots solve_low_rank(const LowRankProblem& problem);

}  // namespace bough::modal::detail
