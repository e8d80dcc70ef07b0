#pragma once
/// \file Eigenpairs of a quadratic pencil nearest a shift (docs/theory/complex-modes.md).
#include <functional>
#include <string>
#include <vector>

#include "modal/complex/quadratic_pencil.hpp"

namespace bough::modal::complex_modes {

struct SolverOptions {
  int num_modes = 0;            ///< wanted with Im λ > 0; 0: every eigenvalue
  std::vector<Complex> shifts;  ///< [1/T] candidates; the first at which the pencil is regular is used
  double scale = 1;             ///< [1/T] a typical |λ|
  double zero = 0;              ///< [1/T] eigenvalues of smaller magnitude are rigid-body modes, λ = 0
  int max_restarts = 200;
  Index max_dense = 350;  ///< unknowns up to which every eigenvalue is computed by a dense Schur form
};

/// Pairs of Q(λ) x = 0 with Im λ ≥ 0, ascending abs(Im λ), then descending Re λ.
struct ComplexPairs {
  VectorXcd lambda;
  MatrixXcd X;               ///< n x m
  MatrixXcd Y;               ///< n x m, Q(λ)ᵀ y = 0; the columns of X if the pencil is symmetric
  Eigen::VectorXd residual;  ///< norm of Q(λ) x over the sum of the norms of its three terms
  /// Largest abs(y_iᵀ ((λ_i + λ_j) M + B) x_j), i ≠ j, relative to the terms i = j; over unequal eigenvalues. Negative:
  /// not available.
  double biorthogonality = -1;
  Complex shift = 0;
  int num_iterations = 0;  ///< solutions with the factor
  double num_entries = 0;  ///< of the factor
  bool is_dense = false;   ///< every eigenvalue was computed
  int num_mirrored = 0;    ///< eigenvalues with Im λ < 0, left out
};

/// Throws ComputationError "modal.singular-pencil" if det Q(λ) vanishes at every shift, with the unknown that moves
/// most (described by `name_unknown`), and "modal.complex-convergence".
ComplexPairs solve_pencil(const QuadraticPencil& pencil, const SolverOptions& options,
                          const std::function<std::string(Index)>& name_unknown);

}  // namespace bough::modal::complex_modes
