#include "fe/linear/ranks.hpp"

#include <algorithm>
#include <new>
#include <numeric>
#include <optional>

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

void sum_on_first(MatrixXd& values) {
  const MpiWorld world = initialize_petsc();
  for (Eigen::Index j = 0; j < values.cols() && world.size > 1; ++j) {
    double* column = values.col(j).data();
    MPI_Reduce(world.rank == 0 ? MPI_IN_PLACE : column, column, static_cast<int>(values.rows()), MPI_DOUBLE, MPI_SUM, 0,
               PETSC_COMM_WORLD);
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

namespace {

/// How many each rank has, and where they begin among all.
struct Counts {
  std::vector<int> nums, starts;
  int sum() const { return starts.back() + nums.back(); }
};

Counts count_over_ranks(std::size_t own) {
  const auto size = static_cast<std::size_t>(initialize_petsc().size);
  Counts counts{std::vector<int>(size), std::vector<int>(size, 0)};
  const int num = static_cast<int>(own);
  MPI_Allgather(&num, 1, MPI_INT, counts.nums.data(), 1, MPI_INT, PETSC_COMM_WORLD);
  std::partial_sum(counts.nums.begin(), counts.nums.end() - 1, counts.starts.begin() + 1);
  return counts;
}

template <class Number>
std::vector<Number> join(const std::vector<Number>& own, MPI_Datatype type) {
  if (initialize_petsc().size == 1) return own;
  const Counts counts = count_over_ranks(own.size());
  std::vector<Number> all(static_cast<std::size_t>(counts.sum()));
  MPI_Allgatherv(own.data(), static_cast<int>(own.size()), type, all.data(), counts.nums.data(), counts.starts.data(),
                 type, PETSC_COMM_WORLD);
  return all;
}

}  // namespace

std::vector<int> join_over_ranks(const std::vector<int>& own) { return join(own, MPI_INT); }
std::vector<double> join_over_ranks(const std::vector<double>& own) { return join(own, MPI_DOUBLE); }

namespace {

template <class Numbers>
Numbers collect(const Numbers& own, MPI_Datatype type) {
  const MpiWorld world = initialize_petsc();
  if (world.size == 1) return own;
  const Counts counts = count_over_ranks(static_cast<std::size_t>(own.size()));
  Numbers all(world.rank == 0 ? static_cast<std::size_t>(counts.sum()) : 0);
  MPI_Gatherv(own.data(), static_cast<int>(own.size()), type, all.data(), counts.nums.data(), counts.starts.data(),
              type, 0, PETSC_COMM_WORLD);
  return all;
}

}  // namespace

std::vector<int> collect_on_first(const std::vector<int>& own) { return collect(own, MPI_INT); }
VectorXd collect_on_first(const VectorXd& own) { return collect(own, MPI_DOUBLE); }

std::string spread_text(std::string text, int from) {
  if (initialize_petsc().size == 1) return text;
  int size = static_cast<int>(text.size());
  MPI_Bcast(&size, 1, MPI_INT, from, PETSC_COMM_WORLD);
  text.resize(static_cast<std::size_t>(size));
  MPI_Bcast(text.data(), size, MPI_CHAR, from, PETSC_COMM_WORLD);
  return text;
}

bool are_all(bool is_true) {
  int all = is_true ? 1 : 0;
  if (initialize_petsc().size > 1) MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD);
  return all == 1;
}

void do_on_all(const ComputationError& otherwise, const std::function<void()>& act) {
  std::optional<ComputationError> failure;
  try {
    act();
  } catch (const ComputationError& error) {
    failure = error;
  } catch (const std::bad_alloc&) {
    failure = otherwise;
  }
  if (!are_all(!failure)) throw failure ? *failure : otherwise;
}

}  // namespace bough::fe
