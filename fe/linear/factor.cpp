#include "fe/linear/factor.hpp"

#include <vector>

#include "base/diagnostic.hpp"
#include "fe/linear/dissection.hpp"
#include "fe/linear/memory_need.hpp"
#include "fe/linear/petsc_message.hpp"
#include "fe/linear/ranks.hpp"
#include "fe/linear/row_products.hpp"
#include "fe/linear/sum_factor.hpp"
#include "fe/linear/supernodal_factor.hpp"

namespace bough::fe {
namespace {

using Eigen::MatrixXd;

/// A PETSc matrix on the storage of `values`, which outlives it and, if const, is not written to. One process only.
PetscMat share_dense(const Eigen::Ref<const MatrixXd>& values) {
  PetscMat dense;
  const auto n = static_cast<PetscInt>(values.rows()), m = static_cast<PetscInt>(values.cols());
  check_petsc(MatCreateDense(PETSC_COMM_WORLD, n, m, n, m, const_cast<double*>(values.data()), dense.out()));
  check_petsc(MatDenseSetLDA(dense.get(), static_cast<PetscInt>(values.outerStride())));
  check_petsc(MatAssemblyBegin(dense.get(), MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(dense.get(), MAT_FINAL_ASSEMBLY));
  return dense;
}

/// A dense matrix distributed as A's rows, holding this rank's rows of `values`.
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

}  // namespace

FactorState judge_factorization(int status, int detail) {
  if (status >= 0) return FactorState::Done;
  if (status == -8 || status == -9) return FactorState::NeedsWorkspace;
  if (status == -10) return FactorState::Singular;
  const bool is_memory = status == -13 || status == -7 || status == -19 || status == -22;
  const std::string own = "code " + std::to_string(status) + " (" + std::to_string(detail) + ") of MUMPS";
  if (is_memory)
    throw ComputationError("fe.out-of-memory", {}, "the factor of the stiffness matrix does not fit the memory, " + own,
                           "use a coarser mesh, or run on more processes of a larger machine (mpirun -n 2 bough ...)");
  throw ComputationError("fe.factorization", {}, "the stiffness matrix cannot be factored, " + own,
                         "look for values that are no numbers or of extreme size in properties, materials and grids");
}

/// LLᵀ met a pivot that is not positive: PETSc's code for it; anything else is a failure that another method may share.
void judge_definite(PetscErrorCode code) {
  if (code == 0 || code == PETSC_ERR_MAT_CH_ZRPVT) return;
  // Of the library's own: CHOLMOD_NOT_POSDEF is 1, CHOLMOD_OUT_OF_MEMORY -2, CHOLMOD_TOO_LARGE -3.
  const std::string message = code == PETSC_ERR_LIB ? get_petsc_message(code) : "";
  const auto has = [&](const char* text) { return message.find(text) != std::string::npos; };
  if (has("status 1") || has("not positive definite")) return;
  if (has("status -2") || code == PETSC_ERR_MEM)
    throw ComputationError("fe.out-of-memory", {}, "the factor of the stiffness matrix does not fit the memory",
                           "use a coarser mesh, or run on more processes of a larger machine (mpirun -n 2 bough ...)");
  if (has("status -3"))
    throw ComputationError("fe.out-of-memory", {},
                           "the factor of the stiffness matrix has more than 2^31 entries, more than CHOLMOD counts",
                           "run on two processes or more, where MUMPS factors (mpirun -n 2 bough ...)");
  check_petsc(code);
}

/// The system gives memory that it does not have, and ends the process that uses it.
void require_memory_of(Mat analysed) {
  PetscInt n = 0;
  MatInfo info;
  check_petsc(MatGetSize(analysed, &n, nullptr));
  check_petsc(MatGetInfo(analysed, MAT_LOCAL, &info));
  // A megabyte is there: to ask the system takes as long as such a factor.
  constexpr double kFewEntries = 1e5;
  if (info.nz_used < kFewEntries) return;
  require_memory(static_cast<double>(n), info.nz_used, calc_free_memory());
}

PetscMat factor_definite(Mat A) {
  if (initialize_petsc().size > 1) return {};
  if (const LowRankPart* part = find_low_rank(A)) {
    PetscMat sparse = factor_definite(get_sparse(A));
    if (!sparse) return {};
    PetscMat sum = make_sum_factor(std::move(sparse), *part);
    return count_extra_negative(sum.get()) == 0 ? std::move(sum) : PetscMat();
  }
  if (SupernodalFactor own = make_supernodal_factor(A); own.factor || !own.is_definite) return std::move(own.factor);
  // Without both a small matrix gets an LDLᵀ that takes negative pivots as they come.
  check_petsc(PetscOptionsSetValue(nullptr, "-mat_cholmod_final_asis", "false"));
  check_petsc(PetscOptionsSetValue(nullptr, "-mat_cholmod_final_ll", "true"));
  check_petsc(PetscOptionsSetValue(nullptr, "-mat_cholmod_print", "0"));  // it would write to stdout
  const PetscIs order = find_elimination_order(A);
  // One method is the order given; none are CHOLMOD's own, which would be tried beside it.
  if (order)
    check_petsc(PetscOptionsSetValue(nullptr, "-mat_cholmod_nmethods", "1"));
  else
    check_petsc(PetscOptionsClearValue(nullptr, "-mat_cholmod_nmethods"));
  PetscMat factor;
  check_petsc(MatGetFactor(A, MATSOLVERCHOLMOD, MAT_FACTOR_CHOLESKY, factor.out()));
  MatFactorInfo info;
  check_petsc(MatFactorInfoInitialize(&info));
  MatFactorError error = MAT_FACTOR_NOERROR;
  PetscErrorCode code = MatCholeskyFactorSymbolic(factor.get(), A, order.get(), &info);
  if (code == 0) {
    require_memory_of(factor.get());
    code = MatCholeskyFactorNumeric(factor.get(), A, &info);
  }
  judge_definite(code);
  if (code != 0) return {};
  check_petsc(MatFactorGetError(factor.get(), &error));
  if (error != MAT_FACTOR_NOERROR) return {};
  return factor;
}

SymmetricFactor::SymmetricFactor(Mat A, bool find_null_pivots, FactorMethod method) {
  if (method == FactorMethod::Fastest) factor_ = factor_definite(A);
  is_definite_ = static_cast<bool>(factor_);
  if (is_definite_) return;
  factor_by_mumps(get_sparse(A), find_null_pivots);
  if (const LowRankPart* part = find_low_rank(A); part && !is_singular_)
    factor_ = make_sum_factor(std::move(factor_), *part);
}

std::optional<SymmetricFactor> SymmetricFactor::try_definite(Mat A) {
  SymmetricFactor result;
  result.factor_ = factor_definite(A);
  if (!result.factor_) return {};
  result.is_definite_ = true;
  return result;
}

void SymmetricFactor::factor_by_mumps(Mat A, bool find_null_pivots) {
  // MUMPS estimates its workspace; where pivoting needs more it says so and is given more.
  for (PetscInt extra_percent : {50, 200, 1000}) {
    factor_ = PetscMat();
    check_petsc(MatGetFactor(A, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, factor_.out()));
    Mat F = factor_.get();
    check_petsc(MatMumpsSetIcntl(F, 14, extra_percent));
    if (find_null_pivots) {
      check_petsc(MatMumpsSetIcntl(F, 24, 1));
      check_petsc(MatMumpsSetCntl(F, 3, 1e-15));
    }
    MatFactorInfo info;
    check_petsc(MatFactorInfoInitialize(&info));
    check_petsc(MatCholeskyFactorSymbolic(F, A, nullptr, &info));
    check_petsc(MatCholeskyFactorNumeric(F, A, &info));
    MatFactorError error = MAT_FACTOR_NOERROR;
    check_petsc(MatFactorGetError(F, &error));
    PetscInt status = 0, detail = 0;
    check_petsc(MatMumpsGetInfog(F, 1, &status));
    check_petsc(MatMumpsGetInfog(F, 2, &detail));
    const FactorState state = judge_factorization(status, detail);
    if (state == FactorState::NeedsWorkspace) continue;
    is_singular_ = state == FactorState::Singular || error != MAT_FACTOR_NOERROR;
    if (is_singular_) return;
    PetscInt num = 0;
    check_petsc(MatMumpsGetInfog(F, 28, &num));
    num_null_pivots_ = find_null_pivots ? static_cast<int>(num) : 0;
    return;
  }
  throw ComputationError("fe.factorization", {},
                         "the stiffness matrix cannot be factored: pivoting needs more than ten times the workspace",
                         "look for negative springs, and for very soft and very stiff parts side by side");
}

bool is_own_factor(Mat factor) { return is_sum_factor(factor) || is_supernodal_factor(factor); }

MatrixXd solve_factored(Mat factor, const Eigen::Ref<const MatrixXd>& B) {
  if (B.cols() == 0) return B;
  if (MatrixXd X; solve_sum(factor, B, X) || solve_supernodal(factor, B, X)) return X;
  const PetscMat rhs = make_dense(factor, B);
  if (initialize_petsc().size == 1) {
    MatrixXd X(B.rows(), B.cols());
    check_petsc(MatMatSolve(factor, rhs.get(), share_dense(X).get()));
    return X;
  }
  PetscMat x;
  check_petsc(MatDuplicate(rhs.get(), MAT_DO_NOT_COPY_VALUES, x.out()));
  check_petsc(MatMatSolve(factor, rhs.get(), x.get()));
  return replicate(x.get());
}

MatrixXd SymmetricFactor::solve(const Eigen::Ref<const MatrixXd>& B) const { return solve_factored(factor_.get(), B); }

MatrixXd multiply(Mat A, const Eigen::Ref<const MatrixXd>& X) {
  if (const LowRankPart* part = find_low_rank(A)) return multiply(get_sparse(A), X) + part->multiply(X);
  if (initialize_petsc().size == 1 && X.cols() > 0) {
    MatrixXd Y;
    visit_rows(A, [&](const MatrixRows& rows, PetscInt) { Y = multiply_rows(rows, X); });
    return Y;
  }
  const PetscMat dense = make_dense(A, X);
  PetscMat product;
  check_petsc(MatMatMult(A, dense.get(), MAT_INITIAL_MATRIX, PETSC_DEFAULT, product.out()));
  return replicate(product.get());
}

MatrixXd calc_residual(Mat A, const Eigen::Ref<const MatrixXd>& X, const Eigen::Ref<const MatrixXd>& B) {
  MatrixXd R = MatrixXd::Zero(B.rows(), B.cols());
  if (initialize_petsc().size == 1 && B.cols() > 0 && !find_low_rank(A)) {
    visit_rows(A, [&](const MatrixRows& rows, PetscInt) { R = subtract_precisely(rows, X, B); });
    return R;
  }
  // What cancels between the two parts of a sum has more digits too.
  Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic> of_part;
  const LowRankPart* part = find_low_rank(A);
  if (part) {
    const Eigen::SparseMatrix<long double> U = part->U.cast<long double>();
    of_part = U * (part->W.cast<long double>() * (U.transpose() * X.cast<long double>()));
    A = get_sparse(A);
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
  check_petsc(MatGetOwnershipRange(A, &first, &last));
  const PetscInt* columns = nullptr;
  const PetscScalar* values = nullptr;
  for (PetscInt row = first; row < last; ++row) {
    check_petsc(MatGetRow(A, row, &num, &columns, &values));
    subtract(row, num, columns, values);
    check_petsc(MatRestoreRow(A, row, &num, &columns, &values));
  }
  sum_over_ranks(R);
  return R;
}

Eigen::VectorXd get_diagonal(Mat A) {
  if (const LowRankPart* part = find_low_rank(A)) return get_diagonal(get_sparse(A)) + part->calc_diagonal();
  PetscVec v;
  check_petsc(MatCreateVecs(A, v.out(), nullptr));
  check_petsc(MatGetDiagonal(A, v.get()));
  return gather(v.get());
}

}  // namespace bough::fe
