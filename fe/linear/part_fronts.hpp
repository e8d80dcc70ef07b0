#pragma once
/// \file One part of a symmetric sum, eliminated front by front.
///
/// Internal to linear.
#include <algorithm>
#include <cmath>
#include <vector>

// First: the BLAS header needs PETSc's own names.
#include "fe/linear/petsc.hpp"

#include <petscblaslapack.h>

#include <cholmod.h>

#include "base/diagnostic.hpp"
#include "fe/linear/cholmod_view.hpp"
#include "fe/linear/dissection.hpp"

namespace bough::linear {

/// "fe.out-of-memory" of a count.
ComputationError make_no_memory_for_count();

/// A + factor B by rows, both triangles.
struct RowSum {
  MatrixRows A, B;
  double factor = 0;
  PetscInt size = 0;  ///< of A and B

  /// use(column, value) for the entries of a row, ascending.
  template <class Use>
  void visit(PetscInt row, const Use& use) const {
    PetscInt a = A.start[row], b = B.start[row];
    const PetscInt a_end = A.start[row + 1], b_end = B.start[row + 1];
    while (a < a_end || b < b_end) {
      if (b == b_end || (a < a_end && A.column[a] < B.column[b])) {
        use(A.column[a], A.value[a]);
        ++a;
      } else if (a == a_end || B.column[b] < A.column[a]) {
        use(B.column[b], factor * B.value[b]);
        ++b;
      } else {
        use(A.column[a], A.value[a] + factor * B.value[b]);
        ++a;
        ++b;
      }
    }
  }

  /// |A_ii| + |factor B_ii|.
  double calc_size(PetscInt row) const {
    const auto find = [row](const MatrixRows& M) {
      const PetscInt* at = std::lower_bound(M.column + M.start[row], M.column + M.start[row + 1], row);
      return at != M.column + M.start[row + 1] && *at == row ? std::abs(M.value[at - M.column]) : 0.0;
    };
    return find(A) + std::abs(factor) * find(B);
  }
};

/// Eliminates the first rows of dense symmetric matrices.
class FrontElimination {
 public:
  /// Lower triangle of F, num_rows square, in place: the first `num` rows by LLᵀ where they are positive, else by LDLᵀ
  /// with pivots among them. Their negative eigenvalues; -1 where a pivot is zero.
  int eliminate(double* F, PetscBLASInt ld, int num, int num_rows);
  /// Reserves work space for fronts with this many rows to eliminate.
  void reserve(int num_columns);

  Eigen::VectorXd change;  ///< by how much the diagonal of the rows that are left changed

 private:
  std::vector<double> pivots_, right_, work_;
  std::vector<PetscBLASInt> pivot_order_;
};

/// The rows of one subdomain, and the separator rows, which come last and are not eliminated.
class PartFronts {
 public:
  PartFronts() { start_in_order(common_); }
  PartFronts(const PartFronts&) = delete;
  PartFronts& operator=(const PartFronts&) = delete;
  ~PartFronts() {
    cholmod_free_factor(&factor_, &common_);
    cholmod_finish(&common_);
  }

  /// False where CHOLMOD has no supernodes in this order, or the part couples to a row that is not its own.
  bool analyse(const RowSum& sum, const std::vector<PetscInt>& own, const std::vector<PetscInt>& between);
  /// Largest number of doubles that count() stores at one time.
  double num_numbers() const { return most_stack_ + square(most_rows_) + square(most_columns_) * 2; }
  /// Negative pivots of the interior rows, and their Schur complement on the separator rows (lower triangle); -1 if a
  /// pivot is too small.
  int count(Eigen::MatrixXd& schur);

 private:
  static double square(double x) { return x * x; }
  /// Extracts the lower triangle of `rows`; returns false if interior rows couple to other rows.
  bool take(const RowSum& sum, const std::vector<PetscInt>& rows);
  /// Eliminates the first `num` of the front's rows; -1 as above.
  int eliminate(int num, int num_rows, const int* rows);
  int get_num_columns(int k) const { return std::min(super_[k + 1], static_cast<int>(num_own_)) - super_[k]; }
  int get_num_rows(int k) const { return row_at_[k + 1] - row_at_[k]; }
  void check() const {
    if (common_.status == CHOLMOD_OUT_OF_MEMORY || common_.status == CHOLMOD_TOO_LARGE)
      throw make_no_memory_for_count();
  }

  cholmod_common common_{};
  cholmod_factor* factor_ = nullptr;
  std::size_t num_own_ = 0;
  int num_fronts_ = 0;
  const int *super_ = nullptr, *row_at_ = nullptr, *row_ = nullptr;
  std::vector<int> num_children_;
  double most_stack_ = 0;
  int most_rows_ = 0, most_columns_ = 0;

  std::vector<int> start_, row_of_entry_;  ///< lower triangle of the sum, by columns
  std::vector<double> value_;
  Eigen::VectorXd diagonal_;  ///< |A| + |factor B|
  std::vector<double> front_;
  FrontElimination elimination_;
};

}  // namespace bough::linear
