#pragma once
/// \file The entries of the rows that this rank has of a matrix on all of them.
///
/// Internal to linear.
#include <algorithm>

#include "base/diagnostic.hpp"
#include "fe/linear/petsc.hpp"

namespace bough::fe {

/// Where PETSc keeps them, nothing is copied: MatGetRow() joins two pieces of each row.
class OwnEntries {
 public:
  /// A: of several processes, MATMPIAIJ.
  explicit OwnEntries(Mat A) {
    PetscBool is_fine = PETSC_FALSE;
    check_petsc(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(A), MATMPIAIJ, &is_fine));
    BOUGH_DEMAND(is_fine);
    Mat own = nullptr, others = nullptr;
    check_petsc(MatGetOwnershipRange(A, &first_, &last_));
    check_petsc(MatMPIAIJGetSeqAIJ(A, &own, &others, &other_column_));
    own_.open(own);
    others_.open(others);
  }
  OwnEntries(const OwnEntries&) = delete;
  OwnEntries& operator=(const OwnEntries&) = delete;
  ~OwnEntries() {
    own_.close();
    others_.close();
  }

  PetscInt first() const { return first_; }
  PetscInt last() const { return last_; }
  PetscInt num_entries() const { return own_.start[last_ - first_] + others_.start[last_ - first_]; }
  PetscInt num_entries_of_others() const { return others_.start[last_ - first_]; }  ///< columns that others have
  /// use(column, value) for the entries of a row: those with columns among the own rows, then the others.
  template <class Use>
  void visit(PetscInt row, const Use& use) const {
    const PetscInt i = row - first_;
    for (PetscInt k = own_.start[i]; k < own_.start[i + 1]; ++k) use(first_ + own_.column[k], own_.value[k]);
    for (PetscInt k = others_.start[i]; k < others_.start[i + 1]; ++k)
      use(other_column_[others_.column[k]], others_.value[k]);
  }
  bool has_same_columns(PetscInt row, PetscInt other) const {
    return own_.has_same_columns(row - first_, other - first_) &&
           others_.has_same_columns(row - first_, other - first_);
  }

 private:
  struct Block {
    Mat A = nullptr;
    PetscInt num_rows = 0;
    const PetscInt *start = nullptr, *column = nullptr;
    const PetscScalar* value = nullptr;

    void open(Mat block) {
      A = block;
      PetscBool done = PETSC_FALSE;
      check_petsc(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &num_rows, &start, &column, &done));
      BOUGH_DEMAND(done);
      check_petsc(MatSeqAIJGetArrayRead(A, &value));
    }
    void close() {
      PetscBool done = PETSC_FALSE;
      MatSeqAIJRestoreArrayRead(A, &value);
      MatRestoreRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &num_rows, &start, &column, &done);
    }
    PetscInt count(PetscInt i) const { return start[i + 1] - start[i]; }
    bool has_same_columns(PetscInt i, PetscInt j) const {
      return count(i) == count(j) && std::equal(column + start[i], column + start[i + 1], column + start[j]);
    }
  };

  PetscInt first_ = 0, last_ = 0;
  Block own_, others_;
  const PetscInt* other_column_ = nullptr;
};

}  // namespace bough::fe
