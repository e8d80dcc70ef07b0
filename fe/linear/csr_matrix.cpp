#include "fe/linear/csr_matrix.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "base/diagnostic.hpp"
#include "base/platform.hpp"

namespace bough::linear {
namespace {

static_assert(sizeof(PetscInt) == sizeof(int), "rows are handed to PETSc as int");

/// Returns whole pages to the system; they read as zero afterwards.
template <class T>
void give_back(T* data, std::size_t size) {
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto begin = (reinterpret_cast<std::uintptr_t>(data) + page - 1) / page * page;
  const auto end = reinterpret_cast<std::uintptr_t>(data + size) / page * page;
  if (end > begin) platform::discard_pages(reinterpret_cast<void*>(begin), reinterpret_cast<void*>(end));
}

}  // namespace

Csr make_csr(std::size_t num_rows, std::size_t num_entries) {
  BOUGH_DEMAND(num_entries < 2147483647U);
  return {static_cast<int>(num_rows),
          std::make_unique_for_overwrite<int[]>(num_rows + 1),
          std::make_unique_for_overwrite<int[]>(num_entries),
          std::make_unique_for_overwrite<double[]>(num_entries),
          {}};
}

std::vector<Csr> split_columns(const Csr& rows, int first) {
  const int last = first + rows.num_rows;
  const auto is_own = [&](int column) { return column >= first && column < last; };
  const int size = rows.start[rows.num_rows];
  const auto num_own = static_cast<std::size_t>(std::count_if(rows.columns.get(), rows.columns.get() + size, is_own));
  const auto num_rows = static_cast<std::size_t>(rows.num_rows);
  Csr own_columns = make_csr(num_rows, num_own),
      other_columns = make_csr(num_rows, static_cast<std::size_t>(size) - num_own);
  int own = 0, other = 0;
  for (int i = 0; i < rows.num_rows; ++i) {
    own_columns.start[i] = own;
    other_columns.start[i] = other;
    for (int k = rows.start[i]; k < rows.start[i + 1]; ++k) {
      const int column = rows.columns[k];
      if (is_own(column)) {
        own_columns.columns[own] = column - first;
        own_columns.values[own++] = rows.values[k];
      } else {
        other_columns.columns[other] = column;
        other_columns.values[other++] = rows.values[k];
      }
    }
  }
  own_columns.start[rows.num_rows] = own;
  other_columns.start[rows.num_rows] = other;
  std::vector<Csr> result;
  result.push_back(std::move(own_columns));
  result.push_back(std::move(other_columns));
  return result;
}

PetscMat make_matrix(const std::vector<Csr>& storage, int size) {
  const Csr& own = storage[0];
  PetscMat matrix;
  if (storage.size() == 1) {
    check_petsc(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, own.num_rows, size, own.start.get(), own.columns.get(),
                                          own.values.get(), matrix.out()));
    return matrix;
  }
  const Csr& others = storage[1];
  check_petsc(MatCreateMPIAIJWithSplitArrays(PETSC_COMM_WORLD, own.num_rows, own.num_rows, size, size, own.start.get(),
                                             own.columns.get(), own.values.get(), others.start.get(),
                                             others.columns.get(), others.values.get(), matrix.out()));
  return matrix;
}

void give_back_entries(const Csr& rows) {
  const auto size = static_cast<std::size_t>(rows.start[rows.num_rows]);
  give_back(rows.columns.get(), size);
  give_back(rows.values.get(), size);
}

void copy_entries(const Csr& from, const Csr& to) {
  BOUGH_DEMAND(to.num_rows == from.num_rows &&
               std::equal(from.start.get(), from.start.get() + from.num_rows + 1, to.start.get()));
  const auto size = from.start[from.num_rows];
  std::copy(from.columns.get(), from.columns.get() + size, to.columns.get());
  std::copy(from.values.get(), from.values.get() + size, to.values.get());
}

}  // namespace bough::linear
