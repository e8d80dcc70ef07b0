#include "fe/linear/ranks.hpp"

#include <algorithm>
#include <vector>

#include "base/diagnostic.hpp"

namespace bough::linear {

using Eigen::MatrixXd;
using Eigen::VectorXd;

void sum_over_ranks(Eigen::Ref<MatrixXd> values) {
  const MpiWorld world = initialize_petsc();
  if (world.size == 1 || values.size() == 0) return;
  constexpr Eigen::Index kMaxOfMessage = 1 << 24;
  const bool is_one_message = values.outerStride() == values.rows() && values.size() < kMaxOfMessage;
  const Eigen::Index num = is_one_message ? values.size() : values.rows();
  for (Eigen::Index begin = 0; begin < values.size(); begin += num) {
    double* first = values.data() + (is_one_message ? 0 : begin / values.rows() * values.outerStride());
    const int count = static_cast<int>(num);
    MPI_Reduce(world.rank == 0 ? MPI_IN_PLACE : first, first, count, MPI_DOUBLE, MPI_SUM, 0, PETSC_COMM_WORLD);
    MPI_Bcast(first, count, MPI_DOUBLE, 0, PETSC_COMM_WORLD);
  }
}

VectorXd gather(Vec v) {
  PetscInt size = 0;
  const PetscScalar* own = nullptr;
  check_petsc(VecGetSize(v, &size));
  check_petsc(VecGetArrayRead(v, &own));
  VectorXd result(size);
  if (const MpiWorld world = initialize_petsc(); world.size == 1) {
    std::copy(own, own + size, result.data());
  } else {
    const PetscInt* first = nullptr;
    check_petsc(VecGetOwnershipRanges(v, &first));
    std::vector<int> num;
    for (int rank = 0; rank < world.size; ++rank) num.push_back(first[rank + 1] - first[rank]);
    MPI_Allgatherv(own, num[static_cast<std::size_t>(world.rank)], MPI_DOUBLE, result.data(), num.data(), first,
                   MPI_DOUBLE, PETSC_COMM_WORLD);
  }
  check_petsc(VecRestoreArrayRead(v, &own));
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

std::pair<int, int> split_rows(int size) {
  const MpiWorld world = initialize_petsc();
  PetscInt own = PETSC_DECIDE, all = size, last = 0;
  if (world.size == 1) return {0, size};
  check_petsc(PetscSplitOwnership(PETSC_COMM_WORLD, &own, &all));
  MPI_Scan(&own, &last, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD);
  return {last - own, last};
}

}  // namespace bough::linear
