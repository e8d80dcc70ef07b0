#pragma once
/// \file The parts of a large matrix that are worked on at the same time.
#include <optional>
#include <vector>

#include "base/diagnostic.hpp"
#include "fe/linear/ordering.hpp"
#include "fe/linear/threads.hpp"

namespace bough::linear {

/// The rows of a matrix on one process, both triangles.
struct MatrixRows {
  const PetscInt *start = nullptr, *column = nullptr;
  const PetscScalar* value = nullptr;
};

/// use(rows, size) with the rows of A.
template <class Use>
void visit_rows(Mat A, const Use& use) {
  PetscInt size = 0;
  PetscBool done = PETSC_FALSE;
  MatrixRows rows;
  check_petsc(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &size, &rows.start, &rows.column, &done));
  check_petsc(MatSeqAIJGetArrayRead(A, &rows.value));
  if (done) use(rows, size);
  check_petsc(MatSeqAIJRestoreArrayRead(A, &rows.value));
  check_petsc(MatRestoreRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &size, &rows.start, &rows.column, &done));
}

/// A postorder of the elimination tree of the rows and columns `rows`, in this order, of a symmetric matrix whose
/// pattern is that of all `matrices` together (Liu, SIAM J. Matrix Anal. Appl. 11 (1990) 134); `size`: of the matrix.
std::vector<int> calc_postorder(const std::vector<const MatrixRows*>& matrices, PetscInt size,
                                const std::vector<PetscInt>& rows);

/// Partitions A into one or two subdomains: one if there is one thread, or if two would be unbalanced or have a large
/// separator. Empty if A has no row groups or less than `least` rows.
std::optional<TwoParts> find_parts(const SymmetricMatrix& A, PetscInt min_rows);

/// work(p) of all parts, one or two, at once.
template <class Work>
void do_all(std::size_t num_parts, const Work& work) {
  if (num_parts > 1)
    do_both([&] { work(0); }, [&] { work(1); });
  else
    do_alone([&] { work(0); });
}

}  // namespace bough::linear
