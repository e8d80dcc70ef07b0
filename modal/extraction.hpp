#pragma once
/// \file Some eigenpairs of a symmetric pencil by one EPS of SLEPc, and which type of EPS that is.
///
/// Internal to modal. Normal modes, buckling, fixed-interface modes and windows of a range all come here. Vectors go in
/// and out whole, alike on every rank; the matrices are distributed.
#include <functional>
#include <memory>
#include <string>

#include <Eigen/Dense>
#include <Eigen/SparseCore>

#include "fe/linear/factor.hpp"
#include "fe/linear/row_kinds.hpp"
#include "modal/solver_use.hpp"

namespace bough::modal::detail {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Initializes PETSc and SLEPc once per process, with the types of Bough; SLEPc is finalized at exit before PETSc.
void initialize_slepc();

enum class Spectrum {
  NearShift,         ///< A x = λ B x nearest `shift` by shift-invert; A - shift B is factored
  LargestMagnitude,  ///< A x = θ B x of largest |θ|; B, positive definite, is factored
  LargestPositive    ///< the same, θ > 0 only
};

/// The factored matrix of an EigenProblem, and what applies its factor.
struct Factored;
using FactoredHandle = std::shared_ptr<Factored>;

struct EigenProblem {
  linear::SymmetricMatrix A, B;
  Spectrum spectrum = Spectrum::NearShift;
  double shift = 0;
  int num_wanted = 1;
  int num_guard = 0;     ///< of num_wanted: the last ones, to show the gap; rough unless close to the others
  int max_subspace = 0;  ///< rank of the operator, 0: the size of A
  MatrixXd deflate;      ///< n x k known eigenvectors, kept out; k may be 0
  double tolerance = 1e-12;
  const linear::SymmetricFactor* factor = nullptr;  ///< of A - shift B or of B, whichever is factored; null: made here
  FactoredHandle* kept = nullptr;                   ///< receives the factor for the next call; null: not requested
  bool definite_only = false;                       ///< an indefinite matrix to factor counts as singular
  double min_energy = 0;        ///< below this relative energy of its softest motion it does too (calc_softest_energy)
  linear::RowKinds kinds = {};  ///< of the rows, where min_energy is set
  int start = 0;                ///< picks one of the fixed start vectors
  int block = 0;                ///< columns of the blocks, as many as a root has copies; 0: what is fastest
  std::string solver = {};      ///< EPS type that overrules choose_solver(); empty: none does
  const Eigen::SparseMatrix<double>* low_rank = nullptr;  ///< C of B = C Cᵀ where B has a low rank
  linear::SymmetricMatrix stiffness;  ///< with `low_rank`: A without the springs that only `deflate` moves
  bool projects_deflate = false;      ///< with `low_rank`: A has such springs
  std::function<void(int converged, int requested)> progress = {};
  /// From `release` on A is not needed any more, `restore` asks for it back. The caller brings
  /// it back in the end, when the factor's memory is free again.
  std::function<void()> release = {}, restore = {};
};

struct Extraction {
  VectorXd values;           ///< converged ones, in the EPS' order; may be fewer or more than wanted
  MatrixXd vectors;          ///< n x values.size()
  bool is_singular = false;  ///< the matrix to factor is singular: nothing was solved
  SolverUse by;              ///< read back from the EPS
};

/// Properties by which choose_solver() decides.
struct SolverFacts {
  bool has_low_rank = false;     ///< B = C Cᵀ with few columns is at hand
  bool is_near_shift = true;     ///< else the largest θ (buckling)
  bool is_definite = true;       ///< the factored matrix has LLᵀ: on one process alone
  PetscInt num_rows = 0;         ///< of A
  int num_wanted = 0, room = 0;  ///< eigenvalues, of as many as there may be
  bool has_many_copies = false;  ///< `block` is set
};

/// The EPS type of a problem, and the only place that chooses it:
///
/// | the problem                                                                        | EPS type            |
/// | ---------------------------------------------------------------------------------- | ------------------- |
/// | M has a low rank: at most 3 n + 100 for n modes wanted, and 4,000                  | bough-low-rank      |
/// | near a shift, A - σB definite, from 5,000 rows on, less than a quarter of all roots | bough-block-lanczos |
/// | the same below 5,000 rows, copies of a root that were missed                       | bough-block-lanczos |
/// | everything else: few rows, many modes, buckling, a shift inside the spectrum       | krylovschur         |
///
/// On several processes MUMPS factors, by LDLᵀ.
std::string choose_solver(const SolverFacts& facts);

/// Sets up one EPS, solves, and purifies for a semi-definite B. Where the chosen type gives up (a subspace beyond the
/// rank of B, no convergence) the other one of krylovschur and bough-block-lanczos takes over; after `solver` none
/// does. Throws ComputationError "modal.no-convergence", and "modal.unsuited-solver" for a `solver` that SLEPc refuses.
Extraction extract(const EigenProblem& problem);

}  // namespace bough::modal::detail
