#pragma once
/// \file Symmetric matrices, sparse but for a part of low rank: A = A_0 + U W Uᵀ (docs/adr/0013-wide-constraints.md).
#include <memory>
#include <utility>
#include <vector>

#include "fe/linear/csr_matrix.hpp"
#include "fe/linear/low_rank_part.hpp"
#include "fe/linear/petsc.hpp"

namespace bough::linear {

/// Rows, each part in the order of its elimination: no row of `first` couples to one of `second`.
struct TwoParts {
  std::vector<PetscInt> first, second, between;
};

/// Known order in which the rows of a matrix are eliminated; null: unknown (ordering.hpp).
struct RowOrder {
  std::shared_ptr<const std::vector<int>> groups;  ///< run i of rows that couple alike is [groups[i], groups[i + 1])
  std::shared_ptr<const std::vector<PetscInt>> order;
  std::shared_ptr<const TwoParts> parts;
};

/// A symmetric matrix on all ranks of PETSC_COMM_WORLD. Copies share it: functions that change a matrix return another.
class SymmetricMatrix {
 public:
  /// No matrix.
  SymmetricMatrix() = default;
  /// A_0 (MATAIJ, both triangles) and U W Uᵀ.
  explicit SymmetricMatrix(PetscMat sparse, LowRankPart part = {});
  /// A_0 as every rank has it whole, both triangles. Collective.
  explicit SymmetricMatrix(const Eigen::SparseMatrix<double, Eigen::RowMajor>& A);
  /// A_0 on arrays of ours. On several ranks `rows` are those of this one, from row `first` on, of `size` on all.
  /// Collective.
  explicit SymmetricMatrix(Csr rows, int first, int size);

  /// Returns false for the default-constructed matrix, which has no rows.
  explicit operator bool() const { return sparse_ != nullptr; }
  /// Number of rows over all ranks. \pre The matrix is not empty.
  int num_rows() const;
  /// A_0 as PETSc has it; lives as long as this matrix or a copy of it.
  Mat sparse() const { return sparse_ ? sparse_->matrix.get() : nullptr; }
  SymmetricMatrix sparse_part() const;                             ///< A_0
  const LowRankPart* low_rank() const { return low_rank_.get(); }  ///< U W Uᵀ, or nullptr
  SymmetricMatrix with_low_rank(LowRankPart part) const;           ///< A_0 and another U W Uᵀ
  RowOrder& row_order() const { return sparse_->row_order; }       ///< of A_0; found once for all copies

  /// Returns the memory of the entries to the operating system; they must not be read until fill_entries(). False, and
  /// no effect, on several processes, with a part of low rank, and for a matrix that was not made from Csr rows.
  bool drop_entries() const;
  /// Restores the entries; `rows` has as many in each row as the matrix was made from.
  void fill_entries(const Csr& rows) const;

 private:
  struct Sparse {
    std::vector<Csr> storage;  ///< arrays below `matrix`: its rows, or those of own and of other columns
    PetscMat matrix;
    RowOrder row_order;
  };
  std::shared_ptr<Sparse> sparse_;
  std::shared_ptr<const LowRankPart> low_rank_;
};

/// A + factor B, with the row groups of A. Collective, as all below.
SymmetricMatrix add(const SymmetricMatrix& A, double factor, const SymmetricMatrix& B);
/// A + diag(d), d replicated.
SymmetricMatrix add_diagonal(const SymmetricMatrix& A, const Eigen::VectorXd& d);
/// A with numbers added to single entries of its diagonal (row, number).
SymmetricMatrix add_diagonal(const SymmetricMatrix& A, const std::vector<std::pair<int, double>>& entries);
/// factor A.
SymmetricMatrix scale(const SymmetricMatrix& A, double factor);
/// Rows and columns `kept` of A, ascending.
SymmetricMatrix take_kept(const SymmetricMatrix& A, const std::vector<int>& kept);

/// A for MatMult: PETSc's sparse matrix, or a shell around A that refuses all else, so that nothing takes the sparse
/// part for the whole unseen.
PetscMat make_operator(const SymmetricMatrix& A);

}  // namespace bough::linear
