#pragma once
/// \file Factors of a symmetric matrix by CHOLMOD or MUMPS, with many right-hand sides at once.
#include <memory>
#include <optional>

#include "fe/linear/factor_solver.hpp"
#include "fe/linear/products.hpp"

namespace bough::linear {

enum class FactorMethod {
  Fastest,  ///< LLᵀ by CHOLMOD on one process, MUMPS where A is not positive definite and on several
  Pivoting  ///< LDLᵀ by MUMPS: counts null pivots
};

class SymmetricFactor {
 public:
  /// Factors A (symmetric; both triangles stored), or its sparse part where it has one of low rank. With
  /// `find_null_pivots`, pivots below 1e-15 of the scaled matrix are set aside and counted by MUMPS (ICNTL(24)) instead
  /// of failing; LLᵀ counts none: a singular matrix whose roundoff is positive passes. Throws ComputationError
  /// "fe.out-of-memory" and "fe.factorization".
  SymmetricFactor(const SymmetricMatrix& A, bool find_null_pivots, FactorMethod method = FactorMethod::Fastest);
  /// LLᵀ of A; empty where A is not positive definite, or on several processes.
  static std::optional<SymmetricFactor> try_definite(const SymmetricMatrix& A);

  bool is_singular() const { return is_singular_; }  ///< an exact zero pivot ended the factorization
  bool is_definite() const { return is_definite_; }  ///< LLᵀ: every pivot was above zero, in roundoff
  /// Number of pivots that MUMPS set aside as zero; 0 unless `find_null_pivots` was set.
  int num_null_pivots() const { return num_null_pivots_; }
  /// Library and method: "LLᵀ CHOLMOD", "LDLᵀ MUMPS".
  const char* name() const { return solver_->name(); }
  double num_entries() const { return solver_->num_entries(); }  ///< of the factor, on this rank
  /// X with A X = B; B num_rows x m, replicated on every rank, and so is X.
  Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& B) const { return solver_->solve(B); }
  /// Solves for a vector in PETSc's distribution.
  void solve_vector(Vec b, Vec x) const { solver_->solve_vector(b, x); }

 private:
  SymmetricFactor() = default;

  FactorSolverHandle solver_;
  bool is_singular_ = false, is_definite_ = false;
  int num_null_pivots_ = 0;
};

}  // namespace bough::linear
