#pragma once
/// \file Eigensolvers of Bough as EPS types of SLEPc: "bough-block-lanczos" and "bough-low-rank".
///
/// Internal to modal. Both ask for an ST "bough-factor" (factored_transform.hpp), whose operator they apply to blocks
/// of vectors. EPS keeps the data for which it has a place (number, tolerance, target, monitors, eigenvalues, the
/// reason of the end); the functions below set the others.
#include <slepceps.h>

#include <Eigen/SparseCore>

#include "modal/factored_transform.hpp"

namespace bough::modal::detail {

using Eigen::MatrixXd;

inline constexpr const char* kBlockLanczos = "bough-block-lanczos";
inline constexpr const char* kLowRank = "bough-low-rank";

/// Registers both; again is harmless.
void register_eps_types();

/// Returns true if the type of `eps` is one of these two.
bool is_own_type(EPS eps);

struct BlockLanczosSettings {
  MatrixXd start;                 ///< as wide as the blocks
  MatrixXd deflation;             ///< B-orthonormal eigenvectors that are known
  int num_guard = 0;              ///< of the wanted ones, the last: may be rough
  int max_subspace = 0;           ///< vectors before a restart
  bool positive_only = false;     ///< θ > 0 from the largest down, else by magnitude
  std::function<void()> release;  ///< called before the first block: A is needed no more
};
/// Sets what block Lanczos takes beyond the options of EPS; before EPSSolve. \pre The type is kBlockLanczos.
void set_settings(EPS eps, BlockLanczosSettings settings);

struct LowRankSettings {
  linear::SymmetricMatrix K, B;                    ///< of the problem; K without springs that only `deflation` moves
  const Eigen::SparseMatrix<double>* C = nullptr;  ///< B = C Cᵀ; outlives the solution
  MatrixXd deflation;                              ///< B-orthonormal eigenvectors that are known
  bool projects_deflation = false;                 ///< out of every solution (LowRankProblem)
};
/// Sets what the low-rank solver takes beyond the options of EPS; before EPSSolve. \pre The type is kLowRank.
void set_settings(EPS eps, LowRankSettings settings);

/// Moves the eigenvectors out, in the order of EPS' own array of eigenvalues (raw order): no copy of the largest thing
/// in memory, as EPSGetEigenvector would make.
MatrixXd take_vectors(EPS eps, Eigen::VectorXd& values);

/// Exception that a callback threw within SLEPc; null: nothing.
std::exception_ptr get_failure(EPS eps);

}  // namespace bough::modal::detail
