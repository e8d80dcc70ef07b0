#include "fe/matrices/csr_matrix.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "base/diagnostic.hpp"

namespace bough::fe {
namespace {

static_assert(sizeof(PetscInt) == sizeof(int), "rows are handed to PETSc as int");

constexpr const char *kRows = "bough_rows", *kSplitRows = "bough_split_rows";

template <class Owned>
PetscErrorCode destroy(void* owned) {
  delete static_cast<Owned*>(owned);
  return 0;
}

/// A has it until it is destroyed.
template <class Owned>
void keep(Mat A, const char* name, std::unique_ptr<Owned> owned) {
  PetscHandle<PetscContainer, PetscContainerDestroy> owner;
  check_petsc(PetscContainerCreate(PETSC_COMM_SELF, owner.out()));
  check_petsc(PetscContainerSetUserDestroy(owner.get(), destroy<Owned>));
  check_petsc(PetscContainerSetPointer(owner.get(), owned.release()));
  check_petsc(PetscObjectCompose(reinterpret_cast<PetscObject>(A), name, reinterpret_cast<PetscObject>(owner.get())));
}

/// The rows of a rank: columns of its own rows, counted from these, and all others.
struct SplitCsr {
  Csr own, others;
};

SplitCsr split(const Csr& rows, int first) {
  const int last = first + rows.num_rows;
  const auto is_own = [&](int column) { return column >= first && column < last; };
  const int size = rows.start[rows.num_rows];
  const auto num_own = static_cast<std::size_t>(std::count_if(rows.columns.get(), rows.columns.get() + size, is_own));
  const auto num_rows = static_cast<std::size_t>(rows.num_rows);
  SplitCsr result{make_csr(num_rows, num_own), make_csr(num_rows, static_cast<std::size_t>(size) - num_own)};
  int own = 0, other = 0;
  for (int i = 0; i < rows.num_rows; ++i) {
    result.own.start[i] = own;
    result.others.start[i] = other;
    for (int k = rows.start[i]; k < rows.start[i + 1]; ++k) {
      const int column = rows.columns[k];
      if (is_own(column)) {
        result.own.columns[own] = column - first;
        result.own.values[own++] = rows.values[k];
      } else {
        result.others.columns[other] = column;
        result.others.values[other++] = rows.values[k];
      }
    }
  }
  result.own.start[rows.num_rows] = own;
  result.others.start[rows.num_rows] = other;
  return result;
}

Csr* find_rows(Mat A) {
  PetscObject object = nullptr;
  check_petsc(PetscObjectQuery(reinterpret_cast<PetscObject>(A), kRows, &object));
  if (!object) return nullptr;
  void* rows = nullptr;
  check_petsc(PetscContainerGetPointer(reinterpret_cast<PetscContainer>(object), &rows));
  return static_cast<Csr*>(rows);
}

/// Of whole pages; what is read there afterwards is zero.
template <class T>
void give_back(T* data, std::size_t size) {
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto begin = (reinterpret_cast<std::uintptr_t>(data) + page - 1) / page * page;
  const auto end = reinterpret_cast<std::uintptr_t>(data + size) / page * page;
  if (end > begin) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_DONTNEED);
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

PetscMat make_matrix(Csr rows, int num_columns) {
  auto csr = std::make_unique<Csr>(std::move(rows));
  PetscMat matrix;
  check_petsc(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, csr->num_rows, num_columns, csr->start.get(),
                                        csr->columns.get(), csr->values.get(), matrix.out()));
  keep(matrix.get(), kRows, std::move(csr));
  return matrix;
}

PetscMat make_matrix_of_ranks(Csr rows, int first, int size) {
  auto split_rows = std::make_unique<SplitCsr>(split(rows, first));
  rows = {};
  Csr &own = split_rows->own, &others = split_rows->others;
  PetscMat matrix;
  check_petsc(MatCreateMPIAIJWithSplitArrays(PETSC_COMM_WORLD, own.num_rows, own.num_rows, size, size, own.start.get(),
                                             own.columns.get(), own.values.get(), others.start.get(),
                                             others.columns.get(), others.values.get(), matrix.out()));
  keep(matrix.get(), kSplitRows, std::move(split_rows));
  return matrix;
}

bool drop_entries(Mat A) {
  Csr* rows = find_rows(A);
  if (!rows) return false;
  const auto size = static_cast<std::size_t>(rows->start[rows->num_rows]);
  give_back(rows->columns.get(), size);
  give_back(rows->values.get(), size);
  return true;
}

void fill_entries(Mat A, const Csr& rows) {
  Csr* own = find_rows(A);
  BOUGH_DEMAND(own && own->num_rows == rows.num_rows &&
               std::equal(rows.start.get(), rows.start.get() + rows.num_rows + 1, own->start.get()));
  const auto size = rows.start[rows.num_rows];
  std::copy(rows.columns.get(), rows.columns.get() + size, own->columns.get());
  std::copy(rows.values.get(), rows.values.get() + size, own->values.get());
}

}  // namespace bough::fe
