#pragma once
/// \file Lanczos by blocks: the eigenvalues of a definite pencil nearest zero, with a solve of several right-hand sides
/// at a time.
///
/// Internal to modal: SLEPc runs it as the EPS type "bough-block-lanczos" (eps_types.hpp). Where a sparse factor does
/// not fit the cache a solve costs what reading the factor costs: four right-hand sides 41 ms, eight 58 ms
/// (docs/verification/speed.md). SLEPc's Krylov-Schur solves for one at a time.
#include <functional>

#include <Eigen/Dense>

namespace bough::modal::detail {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct BlockLanczosProblem {
  /// Y = A⁻¹X, n x b to n x b; A symmetric.
  std::function<MatrixXd(const Eigen::Ref<const MatrixXd>&)> solve;
  std::function<MatrixXd(const Eigen::Ref<const MatrixXd>&)> multiply_mass;  ///< B X, B positive semi-definite
  /// C X where the operator is A⁻¹C, C symmetric and B = A (load factors); without it the operator is A⁻¹B.
  std::function<MatrixXd(const Eigen::Ref<const MatrixXd>&)> multiply_operator;
  MatrixXd start;    ///< n x b: fixes the block's width
  MatrixXd deflate;  ///< n x k, B-orthonormal eigenvectors that are known already
  int num_wanted = 1;
  int num_guard = 0;     ///< of num_wanted: the last ones need be rough only, unless their θ is close to the others
  int max_subspace = 0;  ///< vectors kept before a restart, at least num_wanted + 2 b; 0: 2 num_wanted + 8 b
  double tolerance = 1e-12;
  bool positive_only = false;  ///< θ > 0 from the largest down; else by magnitude
  int max_restarts = 100;
  /// Called with the Ritz values θ of the present basis, their relative residuals, and how many lead that converged.
  std::function<void(int converged, const VectorXd& theta, const VectorXd& error)> monitor;
};

struct BlockLanczosResult {
  VectorXd theta;      ///< largest eigenvalues of A⁻¹B, descending by magnitude: 1/λ
  MatrixXd X;          ///< n x theta.size(), B-orthonormal
  int num_solves = 0;  ///< calls of `solve`
  int num_converged = 0;
  bool is_done = false;  ///< all wanted ones converged, or the whole space was spanned
};

/// Block Lanczos with full orthogonalization in the B inner product and thick restart (Golub & Underwood 1977; Grimes,
/// Lewis & Simon, SIAM J. Matrix Anal. Appl. 15 (1994) 228; Wu & Simon, ibid. 22 (2000) 602). A Ritz pair counts as
/// converged when its residual ‖A⁻¹B x - θx‖_B is below tolerance θ, or below the roundoff of the largest θ where that
/// is no more than a thousand times as much. Costs O(n m²) in addition to the solves, m the subspace.
BlockLanczosResult solve_block_lanczos(BlockLanczosProblem problem);

}  // namespace bough::modal::detail
