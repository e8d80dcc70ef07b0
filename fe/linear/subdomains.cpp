#include "fe/linear/subdomains.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "fe/linear/memory_need.hpp"
#include "fe/linear/own_entries.hpp"
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

/// Entries of rows one after the other.
struct Entries {
  std::vector<int> start{0}, column;
  std::vector<double> value;
  void end_row() { start.push_back(static_cast<int>(column.size())); }
};

/// A_ss on every rank, from the rows between that each has; columns count from the first of these. Collective.
Entries join_between(const OwnEntries& A, const Subdomains& domains, const std::vector<int>& place) {
  const PetscInt n_p = domains.num_inner();
  std::vector<int> nums;
  Entries own;
  for (PetscInt s = 0; s < domains.num_shared; ++s) {
    A.visit(domains.between[domains.first_shared + s], [&](PetscInt column, double value) {
      const int j = place[static_cast<std::size_t>(column)];
      if (j < n_p) return;
      own.column.push_back(j - n_p);
      own.value.push_back(value);
    });
    own.end_row();
    nums.push_back(own.start[static_cast<std::size_t>(s) + 1] - own.start[static_cast<std::size_t>(s)]);
  }
  // Rows between ascend with the rank: one after the other they are in order.
  Entries all;
  for (const int count : join_over_ranks(nums)) all.start.push_back(all.start.back() + count);
  all.column = join_over_ranks(own.column);
  all.value = join_over_ranks(own.value);
  return all;
}

/// Entry k of a row goes to order[k] in the order of its columns.
void sort_columns(const std::vector<int>& columns, std::vector<int>& order) {
  order.resize(columns.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return columns[a] < columns[b]; });
}

/// The rows of the symmetric matrix by inner, between, with ascending columns. Own rows of A alone are read.
Eigen::SparseMatrix<double, Eigen::RowMajor> collect_rows(const OwnEntries& A, const Subdomains& domains) {
  const PetscInt n_p = domains.num_inner(), n_s = domains.num_between();
  std::vector<int> place(static_cast<std::size_t>(domains.size), -1);
  for (PetscInt i = 0; i < n_p; ++i) place[static_cast<std::size_t>(domains.inner[i])] = i;
  for (PetscInt i = 0; i < n_s; ++i) place[static_cast<std::size_t>(domains.between[i])] = n_p + i;
  const Entries between = join_between(A, domains, place);

  // Of a row between: its entries in inner columns are those of the inner rows.
  std::vector<Entries> tails(static_cast<std::size_t>(n_s));
  Eigen::SparseMatrix<double, Eigen::RowMajor> rows(n_p + n_s, n_p + n_s);
  // As many as there can be: the tails repeat entries of own rows between, and those that others have.
  rows.resizeNonZeros(static_cast<Index>(A.num_entries()) + A.num_entries_of_others() +
                      static_cast<Index>(between.column.size()));
  int *start = rows.outerIndexPtr(), *column = rows.innerIndexPtr(), end = 0;
  double* value = rows.valuePtr();
  std::vector<int> columns, order;
  std::vector<double> values;
  start[0] = 0;
  PetscInt known = -1;
  for (PetscInt i = 0; i < n_p; ++i) {
    const PetscInt row = domains.inner[i];
    values.clear();
    if (known >= 0 && A.has_same_columns(row, known)) {
      A.visit(row, [&](PetscInt, double entry) { values.push_back(entry); });
    } else {
      columns.clear();
      A.visit(row, [&](PetscInt j, double entry) {
        columns.push_back(place[static_cast<std::size_t>(j)]);
        values.push_back(entry);
      });
      sort_columns(columns, order);
      BOUGH_DEMAND(columns.empty() || columns[order[0]] >= 0);  // inner rows of two ranks do not couple
    }
    known = row;
    for (const int k : order) {
      column[end] = columns[k];
      value[end++] = values[k];
    }
    start[i + 1] = end;
    for (int k = end; k > start[i] && column[k - 1] >= n_p; --k) {
      Entries& tail = tails[static_cast<std::size_t>(column[k - 1] - n_p)];
      tail.column.push_back(i);
      tail.value.push_back(value[k - 1]);
    }
  }
  for (PetscInt s = 0; s < n_s; ++s) {
    const Entries& tail = tails[static_cast<std::size_t>(s)];
    std::copy(tail.column.begin(), tail.column.end(), column + end);
    std::copy(tail.value.begin(), tail.value.end(), value + end);
    end += static_cast<int>(tail.column.size());
    columns.assign(between.column.begin() + between.start[s], between.column.begin() + between.start[s + 1]);
    sort_columns(columns, order);
    for (const int k : order) {
      column[end] = n_p + columns[k];
      value[end++] = between.value[static_cast<std::size_t>(between.start[s] + k)];
    }
    start[n_p + s + 1] = end;
  }
  rows.resizeNonZeros(end);
  return rows;
}

}  // namespace

SubdomainMatrix::SubdomainMatrix(Mat A, const Subdomains& domains) : domains_(domains) {
  if (domains.by_parts) {
    rows_ = collect_rows(OwnEntries(A), domains);
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
      delta = calc_separator_shift(as_rows, between, size);
      is_fine = part_->analyse(as_rows, size, std::move(own), between, delta, world.size);
    });
  }
  if (!are_all(is_fine)) return;
  // The block of the rows between is there twice more while it is taken out.
  require_memory_of_ranks(domains.num_inner() + domains.num_between(),
                          part_->num_entries() + 2.0 * domains.num_between() * domains.num_between(), no_memory);
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
