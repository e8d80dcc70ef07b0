/// \file The inertia of a symmetric sum: dense for few rows, front by front for many, or by MUMPS.
// First: the BLAS header needs PETSc's own names.
#include <petscsys.h>

#include <petscblaslapack.h>

#include "fe/linear/inertia.hpp"

#include <utility>
#include <vector>

#include "fe/linear/dissection.hpp"
#include "fe/linear/fronts.hpp"
#include "fe/linear/memory_need.hpp"
#include "fe/linear/mumps.hpp"
#include "fe/linear/sum_factor.hpp"

namespace bough::linear {
namespace {

using Eigen::MatrixXd;

/// MUMPS takes longer than this to set up for fewer rows.
constexpr PetscInt kDenseMaxRows = 160;

/// Negative eigenvalues of A + factor B by LDLᵀ with pivots of one or two rows wherever they are (Bunch & Kaufman), -1
/// where one is zero; empty if the matrices are of another kind or have more rows.
std::optional<int> count_dense(const SymmetricMatrix& A, double factor, const SymmetricMatrix& B) {
  if (initialize_petsc().size > 1 || A.low_rank() || B.low_rank()) return std::nullopt;
  const PetscInt size = A.num_rows();
  if (size < 1 || size > kDenseMaxRows) return std::nullopt;
  MatrixXd S = MatrixXd::Zero(size, size);  // lower triangle
  for (const auto& [matrix, scale] : {std::pair(A.sparse(), 1.0), std::pair(B.sparse(), factor)}) {
    PetscBool is_by_rows = PETSC_FALSE;
    check_petsc(PetscObjectBaseTypeCompare(reinterpret_cast<PetscObject>(matrix), MATSEQAIJ, &is_by_rows));
    if (!is_by_rows) return std::nullopt;
    visit_rows(matrix, [&, scale = scale](const MatrixRows& rows, PetscInt) {
      for (PetscInt r = 0; r < size; ++r)
        for (PetscInt k = rows.start[r]; k < rows.start[r + 1]; ++k)
          if (rows.column[k] <= r) S(r, rows.column[k]) += scale * rows.value[k];
    });
  }
  const auto n = static_cast<PetscBLASInt>(size);
  std::vector<PetscBLASInt> order(static_cast<std::size_t>(n));
  std::vector<double> work(static_cast<std::size_t>(64 * n));
  PetscBLASInt work_size = 64 * n, info = 0;
  LAPACKsytrf_("L", &n, S.data(), &n, order.data(), work.data(), &work_size, &info);
  if (info != 0) return -1;  // a pivot is zero
  int negative = 0;
  for (PetscBLASInt j = 0; j < n; ++j) {
    const bool is_pair = order[static_cast<std::size_t>(j)] < 0;  // of one positive and one negative value
    if (is_pair || S(j, j) < 0) ++negative;
    if (is_pair) ++j;
  }
  return negative;
}

}  // namespace

std::optional<int> count_negative_eigenvalues(const SymmetricMatrix& A, double factor, const SymmetricMatrix& B) {
  release_freed_memory();  // of what was solved before
  if (const auto count = count_dense(A, factor, B)) return *count < 0 ? std::nullopt : count;
  if (const auto count = count_negative_by_fronts(A, factor, B)) return count;
  const SymmetricMatrix sum = add(A, factor, B);
  const LowRankPart* part = sum.low_rank();
  MumpsFactor found = factor_by_mumps(sum.sparse(), {.counts_negative = true, .keeps_factor = part != nullptr});
  if (found.state != FactorState::Done) return std::nullopt;
  const int extra = part ? SumSolver(std::move(found.solver), *part).num_extra_negative() : 0;
  return found.num_negative + extra;
}

std::optional<int> count_negative_eigenvalues(const SymmetricMatrix& A) { return count_negative_eigenvalues(A, 0, A); }

std::optional<int> count_eigenvalues_below(const SymmetricMatrix& A, const SymmetricMatrix& B, double mu) {
  return count_negative_eigenvalues(A, -mu, B);
}

}  // namespace bough::linear
