#include "fe/linear/products.hpp"

#include "fe/linear/dense_matrix.hpp"
#include "fe/linear/dissection.hpp"
#include "fe/linear/ranks.hpp"
#include "fe/linear/row_products.hpp"

namespace bough::linear {

using Eigen::MatrixXd;

MatrixXd multiply(const SymmetricMatrix& A, const Eigen::Ref<const MatrixXd>& X) {
  if (const LowRankPart* part = A.low_rank()) return multiply(A.sparse_part(), X) + part->multiply(X);
  if (initialize_petsc().size == 1 && X.cols() > 0) {
    MatrixXd Y;
    visit_rows(A.sparse(), [&](const MatrixRows& rows, PetscInt) { Y = multiply_rows(rows, X); });
    return Y;
  }
  const PetscMat dense = make_dense(A.sparse(), X);
  PetscMat product;
  check_petsc(MatMatMult(A.sparse(), dense.get(), MAT_INITIAL_MATRIX, PETSC_DEFAULT, product.out()));
  return replicate(product.get());
}

MatrixXd calc_residual(const SymmetricMatrix& A, const Eigen::Ref<const MatrixXd>& X,
                       const Eigen::Ref<const MatrixXd>& B) {
  MatrixXd R = MatrixXd::Zero(B.rows(), B.cols());
  if (initialize_petsc().size == 1 && B.cols() > 0 && !A.low_rank()) {
    visit_rows(A.sparse(), [&](const MatrixRows& rows, PetscInt) { R = subtract_precisely(rows, X, B); });
    return R;
  }
  // Terms that cancel between the two parts of a sum have more digits too.
  Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic> of_part;
  const LowRankPart* part = A.low_rank();
  if (part) {
    const Eigen::SparseMatrix<long double> U = part->U.cast<long double>();
    of_part = U * (part->W.cast<long double>() * (U.transpose() * X.cast<long double>()));
  }
  const auto subtract = [&](PetscInt row, PetscInt num, const PetscInt* columns, const PetscScalar* values) {
    for (Eigen::Index c = 0; c < B.cols(); ++c) {
      long double sum = B(row, c);
      if (part) sum -= of_part(row, c);
      const double* x = X.col(c).data();
      for (PetscInt k = 0; k < num; ++k) sum -= static_cast<long double>(values[k]) * x[columns[k]];
      R(row, c) = static_cast<double>(sum);
    }
  };
  PetscInt first = 0, last = 0, num = 0;
  check_petsc(MatGetOwnershipRange(A.sparse(), &first, &last));
  const PetscInt* columns = nullptr;
  const PetscScalar* values = nullptr;
  for (PetscInt row = first; row < last; ++row) {
    check_petsc(MatGetRow(A.sparse(), row, &num, &columns, &values));
    subtract(row, num, columns, values);
    check_petsc(MatRestoreRow(A.sparse(), row, &num, &columns, &values));
  }
  sum_over_ranks(R);
  return R;
}

MatrixXd symmetrize(const MatrixXd& A) { return 0.5 * (A + A.transpose()); }

Eigen::VectorXd get_diagonal(const SymmetricMatrix& A) {
  if (const LowRankPart* part = A.low_rank()) return get_diagonal(A.sparse_part()) + part->calc_diagonal();
  PetscVec v;
  check_petsc(MatCreateVecs(A.sparse(), v.out(), nullptr));
  check_petsc(MatGetDiagonal(A.sparse(), v.get()));
  return gather(v.get());
}

}  // namespace bough::linear
