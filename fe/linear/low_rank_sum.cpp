#include "fe/linear/low_rank_sum.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <Eigen/Eigenvalues>

#include "base/diagnostic.hpp"
#include "fe/linear/ordering.hpp"
#include "fe/linear/ranks.hpp"

namespace bough::fe {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using SparseColumns = Eigen::SparseMatrix<double>;

struct Sum {
  PetscMat sparse;
  LowRankPart part;
};

PetscErrorCode multiply_sum(Mat A, Vec x, Vec y) {
  void* context = nullptr;
  check_petsc(MatShellGetContext(A, static_cast<void*>(&context)));
  const auto& sum = *static_cast<const Sum*>(context);
  check_petsc(MatMult(sum.sparse.get(), x, y));
  PetscInt first = 0, last = 0;
  check_petsc(MatGetOwnershipRange(A, &first, &last));
  const SparseColumns U = sum.part.U.middleRows(first, last - first);
  const PetscScalar* x_own = nullptr;
  check_petsc(VecGetArrayRead(x, &x_own));
  VectorXd t = U.transpose() * Eigen::Map<const VectorXd>(x_own, last - first);
  check_petsc(VecRestoreArrayRead(x, &x_own));
  MPI_Allreduce(MPI_IN_PLACE, t.data(), static_cast<int>(t.size()), MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  PetscScalar* y_own = nullptr;
  check_petsc(VecGetArray(y, &y_own));
  Eigen::Map<VectorXd>(y_own, last - first) += U * (sum.part.W * t);
  check_petsc(VecRestoreArray(y, &y_own));
  return 0;
}

PetscErrorCode destroy_sum(Mat A) {
  void* context = nullptr;
  check_petsc(MatShellGetContext(A, static_cast<void*>(&context)));
  delete static_cast<Sum*>(context);
  return 0;
}

const Sum* find_sum(Mat A) { return static_cast<const Sum*>(find_shell_context(A, destroy_sum)); }

SparseColumns join_columns(const SparseColumns& A, const SparseColumns& B) {
  SparseColumns C(A.rows(), A.cols() + B.cols());
  C.leftCols(A.cols()) = A;
  C.rightCols(B.cols()) = B;
  return C;
}

MatrixXd join_diagonal(const MatrixXd& A, const MatrixXd& B) {
  MatrixXd C = MatrixXd::Zero(A.rows() + B.rows(), A.cols() + B.cols());
  C.topLeftCorner(A.rows(), A.cols()) = A;
  C.bottomRightCorner(B.rows(), B.cols()) = B;
  return C;
}

LowRankPart multiply(const LowRankPart& part, double factor) {
  BOUGH_DEMAND(factor != 0);
  return {part.U, factor * part.W, part.W_inverse / factor,
          factor > 0 ? part.num_positive : part.rank() - part.num_positive};
}

const LowRankPart& get_part(Mat A) {
  static const LowRankPart none;
  const auto* part = find_low_rank(A);
  return part ? *part : none;
}

PetscMat copy_sparse(Mat A) {
  PetscMat C;
  check_petsc(MatDuplicate(A, MAT_COPY_VALUES, C.out()));
  check_petsc(MatSetOption(C.get(), MAT_SYMMETRIC, PETSC_TRUE));
  copy_row_groups(A, C.get());
  return C;
}

PetscMat take_kept_sparse(Mat A, const std::vector<int>& kept) {
  PetscInt first = 0, last = 0;
  check_petsc(MatGetOwnershipRange(A, &first, &last));
  const auto begin = std::lower_bound(kept.begin(), kept.end(), first);
  const auto end = std::lower_bound(kept.begin(), kept.end(), last);
  const std::vector<PetscInt> own(begin, end);
  PetscIs rows;
  check_petsc(
      ISCreateGeneral(PETSC_COMM_WORLD, static_cast<PetscInt>(own.size()), own.data(), PETSC_COPY_VALUES, rows.out()));
  PetscMat result;
  check_petsc(MatCreateSubMatrix(A, rows.get(), rows.get(), MAT_INITIAL_MATRIX, result.out()));
  check_petsc(MatSetOption(result.get(), MAT_SYMMETRIC, PETSC_TRUE));
  take_row_groups(A, kept, result.get());
  return result;
}

}  // namespace

VectorXd LowRankPart::calc_diagonal() const {
  const MatrixXd UW = U * W;
  VectorXd d = VectorXd::Zero(U.rows());
  for (Eigen::Index k = 0; k < U.outerSize(); ++k)
    for (SparseColumns::InnerIterator it(U, k); it; ++it) d(it.row()) += it.value() * UW(it.row(), k);
  return d;
}

LowRankPart make_form_part(const SparseColumns& X, const MatrixXd& K) {
  if (K.isZero(0)) return {SparseColumns(X.rows(), 0), MatrixXd(0, 0), MatrixXd(0, 0), 0};
  const VectorXd size = K.diagonal().cwiseAbs().cwiseSqrt();
  const double largest = size.size() ? size.maxCoeff() : 0;
  // Rotations and translations, each in its own unit; what has no diagonal of its own is of the largest.
  const VectorXd unit = size.unaryExpr([&](double s) { return s > 1e-8 * largest ? s : largest > 0 ? largest : 1; });
  const VectorXd inverse = unit.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> parts(inverse.asDiagonal() * K * inverse.asDiagonal());
  std::vector<Eigen::Index> kept;
  const double most = K.size() ? parts.eigenvalues().cwiseAbs().maxCoeff() : 0;
  for (Eigen::Index i = 0; i < K.rows(); ++i)
    if (std::abs(parts.eigenvalues()(i)) > 1e-14 * most) kept.push_back(i);
  const VectorXd values = parts.eigenvalues()(kept);
  const MatrixXd Q = unit.asDiagonal() * parts.eigenvectors()(Eigen::all, kept);
  LowRankPart part;
  part.U = X * SparseColumns(Q.sparseView(0, 0));
  part.W = values.asDiagonal();
  part.W_inverse = values.cwiseInverse().asDiagonal();
  part.num_positive = static_cast<int>((values.array() > 0).count());
  return part;
}

LowRankPart make_product_part(const SparseColumns& D, const SparseColumns& V, const MatrixXd& K) {
  std::vector<Eigen::Index> kept;
  std::vector<double> size;
  std::vector<Eigen::Triplet<double>> picks;
  for (Eigen::Index j = 0; j < K.rows(); ++j) {
    const double v = V.col(j).norm(), k = K.col(j).cwiseAbs().maxCoeff();
    if (v == 0 && k == 0) continue;
    picks.emplace_back(static_cast<int>(j), static_cast<int>(kept.size()), 1);
    kept.push_back(j);
    size.push_back(std::max(v, k));
  }
  const auto r = static_cast<Eigen::Index>(kept.size());
  SparseColumns pick(K.rows(), r);
  pick.setFromTriplets(picks.begin(), picks.end());
  const MatrixXd K_kept = K(kept, kept);
  const SparseColumns D_kept = D * pick, V_kept = V * pick;
  if (V_kept.nonZeros() == 0) return make_form_part(D_kept, K_kept);
  const VectorXd s = Eigen::Map<const VectorXd>(size.data(), r), inverse = s.cwiseInverse();
  LowRankPart part;
  part.U = join_columns(D_kept, V_kept * inverse.asDiagonal());
  part.W = part.W_inverse = MatrixXd::Zero(2 * r, 2 * r);
  part.W.topLeftCorner(r, r) = K_kept;
  part.W.topRightCorner(r, r).diagonal() = part.W.bottomLeftCorner(r, r).diagonal() = s;
  part.W_inverse.topRightCorner(r, r).diagonal() = part.W_inverse.bottomLeftCorner(r, r).diagonal() = inverse;
  part.W_inverse.bottomRightCorner(r, r) = -(inverse.asDiagonal() * K_kept * inverse.asDiagonal());
  part.num_positive = static_cast<int>(r);  // [K s; s 0] has as many of either sign
  return part;
}

LowRankPart join(const LowRankPart& a, double factor_a, const LowRankPart& b, double factor_b) {
  if (a.rank() == 0) return b.rank() == 0 ? b : multiply(b, factor_b);
  const LowRankPart x = multiply(a, factor_a);
  if (b.rank() == 0) return x;
  const LowRankPart y = multiply(b, factor_b);
  return {join_columns(x.U, y.U), join_diagonal(x.W, y.W), join_diagonal(x.W_inverse, y.W_inverse),
          x.num_positive + y.num_positive};
}

PetscMat make_sum(PetscMat sparse, LowRankPart part) {
  if (part.rank() == 0) return sparse;
  PetscInt local = 0, size = 0;
  check_petsc(MatGetLocalSize(sparse.get(), &local, nullptr));
  check_petsc(MatGetSize(sparse.get(), &size, nullptr));
  BOUGH_DEMAND(part.U.rows() == size);
  auto sum = std::make_unique<Sum>(Sum{std::move(sparse), std::move(part)});
  PetscMat A;
  check_petsc(MatCreateShell(PETSC_COMM_WORLD, local, local, size, size, sum.get(), A.out()));
  check_petsc(MatShellSetOperation(A.get(), MATOP_DESTROY, reinterpret_cast<void (*)()>(destroy_sum)));
  sum.release();
  // Scales and shifts of PETSc's own would be unseen here: without them it refuses both.
  check_petsc(MatShellSetManageScalingShifts(A.get()));
  check_petsc(MatShellSetOperation(A.get(), MATOP_MULT, reinterpret_cast<void (*)()>(multiply_sum)));
  check_petsc(MatShellSetOperation(A.get(), MATOP_MULT_TRANSPOSE, reinterpret_cast<void (*)()>(multiply_sum)));
  check_petsc(MatSetOption(A.get(), MAT_SYMMETRIC, PETSC_TRUE));
  check_petsc(MatSetUp(A.get()));
  return A;
}

Mat get_sparse(Mat A) {
  const Sum* sum = find_sum(A);
  return sum ? sum->sparse.get() : A;
}

const LowRankPart* find_low_rank(Mat A) {
  const Sum* sum = find_sum(A);
  return sum ? &sum->part : nullptr;
}

PetscMat copy(Mat A) { return make_sum(copy_sparse(get_sparse(A)), get_part(A)); }

PetscMat add(Mat A, double factor, Mat B) {
  PetscMat C = copy_sparse(get_sparse(A));
  if (factor == 0) return make_sum(std::move(C), get_part(A));
  check_petsc(MatAXPY(C.get(), factor, get_sparse(B), DIFFERENT_NONZERO_PATTERN));
  // Where the patterns differ the sum is another matrix, of which PETSc knows nothing.
  check_petsc(MatSetOption(C.get(), MAT_SYMMETRIC, PETSC_TRUE));
  copy_row_groups(get_sparse(A), C.get());
  return make_sum(std::move(C), join(get_part(A), 1, get_part(B), factor));
}

PetscMat add_diagonal(Mat A, const VectorXd& d) {
  PetscMat C = copy(A);
  PetscVec v;
  PetscInt first = 0, last = 0;
  check_petsc(MatCreateVecs(get_sparse(A), v.out(), nullptr));
  check_petsc(VecGetOwnershipRange(v.get(), &first, &last));
  PetscScalar* own = nullptr;
  check_petsc(VecGetArray(v.get(), &own));
  std::copy(d.data() + first, d.data() + last, own);
  check_petsc(VecRestoreArray(v.get(), &own));
  check_petsc(MatDiagonalSet(get_sparse(C.get()), v.get(), ADD_VALUES));
  return C;
}

PetscMat scale(Mat A, double factor) {
  PetscMat C = copy_sparse(get_sparse(A));
  check_petsc(MatScale(C.get(), factor));
  const auto& part = get_part(A);
  return make_sum(std::move(C), part.rank() > 0 ? multiply(part, factor) : part);
}

PetscMat take_kept(Mat A, const std::vector<int>& kept) {
  PetscMat sparse = take_kept_sparse(get_sparse(A), kept);
  const auto* part = find_low_rank(A);
  if (!part) return sparse;
  std::vector<int> row_of(static_cast<std::size_t>(part->U.rows()), -1);
  for (std::size_t i = 0; i < kept.size(); ++i) row_of[static_cast<std::size_t>(kept[i])] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index k = 0; k < part->U.outerSize(); ++k)
    for (SparseColumns::InnerIterator it(part->U, k); it; ++it)
      if (const int row = row_of[static_cast<std::size_t>(it.row())]; row >= 0)
        entries.emplace_back(row, static_cast<int>(k), it.value());
  LowRankPart kept_part = *part;
  kept_part.U.resize(static_cast<Eigen::Index>(kept.size()), part->rank());
  kept_part.U.setFromTriplets(entries.begin(), entries.end());
  return make_sum(std::move(sparse), std::move(kept_part));
}

}  // namespace bough::fe
