#include "fe/linear/part_factor.hpp"

#include <petscblaslapack.h>

#include <algorithm>
#include <cmath>

extern "C" void dlauum_(const char* part, const PetscBLASInt* n, double* A, const PetscBLASInt* lda,
                        PetscBLASInt* info);

namespace bough::linear {

using Eigen::MatrixXd;
using Eigen::VectorXd;

void PartFactor::take(const MatrixRows& A, const std::vector<PetscInt>& rows, std::size_t num_own,
                      const VectorXd& delta, double share) {
  const std::vector<int> place = number_rows(rows);
  const auto last = static_cast<PetscInt>(place.size()) - 1;
  start_.assign(1, 0);
  row_.clear();
  value_.clear();
  std::size_t max_entries = rows.size();  // of the lower triangle
  for (const PetscInt row : rows) max_entries += static_cast<std::size_t>(A.start[row + 1] - A.start[row]);
  row_.reserve(max_entries / 2);
  value_.reserve(max_entries / 2);
  for (std::size_t j = 0; j < rows.size(); ++j) {
    const bool is_between = j >= num_own;
    for (PetscInt k = A.start[rows[j]]; k < A.start[rows[j] + 1]; ++k) {
      const int i = A.column[k] <= last ? place[static_cast<std::size_t>(A.column[k])] : -1;
      if (i < static_cast<int>(j)) continue;  // of the other part, or above the diagonal
      const bool is_diagonal = i == static_cast<int>(j);
      row_.push_back(i);
      value_.push_back(is_between ? share * A.value[k] + (is_diagonal ? delta(i - static_cast<int>(num_own)) : 0.0)
                                  : A.value[k]);
    }
    start_.push_back(static_cast<int>(row_.size()));
  }
}

bool PartFactor::analyse(const MatrixRows& A, PetscInt size, std::vector<PetscInt> own,
                         const std::vector<PetscInt>& between, const VectorXd& delta, int num_parts) {
  const auto n_p = static_cast<int>(own.size());
  own.insert(own.end(), between.begin(), between.end());
  std::vector<PetscInt> rows;
  rows.reserve(own.size());
  const std::vector<int> order = calc_postorder({&A}, size, own);
  for (const int i : order)
    if (i < n_p) rows.push_back(own[static_cast<std::size_t>(i)]);
  rows_ = rows;
  between_.clear();
  for (const int i : order)
    if (i >= n_p) {
      between_.push_back(i - n_p);
      rows.push_back(own[static_cast<std::size_t>(i)]);
    }
  take(A, rows, rows_.size(), delta(between_), 1.0 / num_parts);
  num_between_ = static_cast<Eigen::Index>(between.size());
  cholmod_sparse matrix = view_lower(start_, row_, value_.data());
  factor_ = cholmod_analyze(&matrix, &common_);
  check_cholmod(common_.status);
  if (!factor_ || !factor_->is_super) return false;
  const int* order_taken = static_cast<const int*>(factor_->Perm);
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (order_taken[i] != static_cast<int>(i)) return false;
  return true;
}

bool PartFactor::factor() {
  cholmod_sparse matrix = view_lower(start_, row_, value_.data());
  cholmod_factorize(&matrix, factor_, &common_);
  check_cholmod(common_.status);
  start_ = std::vector<int>();  // {} would keep the memory
  row_ = std::vector<int>();
  value_ = std::vector<double>();
  if (common_.status != CHOLMOD_OK || factor_->minor < factor_->n) return false;
  pack();
  return true;
}

void PartFactor::pack() {
  const auto n_p = static_cast<int>(rows_.size());
  const int* super = static_cast<const int*>(factor_->super);
  const int* value_at = static_cast<const int*>(factor_->px);
  auto* value = static_cast<double*>(factor_->x);
  const auto num = static_cast<int>(factor_->nsuper);
  const auto num_own = static_cast<int>(std::lower_bound(super, super + num, n_p) - super);  // some with both kinds
  supernodes_ = {num_own, n_p, super, static_cast<const int*>(factor_->pi), static_cast<const int*>(factor_->s)};
  L_ss_ = MatrixXd::Zero(num_between_, num_between_);
  for (int k = 0; k < num; ++k) {
    const int* row = supernodes_.row + supernodes_.row_at[k];
    const int num_rows = supernodes_.row_at[k + 1] - supernodes_.row_at[k];
    for (int j = std::max(super[k], n_p); j < super[k + 1]; ++j)
      for (int i = j - super[k]; i < num_rows; ++i)
        L_ss_(row[i] - n_p, j - n_p) = value[value_at[k] + static_cast<std::ptrdiff_t>(j - super[k]) * num_rows + i];
  }
  supernodes_.num_values = pack_supernodes(supernodes_, value_at, value);
  factor_->x = cholmod_realloc(static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, supernodes_.num_values)),
                               sizeof(double), factor_->x, &factor_->xsize, &common_);
  supernodes_.value = static_cast<const double*>(factor_->x);
}

