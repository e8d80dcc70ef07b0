#pragma once
/// \file SLEPc behind two calls: some eigenpairs of a symmetric pencil, and the inertia of a shifted pencil.
///
/// Internal to modal. Vectors go in and out as find_own_rows(A) has them (linear/own_rows.hpp): by parts, or whole on
/// every rank; the matrices are distributed, and the vectors of Lanczos by blocks too.
#include <functional>

#include <Eigen/Dense>

#include "fe/linear/petsc.hpp"

namespace bough::modal::detail {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Initializes PETSc and SLEPc once per process; SLEPc is finalized at exit before PETSc.
void initialize_slepc();

enum class Spectrum {
  NearShift,         ///< A x = λ B x nearest `shift` by shift-invert; A - shift B is factored
  LargestMagnitude,  ///< A x = θ B x of largest |θ|; B, positive definite, is factored
  LargestPositive    ///< the same, θ > 0 only
};

enum class KrylovMethod {
  Fastest,  ///< by blocks near a shift, where the factor is definite and larger than a cache; of several processes each
            ///< on its part of the rows (linear/subdomains.hpp) where they are cut
  Blocks,
  OneVector  ///< SLEPc's Krylov-Schur
};

struct KrylovProblem {
  Mat A = nullptr, B = nullptr;
  Spectrum spectrum = Spectrum::NearShift;
  double shift = 0;
  int num_wanted = 1;
  int num_guard = 0;     ///< of num_wanted: the last ones, to show the gap; rough unless close to the others
  int max_subspace = 0;  ///< rank of the operator, 0: the size of A
  MatrixXd deflate;      ///< own rows x k known eigenvectors, kept out; k may be 0
  double tolerance = 1e-12;
  Mat factor = nullptr;        ///< of A - shift B or of B, whichever is factored; nullptr: made here
  bool definite_only = false;  ///< an indefinite matrix to factor counts as singular
  int start = 0;               ///< picks one of the fixed start vectors
  int block = 0;               ///< columns of the blocks, as many as a root has copies; 0: what is fastest
  KrylovMethod method = KrylovMethod::Fastest;
  std::function<void(int converged, int wanted)> progress;
  /// Where vectors are whole: from `release` on A is not needed any more, `restore` asks for it back. The caller brings
  /// it back in the end, when the factor's memory is free again.
  std::function<void()> release, restore;
};

struct KrylovResult {
  VectorXd values;           ///< converged ones, in SLEPc's order; may be fewer or more than wanted
  MatrixXd vectors;          ///< own rows x values.size()
  bool is_singular = false;  ///< the matrix to factor is singular: nothing was solved
};

/// Krylov-Schur with a B inner product (Stewart, SIAM J. Matrix Anal. Appl. 23 (2001) 601; SLEPc) or Lanczos by blocks
/// (block_lanczos.hpp), purified for a semi-definite B. Where SLEPc gives up (a B of lower rank than its subspace) the
/// blocks take over. Throws ComputationError("modal.no-convergence").
KrylovResult solve_krylov(const KrylovProblem& problem);

/// A + factor B, for factorization.
fe::PetscMat add(Mat A, double factor, Mat B);

/// Negative eigenvalues of A + factor B by an LDLᵀ factorization (Sylvester): for a positive semi-definite B and
/// factor = -μ the number of eigenvalues of A x = λ B x below μ. -1 when the factorization met a zero pivot.
int count_negative(Mat A, double factor, Mat B);

/// A number in (-1, 1) that depends on index and start only: start vectors and weights free of any rank layout.
double calc_fixed_number(int index, int start);

}  // namespace bough::modal::detail
