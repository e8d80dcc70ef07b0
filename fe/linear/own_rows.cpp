#include "fe/linear/own_rows.hpp"

#include <vector>

#include "base/diagnostic.hpp"
#include "fe/linear/blas.hpp"
#include "fe/linear/factor.hpp"
#include "fe/linear/ordering.hpp"
#include "fe/linear/ranks.hpp"

namespace bough::fe {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd OwnRows::replicate(const Eigen::Ref<const MatrixXd>& own) const {
  if (!is_cut) return own;
  BOUGH_DEMAND(own.rows() == num);
  const std::vector<int> nums = join_over_ranks(std::vector<int>{num}),
                         firsts = join_over_ranks(std::vector<int>{first});
  MatrixXd whole(size, own.cols());
  for (Eigen::Index j = 0; j < own.cols(); ++j)
    MPI_Allgatherv(own.col(j).data(), num, MPI_DOUBLE, whole.col(j).data(), nums.data(), firsts.data(), MPI_DOUBLE,
                   PETSC_COMM_WORLD);
  return whole;
}

MatrixXd OwnRows::dot(const Eigen::Ref<const MatrixXd>& X, const Eigen::Ref<const MatrixXd>& Y) const {
  MatrixXd G(X.cols(), Y.cols());
  if (G.size() == 0) return G;
  multiply_dense(true, X, Y, 0, G);
  if (is_cut) sum_alike(G);
  return G;
}

VectorXd OwnRows::dot_columns(const Eigen::Ref<const MatrixXd>& X, const Eigen::Ref<const MatrixXd>& Y) const {
  VectorXd sums = X.cwiseProduct(Y).colwise().sum();
  if (is_cut) sum_alike(sums);
  return sums;
}

MatrixXd OwnRows::multiply(Mat A, const Eigen::Ref<const MatrixXd>& X) const {
  if (!is_cut) return fe::multiply(A, X);
  if (X.cols() == 0) return X;
  PetscMat dense, product;
  const auto m = static_cast<PetscInt>(X.cols());
  MatrixXd own = X;
  check_petsc(MatCreateDense(PETSC_COMM_WORLD, num, PETSC_DECIDE, size, m, own.data(), dense.out()));
  check_petsc(MatAssemblyBegin(dense.get(), MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(dense.get(), MAT_FINAL_ASSEMBLY));
  check_petsc(MatMatMult(A, dense.get(), MAT_INITIAL_MATRIX, PETSC_DEFAULT, product.out()));
  const PetscScalar* values = nullptr;
  PetscInt lda = 0;
  check_petsc(MatDenseGetLDA(product.get(), &lda));
  check_petsc(MatDenseGetArrayRead(product.get(), &values));
  own = Eigen::Map<const MatrixXd, 0, Eigen::OuterStride<>>(values, num, m, Eigen::OuterStride<>(lda));
  check_petsc(MatDenseRestoreArrayRead(product.get(), &values));
  return own;
}

OwnRows make_whole_rows(Mat A) {
  OwnRows rows;
  check_petsc(MatGetSize(A, &rows.size, nullptr));
  rows.num = rows.size;
  return rows;
}

OwnRows find_own_rows(Mat A) {
  OwnRows rows = make_whole_rows(A);
  if (initialize_petsc().size == 1 || !are_rows_by_parts(A)) return rows;
  PetscInt last = 0;
  check_petsc(MatGetOwnershipRange(A, &rows.first, &last));
  rows.num = last - rows.first;
  rows.is_cut = true;
  return rows;
}

}  // namespace bough::fe