MatrixXd PartFactor::take_schur() {
  // LAPACK multiplies U Uᵀ alone, a sixth of a product of dense matrices: L read from its end.
  MatrixXd schur = L_ss_.reverse();
  L_ss_.resize(0, 0);
  const auto n = static_cast<PetscBLASInt>(num_between_);
  PetscBLASInt info = 0;
  if (n > 0) dlauum_("U", &n, schur.data(), &n, &info);
  schur.triangularView<Eigen::StrictlyLower>() = schur.transpose();
  MatrixXd sorted(n, n);
  sorted(between_, between_) = schur.reverse();
  return sorted;
}

void PartFactor::forward(const Eigen::Ref<const MatrixXd>& B, MatrixXd& carried) {
  const auto n_p = static_cast<Eigen::Index>(rows_.size()), n_s = num_between_, m = B.cols();
  Z_.resize(m <= kNarrowRhs ? kNarrowRhs : kWideRhs, n_p + n_s);
  for (Eigen::Index i = 0; i < n_p; ++i) {
    double* z = Z_.col(i).data();
    const double* b = B.data() + rows_[static_cast<std::size_t>(i)];
    for (Eigen::Index c = 0; c < m; ++c) z[c] = b[c * B.outerStride()];
    std::fill(z + m, z + Z_.rows(), 0.0);
  }
  Z_.rightCols(n_s).setZero();
  solve_lower(supernodes_, Z_);
  carried.resize(Z_.rows(), n_s);
  carried(Eigen::all, between_) = -Z_.rightCols(n_s);
}

void PartFactor::backward(const MatrixXd& X_s, Eigen::Ref<MatrixXd> X) {
  const auto n_p = static_cast<Eigen::Index>(rows_.size());
  Z_.rightCols(num_between_) = X_s(Eigen::all, between_);
  solve_lower_transposed(supernodes_, Z_);
  for (Eigen::Index i = 0; i < n_p; ++i) {
    const double* z = Z_.col(i).data();
    double* x = X.data() + rows_[static_cast<std::size_t>(i)];
    for (Eigen::Index c = 0; c < X.cols(); ++c) x[c * X.outerStride()] = z[c];
  }
}

bool factor_dense(MatrixXd& S) {
  const auto n = static_cast<PetscBLASInt>(S.rows());
  PetscBLASInt info = 0;
  if (n > 0) LAPACKpotrf_("L", &n, S.data(), &n, &info);
  return info == 0;
}

void solve_dense(const MatrixXd& L, MatrixXd& X) {
  const auto n = static_cast<PetscBLASInt>(L.rows()), m = static_cast<PetscBLASInt>(X.cols());
  PetscBLASInt info = 0;
  if (n > 0 && m > 0) LAPACKpotrs_("L", &n, &m, L.data(), &n, X.data(), &n, &info);
}

VectorXd calc_separator_shift(const MatrixRows& A, const std::vector<PetscInt>& rows, PetscInt size) {
  VectorXd root = VectorXd::Zero(size);  // of the diagonal, at `rows`
  for (const PetscInt row : rows)
    for (PetscInt k = A.start[row]; k < A.start[row + 1]; ++k)
      if (A.column[k] == row && A.value[k] > 0) root(row) = std::sqrt(A.value[k]);
  VectorXd shift = VectorXd::Zero(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    double sum = 0;
    for (PetscInt k = A.start[rows[i]]; k < A.start[rows[i] + 1]; ++k)
      if (const double r = root(A.column[k]); r > 0) sum += std::abs(A.value[k]) / r;
    shift(static_cast<Eigen::Index>(i)) = root(rows[i]) * sum;
  }
  return shift;
}

}  // namespace bough::linear
