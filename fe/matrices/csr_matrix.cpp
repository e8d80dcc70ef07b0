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

constexpr const char* kRows = "bough_rows";

PetscErrorCode destroy_csr(void* csr) {
  delete static_cast<Csr*>(csr);
  return 0;
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
  PetscHandle<PetscContainer, PetscContainerDestroy> owner;
  check_petsc(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, csr->num_rows, num_columns, csr->start.get(),
                                        csr->columns.get(), csr->values.get(), matrix.out()));
  check_petsc(PetscContainerCreate(PETSC_COMM_SELF, owner.out()));
  check_petsc(PetscContainerSetUserDestroy(owner.get(), destroy_csr));
  check_petsc(PetscContainerSetPointer(owner.get(), csr.release()));
  check_petsc(PetscObjectCompose(reinterpret_cast<PetscObject>(matrix.get()), kRows,
                                 reinterpret_cast<PetscObject>(owner.get())));
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
