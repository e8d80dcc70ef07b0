#include "fe/linear/symmetric_matrix.hpp"

#include <algorithm>

#include "base/diagnostic.hpp"
#include "fe/linear/ordering.hpp"
#include "fe/linear/ranks.hpp"

namespace bough::linear {
namespace {

using Eigen::VectorXd;

/// On several ranks the sums of Uᵀx are of all; y of the local rows.
PetscErrorCode multiply_sum(Mat shell, Vec x, Vec y) {
  void* context = nullptr;
  check_petsc(MatShellGetContext(shell, static_cast<void*>(&context)));
  const auto& A = *static_cast<const SymmetricMatrix*>(context);
  const LowRankPart& part = *A.low_rank();
  check_petsc(MatMult(A.sparse(), x, y));
  PetscInt first = 0, last = 0;
  check_petsc(MatGetOwnershipRange(shell, &first, &last));
  const Eigen::SparseMatrix<double> U = part.U.middleRows(first, last - first);
  const PetscScalar* x_own = nullptr;
  check_petsc(VecGetArrayRead(x, &x_own));
  VectorXd t = U.transpose() * Eigen::Map<const VectorXd>(x_own, last - first);
  check_petsc(VecRestoreArrayRead(x, &x_own));
  MPI_Allreduce(MPI_IN_PLACE, t.data(), static_cast<int>(t.size()), MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  PetscScalar* y_own = nullptr;
  check_petsc(VecGetArray(y, &y_own));
  Eigen::Map<VectorXd>(y_own, last - first) += U * (part.W * t);
  check_petsc(VecRestoreArray(y, &y_own));
  return 0;
}

PetscErrorCode destroy_sum(Mat shell) {
  void* context = nullptr;
  check_petsc(MatShellGetContext(shell, static_cast<void*>(&context)));
  delete static_cast<SymmetricMatrix*>(context);
  return 0;
}

/// A new copy of A_0.
PetscMat copy_sparse(const SymmetricMatrix& A) {
  PetscMat C;
  check_petsc(MatDuplicate(A.sparse(), MAT_COPY_VALUES, C.out()));
  return C;
}

/// `sparse`, of the rows of A, with the part of low rank of A and what is known of its elimination.
SymmetricMatrix make_like(const SymmetricMatrix& A, PetscMat sparse) {
  SymmetricMatrix C(std::move(sparse), A.low_rank() ? *A.low_rank() : LowRankPart());
  copy_row_order(A, C);
  return C;
}

LowRankPart add_parts(const LowRankPart* a, double factor, const LowRankPart* b) {
  const LowRankPart none;
  return join(a ? *a : none, 1, b ? *b : none, factor);
}

}  // namespace

SymmetricMatrix::SymmetricMatrix(PetscMat sparse, LowRankPart part) : sparse_(std::make_shared<Sparse>()) {
  sparse_->matrix = std::move(sparse);
  check_petsc(MatSetOption(sparse_->matrix.get(), MAT_SYMMETRIC, PETSC_TRUE));
  if (part.rank() == 0) return;
  BOUGH_DEMAND(part.U.rows() == num_rows());
  low_rank_ = std::make_shared<const LowRankPart>(std::move(part));
}

namespace {

using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Rows [first, last) of A.
Csr copy_rows(const SparseRows& A, int first, int last) {
  Eigen::Index size = 0;
  for (int row = first; row < last; ++row) size += A.row(row).nonZeros();
  Csr rows = make_csr(static_cast<std::size_t>(last - first), static_cast<std::size_t>(size));
  int at = 0;
  for (int row = first; row < last; ++row) {
    rows.start[row - first] = at;
    for (SparseRows::InnerIterator it(A, row); it; ++it, ++at) {
      rows.columns[at] = static_cast<int>(it.col());
      rows.values[at] = it.value();
    }
  }
  rows.start[last - first] = at;
  return rows;
}

SymmetricMatrix make_from(const SparseRows& A) {
  const auto [first, last] = split_rows(static_cast<int>(A.rows()));
  return SymmetricMatrix(copy_rows(A, first, last), first, static_cast<int>(A.rows()));
}

}  // namespace

SymmetricMatrix::SymmetricMatrix(const SparseRows& A) : SymmetricMatrix(make_from(A)) {}

SymmetricMatrix::SymmetricMatrix(Csr rows, int first, int size) : sparse_(std::make_shared<Sparse>()) {
  auto groups = std::make_shared<const std::vector<int>>(std::move(rows.groups));
  if (initialize_petsc().size == 1) {
    sparse_->storage.push_back(std::move(rows));
    if (!groups->empty()) sparse_->row_order.groups = std::move(groups);  // on several processes MUMPS orders
  } else {
    sparse_->storage = split_columns(rows, first);
    rows = {};
  }
  sparse_->matrix = make_matrix(sparse_->storage, size);
  check_petsc(MatSetOption(sparse(), MAT_SYMMETRIC, PETSC_TRUE));
  check_petsc(MatSetOption(sparse(), MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
}

int SymmetricMatrix::num_rows() const {
  PetscInt size = 0;
  check_petsc(MatGetSize(sparse(), &size, nullptr));
  return size;
}

SymmetricMatrix SymmetricMatrix::sparse_part() const { return with_low_rank({}); }

SymmetricMatrix SymmetricMatrix::with_low_rank(LowRankPart part) const {
  SymmetricMatrix result;
  result.sparse_ = sparse_;
  if (part.rank() > 0) result.low_rank_ = std::make_shared<const LowRankPart>(std::move(part));
  return result;
}

bool SymmetricMatrix::drop_entries() const {
  if (low_rank_ || sparse_->storage.size() != 1) return false;
  give_back_entries(sparse_->storage[0]);
  return true;
}

void SymmetricMatrix::fill_entries(const Csr& rows) const {
  BOUGH_DEMAND(sparse_->storage.size() == 1);
  copy_entries(rows, sparse_->storage[0]);
}

SymmetricMatrix add(const SymmetricMatrix& A, double factor, const SymmetricMatrix& B) {
  PetscMat C = copy_sparse(A);
  if (factor == 0) return make_like(A, std::move(C));
  check_petsc(MatAXPY(C.get(), factor, B.sparse(), DIFFERENT_NONZERO_PATTERN));
  return make_like(A, std::move(C)).with_low_rank(add_parts(A.low_rank(), factor, B.low_rank()));
}

SymmetricMatrix add_diagonal(const SymmetricMatrix& A, const VectorXd& d) {
  PetscMat C = copy_sparse(A);
  PetscVec v;
  PetscInt first = 0, last = 0;
  check_petsc(MatCreateVecs(C.get(), v.out(), nullptr));
  check_petsc(VecGetOwnershipRange(v.get(), &first, &last));
  PetscScalar* own = nullptr;
  check_petsc(VecGetArray(v.get(), &own));
  std::copy(d.data() + first, d.data() + last, own);
  check_petsc(VecRestoreArray(v.get(), &own));
  check_petsc(MatDiagonalSet(C.get(), v.get(), ADD_VALUES));
  return make_like(A, std::move(C));
}

SymmetricMatrix add_diagonal(const SymmetricMatrix& A, const std::vector<std::pair<int, double>>& entries) {
  PetscMat C = copy_sparse(A);
  PetscInt first = 0, last = 0;
  check_petsc(MatGetOwnershipRange(C.get(), &first, &last));
  for (const auto& [row, number] : entries)
    if (row >= first && row < last) check_petsc(MatSetValue(C.get(), row, row, number, ADD_VALUES));
  check_petsc(MatAssemblyBegin(C.get(), MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(C.get(), MAT_FINAL_ASSEMBLY));
  return make_like(A, std::move(C));
}

SymmetricMatrix scale(const SymmetricMatrix& A, double factor) {
  PetscMat C = copy_sparse(A);
  check_petsc(MatScale(C.get(), factor));
  SymmetricMatrix result = make_like(A, std::move(C));
  return A.low_rank() ? result.with_low_rank(scale(*A.low_rank(), factor)) : result;
}

SymmetricMatrix take_kept(const SymmetricMatrix& A, const std::vector<int>& kept) {
  PetscInt first = 0, last = 0;
  check_petsc(MatGetOwnershipRange(A.sparse(), &first, &last));
  const auto begin = std::lower_bound(kept.begin(), kept.end(), first);
  const auto end = std::lower_bound(kept.begin(), kept.end(), last);
  const std::vector<PetscInt> own(begin, end);
  PetscHandle<IS, ISDestroy> rows;
  check_petsc(
      ISCreateGeneral(PETSC_COMM_WORLD, static_cast<PetscInt>(own.size()), own.data(), PETSC_COPY_VALUES, rows.out()));
  PetscMat sparse;
  check_petsc(MatCreateSubMatrix(A.sparse(), rows.get(), rows.get(), MAT_INITIAL_MATRIX, sparse.out()));
  SymmetricMatrix result(std::move(sparse), A.low_rank() ? take_kept(*A.low_rank(), kept) : LowRankPart());
  take_row_order(A, kept, result);
  return result;
}

PetscMat make_operator(const SymmetricMatrix& A) {
  if (!A.low_rank()) {
    check_petsc(PetscObjectReference(reinterpret_cast<PetscObject>(A.sparse())));
    return PetscMat(A.sparse());
  }
  PetscInt local = 0, size = 0;
  check_petsc(MatGetLocalSize(A.sparse(), &local, nullptr));
  check_petsc(MatGetSize(A.sparse(), &size, nullptr));
  auto own = std::make_unique<SymmetricMatrix>(A);
  PetscMat shell;
  check_petsc(MatCreateShell(PETSC_COMM_WORLD, local, local, size, size, own.get(), shell.out()));
  check_petsc(MatShellSetOperation(shell.get(), MATOP_DESTROY, reinterpret_cast<void (*)()>(destroy_sum)));
  own.release();
  // Scales and shifts of PETSc's own would be unseen here: without them it refuses both.
  check_petsc(MatShellSetManageScalingShifts(shell.get()));
  check_petsc(MatShellSetOperation(shell.get(), MATOP_MULT, reinterpret_cast<void (*)()>(multiply_sum)));
  check_petsc(MatShellSetOperation(shell.get(), MATOP_MULT_TRANSPOSE, reinterpret_cast<void (*)()>(multiply_sum)));
  check_petsc(MatSetOption(shell.get(), MAT_SYMMETRIC, PETSC_TRUE));
  check_petsc(MatSetUp(shell.get()));
  return shell;
}

}  // namespace bough::linear
