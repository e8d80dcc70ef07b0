#include "fe/linear/dense_matrix.hpp"

#include <vector>

#include "base/diagnostic.hpp"

namespace bough::linear {

using Eigen::MatrixXd;

PetscMat share_dense(const Eigen::Ref<const MatrixXd>& values) {
  PetscMat dense;
  const auto n = static_cast<PetscInt>(values.rows()), m = static_cast<PetscInt>(values.cols());
  check_petsc(MatCreateDense(PETSC_COMM_WORLD, n, m, n, m, const_cast<double*>(values.data()), dense.out()));
  check_petsc(MatDenseSetLDA(dense.get(), static_cast<PetscInt>(values.outerStride())));
  check_petsc(MatAssemblyBegin(dense.get(), MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(dense.get(), MAT_FINAL_ASSEMBLY));
  return dense;
}

PetscMat make_dense(Mat A, const Eigen::Ref<const MatrixXd>& values) {
  if (initialize_petsc().size == 1) return share_dense(values);
  PetscInt local = 0, size = 0, first = 0;
  check_petsc(MatGetLocalSize(A, &local, nullptr));
  check_petsc(MatGetSize(A, &size, nullptr));
  check_petsc(MatGetOwnershipRange(A, &first, nullptr));
  BOUGH_DEMAND(values.rows() == size);
  PetscMat dense;
  const auto m = static_cast<PetscInt>(values.cols());
  check_petsc(MatCreateDense(PETSC_COMM_WORLD, local, PETSC_DECIDE, size, m, nullptr, dense.out()));
  PetscScalar* data = nullptr;
  PetscInt lda = 0;
  check_petsc(MatDenseGetLDA(dense.get(), &lda));
  check_petsc(MatDenseGetArrayWrite(dense.get(), &data));
  Eigen::Map<MatrixXd, 0, Eigen::OuterStride<>>(data, local, m, Eigen::OuterStride<>(lda)) =
      values.middleRows(first, local);
  check_petsc(MatDenseRestoreArrayWrite(dense.get(), &data));
  check_petsc(MatAssemblyBegin(dense.get(), MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(dense.get(), MAT_FINAL_ASSEMBLY));
  return dense;
}

MatrixXd replicate(Mat dense) {
  PetscInt local = 0, size = 0, m = 0, lda = 0;
  check_petsc(MatGetLocalSize(dense, &local, nullptr));
  check_petsc(MatGetSize(dense, &size, &m));
  MatrixXd values(size, m);
  const PetscScalar* data = nullptr;
  const PetscInt* firsts = nullptr;
  check_petsc(MatGetOwnershipRanges(dense, &firsts));
  std::vector<int> num;
  for (int rank = 0; rank < initialize_petsc().size; ++rank) num.push_back(firsts[rank + 1] - firsts[rank]);
  check_petsc(MatDenseGetLDA(dense, &lda));
  check_petsc(MatDenseGetArrayRead(dense, &data));
  for (PetscInt j = 0; j < m; ++j)
    MPI_Allgatherv(data + static_cast<std::ptrdiff_t>(j) * lda, local, MPI_DOUBLE, values.col(j).data(), num.data(),
                   firsts, MPI_DOUBLE, PETSC_COMM_WORLD);
  check_petsc(MatDenseRestoreArrayRead(dense, &data));
  return values;
}

}  // namespace bough::linear
