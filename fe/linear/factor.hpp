#pragma once
/// \file Factors of a sparse symmetric PETSc matrix by CHOLMOD or MUMPS, with many dense right-hand sides at once.
#include <optional>

#include "fe/linear/petsc.hpp"

namespace bough::fe {

/// What a MUMPS factorization ended with (INFOG(1), INFOG(2)).
enum class FactorState { Done, Singular, NeedsWorkspace };
/// Throws ComputationError "fe.out-of-memory" or "fe.factorization" for an error that more workspace does not cure.
FactorState judge_factorization(int status, int detail);
/// What PETSc's code of a failed LLᵀ by CHOLMOD means: returns where the matrix is not positive definite; throws
/// ComputationError "fe.out-of-memory" where memory or CHOLMOD's 32-bit counts ran out, "fe.petsc" for the rest.
void judge_definite(PetscErrorCode code);

enum class FactorMethod {
  Fastest,  ///< LLᵀ by CHOLMOD on one process, MUMPS where A is not positive definite and on several
  Pivoting  ///< LDLᵀ by MUMPS: counts null pivots
};

class SymmetricFactor {
 public:
  /// Factors A (MATAIJ, symmetric; lower and upper part both stored). With `find_null_pivots`, pivots below 1e-15 of
  /// the scaled matrix are set aside and counted by MUMPS (ICNTL(24)) instead of failing; LLᵀ counts none: a singular
  /// matrix whose roundoff is positive passes.
  SymmetricFactor(Mat A, bool find_null_pivots, FactorMethod method = FactorMethod::Fastest);
  /// LLᵀ of A; empty where factor_definite() has none.
  static std::optional<SymmetricFactor> try_definite(Mat A);

  bool is_singular() const { return is_singular_; }  ///< an exact zero pivot ended the factorization
  bool is_definite() const { return is_definite_; }  ///< LLᵀ: every pivot was above zero, in roundoff
  int num_null_pivots() const { return num_null_pivots_; }
  Mat get() const { return factor_.get(); }  ///< the factor, for MatSolve
  /// X with A X = B; B num_rows x m, replicated on every rank, and so is X.
  Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& B) const;

 private:
  SymmetricFactor() = default;
  void factor_by_mumps(Mat A, bool find_null_pivots);

  PetscMat factor_;
  bool is_singular_ = false, is_definite_ = false;
  int num_null_pivots_ = 0;
};

/// LLᵀ by CHOLMOD of a positive definite A on one process; empty when A is not, or there are several.
PetscMat factor_definite(Mat A);

/// Whether MatSolve does not know the factor, but solve_factored alone.
bool is_own_factor(Mat factor);
/// X with A X = B from a factor of A that PETSc holds, or that stands for one.
Eigen::MatrixXd solve_factored(Mat factor, const Eigen::Ref<const Eigen::MatrixXd>& B);
/// A X of a distributed A and a replicated X, replicated.
Eigen::MatrixXd multiply(Mat A, const Eigen::Ref<const Eigen::MatrixXd>& X);
/// B - A X, every entry summed in extended precision before it is rounded; all replicated.
Eigen::MatrixXd calc_residual(Mat A, const Eigen::Ref<const Eigen::MatrixXd>& X,
                              const Eigen::Ref<const Eigen::MatrixXd>& B);
/// The diagonal of A, replicated.
Eigen::VectorXd get_diagonal(Mat A);

}  // namespace bough::fe
