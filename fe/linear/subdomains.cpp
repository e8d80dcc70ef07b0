#include "fe/linear/subdomains.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "fe/linear/memory_need.hpp"
#include "fe/linear/part_factor.hpp"
#include "fe/linear/ranks.hpp"

namespace bough::fe {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd Subdomains::take_own(const Eigen::Ref<const MatrixXd>& X) const {
  MatrixXd own(num_own(), X.cols());
  for (Index c = 0; c < X.cols(); ++c)
    for (PetscInt i = 0; i < num_own(); ++i) own(i, c) = X(get_row(i), c);
  return own;
}

MatrixXd Subdomains::replicate(const MatrixXd& own) const {
  MatrixXd X = MatrixXd::Zero(size, own.cols());
  for (Index c = 0; c < own.cols(); ++c)
    for (PetscInt i = 0; i < num_own(); ++i) X(get_row(i), c) = own(i, c);
  sum_over_ranks(X);
  return X;
}

MatrixXd Subdomains::from_rows(const Eigen::Ref<const MatrixXd>& X) const {
  if (!by_parts) return take_own(X);
  const PetscInt first = find_first_row();
  MatrixXd own(num_own(), X.cols());
  for (Index c = 0; c < X.cols(); ++c)
    for (PetscInt i = 0; i < num_own(); ++i) own(i, c) = X(get_row(i) - first, c);
  return own;
}

MatrixXd Subdomains::to_rows(const MatrixXd& own) const {
  if (!by_parts) return replicate(own);
  const PetscInt first = find_first_row();
  MatrixXd X(own.rows(), own.cols());
  for (Index c = 0; c < own.cols(); ++c)
    for (PetscInt i = 0; i < num_own(); ++i) X(get_row(i) - first, c) = own(i, c);
  return X;
}

PetscInt Subdomains::find_first_row() const {
  PetscInt first = num_own() > 0 ? get_row(0) : 0;
  for (PetscInt i = 0; i < num_own(); ++i) first = std::min(first, get_row(i));
  return first;
}

namespace {

/// Entries with their columns among the rows inner, between.
struct Entries {
  std::vector<int> start{0}, column;
  std::vector<double> value;
};

/// Of the inner rows, in their order, and on every rank of those between, with columns that count from the first of
/// these.
struct RowsOfPart {
  Entries inner, between;
};

/// Own rows of A alone are read; of those between every rank gets what others have.
RowsOfPart read_own_rows(Mat A, const Subdomains& domains) {
  std::vector<int> place(static_cast<std::size_t>(domains.size), -1);
  const PetscInt n_p = domains.num_inner();
  for (PetscInt i = 0; i < n_p; ++i) place[static_cast<std::size_t>(domains.inner[i])] = i;
  for (PetscInt i = 0; i < domains.num_between(); ++i) place[static_cast<std::size_t>(domains.between[i])] = n_p + i;
  PetscInt num = 0;
  const PetscInt* columns = nullptr;
  const PetscScalar* values = nullptr;
  RowsOfPart rows;
  MatInfo info;
  check_petsc(MatGetInfo(A, MAT_LOCAL, &info));
  rows.inner.column.reserve(static_cast<std::size_t>(info.nz_used));
  rows.inner.value.reserve(static_cast<std::size_t>(info.nz_used));
  for (const PetscInt row : domains.inner) {
    check_petsc(MatGetRow(A, row, &num, &columns, &values));
    for (PetscInt k = 0; k < num; ++k) {
      const int j = place[static_cast<std::size_t>(columns[k])];
      BOUGH_DEMAND(j >= 0);  // inner rows of two ranks do not couple
      rows.inner.column.push_back(j);
      rows.inner.value.push_back(values[k]);
    }
    check_petsc(MatRestoreRow(A, row, &num, &columns, &values));
    rows.inner.start.push_back(static_cast<int>(rows.inner.column.size()));
  }
  std::vector<int> nums, own_columns;
  std::vector<double> own_values;
  for (PetscInt s = 0; s < domains.num_shared; ++s) {
    const PetscInt row = domains.between[domains.first_shared + s];
    check_petsc(MatGetRow(A, row, &num, &columns, &values));
    int count = 0;
    for (PetscInt k = 0; k < num; ++k)
      if (const int j = place[static_cast<std::size_t>(columns[k])]; j >= n_p) {
        own_columns.push_back(j - n_p);
        own_values.push_back(values[k]);
        ++count;
      }
    check_petsc(MatRestoreRow(A, row, &num, &columns, &values));
    nums.push_back(count);
  }
  // Rows between ascend with the rank: one after the other they are in order.
  for (const int count : join_over_ranks(nums)) rows.between.start.push_back(rows.between.start.back() + count);
  rows.between.column = join_over_ranks(own_columns);
  rows.between.value = join_over_ranks(own_values);
  return rows;
}

/// Rows of the symmetric matrix with ascending columns, without sorting: row i has what the rows before have in
/// column i.
Eigen::SparseMatrix<double, Eigen::RowMajor> merge(const RowsOfPart& rows, Index n_p, Index n_s) {
  std::vector<int> count(static_cast<std::size_t>(n_p + n_s), 0);
  const auto tail = [&](Index i) {  // of an inner row, in columns between
    std::vector<std::pair<int, double>> entries;
    for (int k = rows.inner.start[i]; k < rows.inner.start[i + 1]; ++k)
      if (rows.inner.column[k] >= n_p) entries.emplace_back(rows.inner.column[k], rows.inner.value[k]);
    std::sort(entries.begin(), entries.end());
    return entries;
  };
  for (Index i = 0; i < n_p; ++i)
    for (int k = rows.inner.start[i]; k < rows.inner.start[i + 1]; ++k) {
      ++count[static_cast<std::size_t>(rows.inner.column[k])];
      if (rows.inner.column[k] >= n_p) ++count[static_cast<std::size_t>(i)];
    }
  for (const int column : rows.between.column) ++count[static_cast<std::size_t>(n_p + column)];
  Eigen::SparseMatrix<double, Eigen::RowMajor> A(n_p + n_s, n_p + n_s);
  std::vector<int> next(count.size() + 1, 0);
  std::partial_sum(count.begin(), count.end(), next.begin() + 1);
  A.resizeNonZeros(next.back());
  std::copy(next.begin(), next.end(), A.outerIndexPtr());
  const auto put = [&](Index row, Index column, double value) {
    const int at = next[static_cast<std::size_t>(row)]++;
    A.innerIndexPtr()[at] = static_cast<int>(column);
    A.valuePtr()[at] = value;
  };
  for (Index i = 0; i < n_p; ++i)
    for (int k = rows.inner.start[i]; k < rows.inner.start[i + 1]; ++k)
      put(rows.inner.column[k], i, rows.inner.value[k]);
  for (Index i = 0; i < n_p; ++i)
    if (next[static_cast<std::size_t>(i)] < A.outerIndexPtr()[i + 1])  // few are next to the cut
      for (const auto& [column, value] : tail(i)) put(i, column, value);
  for (Index s = 0; s < n_s; ++s)
    for (int k = rows.between.start[s]; k < rows.between.start[s + 1]; ++k)
      put(n_p + rows.between.column[k], n_p + s, rows.between.value[k]);
  return A;
}

}  // namespace

SubdomainMatrix::SubdomainMatrix(Mat A, const Subdomains& domains) : domains_(domains) {
  if (domains.by_parts) {
    rows_ = merge(read_own_rows(A, domains), domains.num_inner(), domains.num_between());
    return;
  }
  std::vector<PetscInt> rows = domains.inner;
  rows.insert(rows.end(), domains.between.begin(), domains.between.end());
  std::vector<int> order(rows.size()), place(rows.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return rows[a] < rows[b]; });
  std::vector<PetscInt> ascending;
  for (const int i : order) ascending.push_back(rows[i]);
  for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<int>(i);
  PetscIs wanted;
  const auto n = static_cast<PetscInt>(rows.size());
  check_petsc(ISCreateGeneral(PETSC_COMM_SELF, n, ascending.data(), PETSC_COPY_VALUES, wanted.out()));
  IS is = wanted.get();
  Mat* sub = nullptr;
  check_petsc(MatCreateSubMatrices(A, 1, &is, &is, MAT_INITIAL_MATRIX, &sub));
  rows_.resize(n, n);
  PetscInt num = 0;
  const PetscInt* columns = nullptr;
  const PetscScalar* values = nullptr;
  MatInfo info;
  check_petsc(MatGetInfo(sub[0], MAT_LOCAL, &info));
  rows_.reserve(static_cast<Index>(info.nz_used));
  std::vector<std::pair<int, double>> entries;
  for (PetscInt i = 0; i < n; ++i) {
    check_petsc(MatGetRow(sub[0], place[i], &num, &columns, &values));
    entries.clear();
    for (PetscInt k = 0; k < num; ++k) entries.emplace_back(order[columns[k]], values[k]);
    check_petsc(MatRestoreRow(sub[0], place[i], &num, &columns, &values));
    std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    rows_.startVec(i);
    for (const auto& [column, value] : entries) rows_.insertBack(i, column) = value;
  }
  rows_.finalize();
  check_petsc(MatDestroySubMatrices(1, &sub));
  // Nothing of A couples inner rows of two ranks: each of its entries is with one rank, those of A_ss with all.
  const Index n_p = domains.num_inner(), n_s = domains.num_between();
  const double between = static_cast<double>(rows_.bottomRightCorner(n_s, n_s).eval().nonZeros());
  double held = static_cast<double>(rows_.nonZeros()) - between;
  MPI_Allreduce(MPI_IN_PLACE, &held, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  check_petsc(MatGetInfo(A, MAT_GLOBAL_SUM, &info));
  BOUGH_DEMAND(n_p + n_s == n && held + between == info.nz_used);
}

MatrixXd SubdomainMatrix::multiply(const Eigen::Ref<const MatrixXd>& X) const {
  const Index n_p = domains_.num_inner(), n_s = domains_.num_between(), m = X.cols();
  const Index first = domains_.first_shared, num = domains_.num_shared;
  MatrixXd X_s = MatrixXd::Zero(n_s, m);
  X_s.middleRows(first, num) = X.bottomRows(num);
  sum_over_ranks(X_s);
  MatrixXd Y(n_p + num, m), Y_s(n_s, m);
  const int *start = rows_.outerIndexPtr(), *column = rows_.innerIndexPtr();
  const double* value = rows_.valuePtr();
  constexpr Index kAtOnce = 4;
  for (Index c = 0; c < m; c += kAtOnce) {
    const Index sides = std::min(kAtOnce, m - c);
    const double *x[kAtOnce], *x_s[kAtOnce];
    for (Index r = 0; r < kAtOnce; ++r) {
      x[r] = X.data() + (c + std::min(r, sides - 1)) * X.outerStride();
      x_s[r] = X_s.data() + (c + std::min(r, sides - 1)) * n_s;
    }
    double sum[kAtOnce];
    for (Index i = 0; i < n_p + n_s; ++i) {
      std::fill(sum, sum + kAtOnce, 0.0);
      for (int k = start[i]; k < start[i + 1]; ++k) {
        const Index j = column[k];
        if (j < n_p)
          for (Index r = 0; r < kAtOnce; ++r) sum[r] += value[k] * x[r][j];
        else if (i < n_p || (j - n_p >= first && j - n_p < first + num))  // A_ss is shared out by columns
          for (Index r = 0; r < kAtOnce; ++r) sum[r] += value[k] * x_s[r][j - n_p];
      }
      for (Index r = 0; r < sides; ++r) (i < n_p ? Y(i, c + r) : Y_s(i - n_p, c + r)) = sum[r];
    }
  }
  sum_over_ranks(Y_s);
  Y.bottomRows(num) = Y_s.middleRows(first, num);
  return Y;
}

void require_memory_of_ranks(double num_rows, double num_entries, const ComputationError& otherwise) {
  // Ranks of one machine share its memory.
  double need[2] = {num_rows, num_entries};
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(PETSC_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  MPI_Allreduce(MPI_IN_PLACE, need, 2, MPI_DOUBLE, MPI_SUM, machine);
  MPI_Comm_free(&machine);
  do_on_all(otherwise, [&] {
    release_freed_memory();
    require_memory(need[0], need[1], calc_free_memory());
  });
}

SubdomainFactor::SubdomainFactor(Mat A, const Subdomains& domains)
    : domains_(domains), part_(std::make_unique<PartFactor>()) {
  const MpiWorld world = initialize_petsc();
  std::vector<PetscInt> own(domains.inner.size()), between(domains.between.size());
  std::iota(own.begin(), own.end(), 0);
  std::iota(between.begin(), between.end(), domains.num_inner());
  VectorXd delta;
  bool is_fine = false;
  const ComputationError no_memory = make_out_of_memory();
  {
    const SubdomainMatrix matrix(A, domains);
    const auto& rows = matrix.rows();
    const MatrixRows as_rows{rows.outerIndexPtr(), rows.innerIndexPtr(), rows.valuePtr()};
    do_on_all(no_memory, [&] {
      const auto size = static_cast<PetscInt>(rows.rows());
      delta = calc_row_sums(as_rows, between, size);
      is_fine = part_->analyse(as_rows, size, std::move(own), between, delta, world.size);
    });
  }
  if (!are_all(is_fine)) return;
  require_memory_of_ranks(domains.num_inner() + domains.num_between(), part_->num_entries(), no_memory);
  do_on_all(no_memory, [&] {
    is_fine = part_->factor();
    if (is_fine) L_ = part_->take_schur();
  });
  if (!are_all(is_fine)) return;
  sum_alike(L_);
  L_.diagonal() -= world.size * delta;
  is_definite_ = are_all(factor_dense(L_));
}

SubdomainFactor::~SubdomainFactor() = default;

MatrixXd SubdomainFactor::solve(const Eigen::Ref<const MatrixXd>& B) const {
  const Index n_p = domains_.num_inner(), n_s = domains_.num_between();
  const Index first_own = domains_.first_shared, num_own = domains_.num_shared;
  MatrixXd X(B.rows(), B.cols()), carried;
  for (Index first = 0; first < B.cols(); first += kManySides) {
    const Index m = std::min(kManySides, B.cols() - first);
    const auto B_block = B.middleCols(first, m);
    auto X_block = X.middleCols(first, m);
    part_->forward(B_block, carried);
    MatrixXd X_s = -carried.topRows(m).transpose();
    X_s.middleRows(first_own, num_own) += B_block.bottomRows(num_own);
    sum_over_ranks(X_s);
    solve_dense(L_, X_s);
    X_block.bottomRows(num_own) = X_s.middleRows(first_own, num_own);
    MatrixXd x_s = MatrixXd::Zero(carried.rows(), n_s);
    x_s.topRows(m) = X_s.transpose();
    part_->backward(x_s, X_block.topRows(n_p));
  }
  return X;
}

}  // namespace bough::fe
