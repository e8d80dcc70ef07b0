#include "fe/linear/ranks.hpp"

#include <algorithm>

#include "base/diagnostic.hpp"

namespace bough::fe {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr Eigen::Index kMostAtOnce = 1 << 24;  ///< numbers of one message

}  // namespace

void sum_over_ranks(Eigen::Ref<MatrixXd> values) {
  if (initialize_petsc().size == 1 || values.size() == 0) return;
  if (values.outerStride() == values.rows() && values.size() < kMostAtOnce) {
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
    return;
  }
  for (Eigen::Index j = 0; j < values.cols(); ++j)
    MPI_Allreduce(MPI_IN_PLACE, values.col(j).data(), static_cast<int>(values.rows()), MPI_DOUBLE, MPI_SUM,
                  PETSC_COMM_WORLD);
}

void sum_alike(Eigen::Ref<MatrixXd> values) {
  const MpiWorld world = initialize_petsc();
  if (world.size == 1) return;
  for (Eigen::Index j = 0; j < values.cols(); ++j) {
    const auto num = static_cast<int>(values.rows());
    double* column = values.col(j).data();
    MPI_Reduce(world.rank == 0 ? MPI_IN_PLACE : column, column, num, MPI_DOUBLE, MPI_SUM, 0, PETSC_COMM_WORLD);
    MPI_Bcast(column, num, MPI_DOUBLE, 0, PETSC_COMM_WORLD);
  }
}

VectorXd gather(Vec v) {
  PetscInt size = 0, first = 0, last = 0;
  check_petsc(VecGetSize(v, &size));
  check_petsc(VecGetOwnershipRange(v, &first, &last));
  VectorXd result = VectorXd::Zero(size);
  const PetscScalar* values = nullptr;
  check_petsc(VecGetArrayRead(v, &values));
  std::copy(values, values + (last - first), result.data() + first);
  check_petsc(VecRestoreArrayRead(v, &values));
  sum_over_ranks(result);
  return result;
}

void scatter(const Eigen::Ref<const VectorXd>& values, Vec v) {
  PetscInt size = 0, first = 0, last = 0;
  check_petsc(VecGetSize(v, &size));
  BOUGH_DEMAND(values.size() == size);
  check_petsc(VecGetOwnershipRange(v, &first, &last));
  PetscScalar* own = nullptr;
  check_petsc(VecGetArray(v, &own));
  std::copy(values.data() + first, values.data() + last, own);
  check_petsc(VecRestoreArray(v, &own));
}

}  // namespace bough::fe
