#include "fe/linear/part_fronts.hpp"

#include "fe/linear/fronts.hpp"

extern "C" void dsytrs2_(const char* uplo, const PetscBLASInt* n, const PetscBLASInt* num_sides, double* A,
                         const PetscBLASInt* lda, const PetscBLASInt* pivots, double* B, const PetscBLASInt* ldb,
                         double* work, PetscBLASInt* info);

namespace bough::linear {
namespace {

/// Largest growth of a diagonal entry in a front, relative to its value in the matrices. LLᵀ of a definite matrix
/// subtracts at most that value; a factor of 100 costs two digits of sixteen.
constexpr double kMaxGrowth = 100;

/// Number of negative pivots of LDLᵀ in the form of LAPACK's sytrf.
int count_negative_pivots(const double* D, PetscBLASInt n, const PetscBLASInt* order) {
  int negative = 0;
  for (PetscBLASInt j = 0; j < n; ++j) {
    const bool is_pair = order[j] < 0;  // of one eigenvalue of each sign
    if (is_pair || D[static_cast<std::ptrdiff_t>(j) * (n + 1)] < 0) ++negative;
    if (is_pair) ++j;
  }
  return negative;
}

}  // namespace

using Eigen::MatrixXd;
using Eigen::VectorXd;

ComputationError make_no_memory_for_count() {
  return {"fe.out-of-memory",
          {},
          "a factor for the count of the modes does not fit the memory",
          "omit the count (--no-check)"};
}

bool PartFronts::take(const RowSum& sum, const std::vector<PetscInt>& rows) {
  const std::vector<int> place = number_rows(rows);
  const auto last = static_cast<PetscInt>(place.size()) - 1;
  start_.assign(1, 0);
  row_of_entry_.clear();
  value_.clear();
  diagonal_.resize(static_cast<Eigen::Index>(rows.size()));
  bool is_closed = true;
  for (int j = 0; j < static_cast<int>(rows.size()); ++j) {
    const bool is_own = j < static_cast<int>(num_own_);
    sum.visit(rows[static_cast<std::size_t>(j)], [&](PetscInt column, double value) {
      const int i = column <= last ? place[static_cast<std::size_t>(column)] : -1;
      if (i < 0) {
        is_closed = is_closed && !is_own;
        return;
      }
      if (i < j) return;
      row_of_entry_.push_back(i);
      value_.push_back(value);
    });
    start_.push_back(static_cast<int>(row_of_entry_.size()));
    diagonal_(j) = sum.calc_size(rows[static_cast<std::size_t>(j)]);
  }
  return is_closed;
}

bool PartFronts::analyse(const RowSum& sum, const std::vector<PetscInt>& own, const std::vector<PetscInt>& between) {
  num_own_ = own.size();
  std::vector<PetscInt> rows;
  rows.reserve(num_own_ + between.size());
  for (const int i : calc_postorder({&sum.A, &sum.B}, sum.size, own)) rows.push_back(own[static_cast<std::size_t>(i)]);
  rows.insert(rows.end(), between.begin(), between.end());
  if (!take(sum, rows)) return false;
  cholmod_sparse matrix = view_lower(start_, row_of_entry_, nullptr);
  factor_ = cholmod_analyze(&matrix, &common_);
  check();
  if (!factor_ || !factor_->is_super) return false;
  const int* order = static_cast<const int*>(factor_->Perm);
  for (int i = 0; i < static_cast<int>(rows.size()); ++i)
    if (order[i] != i) return false;

  super_ = static_cast<const int*>(factor_->super);
  row_at_ = static_cast<const int*>(factor_->pi);
  row_ = static_cast<const int*>(factor_->s);
  std::vector<int> front_of(rows.size());
  for (int k = 0; k < static_cast<int>(factor_->nsuper); ++k)
    for (int j = super_[k]; j < super_[k + 1]; ++j) front_of[static_cast<std::size_t>(j)] = k;
  while (num_fronts_ < static_cast<int>(factor_->nsuper) && super_[num_fronts_] < static_cast<int>(num_own_))
    ++num_fronts_;
  // Children precede their parents, so their contribution blocks are on top of the stack.
  num_children_.assign(static_cast<std::size_t>(num_fronts_), 0);
  std::vector<double> left;
  double stack = 0;
  for (int k = 0; k < num_fronts_; ++k) {
    const int num = get_num_columns(k), num_rows = get_num_rows(k), num_left = num_rows - num;
    most_rows_ = std::max(most_rows_, num_rows);
    most_columns_ = std::max(most_columns_, num);
    for (int c = 0; c < num_children_[static_cast<std::size_t>(k)]; ++c) {
      if (left.empty()) return false;
      stack -= left.back();
      left.pop_back();
    }
    if (num_left == 0) continue;
    const int next = row_[row_at_[k] + num];
    if (next >= static_cast<int>(num_own_)) continue;  // goes to the separator rows
    const int above = front_of[static_cast<std::size_t>(next)];
    ++num_children_[static_cast<std::size_t>(above)];
    left.push_back(0.5 * num_left * (num_left + 1.0));
    stack += left.back();
    most_stack_ = std::max(most_stack_, stack);
  }
  return left.empty();
}

void FrontElimination::reserve(int num_columns) {
  const auto n = static_cast<std::size_t>(num_columns);
  if (n <= pivot_order_.size()) return;
  pivots_.resize(n * n);
  pivot_order_.resize(n);
  work_.resize(n * 64 + 64);
}

int FrontElimination::eliminate(double* F, PetscBLASInt ld, int num, int num_rows) {
  reserve(num);
  const PetscBLASInt n = num, m = num_rows - num;
  const double one = 1, minus = -1;
  double *below = F + num, *left = below + static_cast<std::ptrdiff_t>(num) * ld;
  PetscBLASInt info = 0;
  for (int j = 0; j < num; ++j)
    std::copy_n(F + j + static_cast<std::ptrdiff_t>(j) * ld, num - j,
                pivots_.data() + j + static_cast<std::ptrdiff_t>(j) * num);
  change.resize(m);
  for (int i = 0; i < m; ++i) change(i) = left[i + static_cast<std::ptrdiff_t>(i) * ld];
  int negative = 0;
  LAPACKpotrf_("L", &n, F, &ld, &info);
  if (info == 0) {
    if (m == 0) return 0;
    BLAStrsm_("R", "L", "T", "N", &m, &n, &one, F, &ld, below, &ld);
    BLASsyrk_("L", "N", &m, &n, &minus, below, &ld, &one, left, &ld);
  } else {
    PetscBLASInt size = static_cast<PetscBLASInt>(work_.size());
    LAPACKsytrf_("L", &n, pivots_.data(), &n, pivot_order_.data(), work_.data(), &size, &info);
    if (info != 0) return -1;
    negative = count_negative_pivots(pivots_.data(), n, pivot_order_.data());
    if (m == 0) return negative;
    right_.resize(static_cast<std::size_t>(num) * static_cast<std::size_t>(m));
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < num; ++j)
        right_[static_cast<std::size_t>(i) * static_cast<std::size_t>(num) + static_cast<std::size_t>(j)] =
            below[i + static_cast<std::ptrdiff_t>(j) * ld];
    dsytrs2_("L", &n, &m, pivots_.data(), &n, pivot_order_.data(), right_.data(), &n, work_.data(), &info);
    // Update by blocks of columns, the lower triangle only.
    constexpr int kColumns = 64;
    for (int first = 0; first < m; first += kColumns) {
      const PetscBLASInt width = std::min(kColumns, m - first), height = m - first;
      BLASgemm_("N", "N", &height, &width, &n, &minus, below + first, &ld,
                right_.data() + static_cast<std::ptrdiff_t>(first) * num, &n, &one,
                left + first + static_cast<std::ptrdiff_t>(first) * ld, &ld);
    }
  }
  for (int i = 0; i < m; ++i) change(i) = std::abs(left[i + static_cast<std::ptrdiff_t>(i) * ld] - change(i));
  return negative;
}

int PartFronts::eliminate(int num, int num_rows, const int* rows) {
  const int negative = elimination_.eliminate(front_.data(), num_rows, num, num_rows);
  for (int i = 0; i < num_rows - num && negative >= 0; ++i)
    if (!(elimination_.change(i) <= kMaxGrowth * diagonal_(rows[num + i]))) return -1;
  return negative;
}

int PartFronts::count(MatrixXd& schur) {
  const auto n_s = diagonal_.size() - static_cast<Eigen::Index>(num_own_);
  schur = MatrixXd::Zero(n_s, n_s);
  front_.resize(static_cast<std::size_t>(most_rows_) * static_cast<std::size_t>(most_rows_));
  elimination_.reserve(most_columns_);
  std::vector<double> stack(static_cast<std::size_t>(most_stack_));
  std::size_t top = 0;
  std::vector<int> waiting;  // fronts whose remainders are on the stack
  std::vector<int> place(static_cast<std::size_t>(diagonal_.size()), -1);
  int negative = 0;
  for (int k = 0; k < num_fronts_; ++k) {
    const int num = get_num_columns(k), num_rows = get_num_rows(k), num_left = num_rows - num;
    const int* rows = row_ + row_at_[k];
    for (int i = 0; i < num_rows; ++i) place[static_cast<std::size_t>(rows[i])] = i;
    for (int j = 0; j < num_rows; ++j)
      std::fill_n(front_.data() + j + static_cast<std::ptrdiff_t>(j) * num_rows, num_rows - j, 0.0);
    for (int j = 0; j < num; ++j) {
      double* column = front_.data() + static_cast<std::ptrdiff_t>(j) * num_rows;
      for (int e = start_[static_cast<std::size_t>(super_[k] + j)];
           e < start_[static_cast<std::size_t>(super_[k] + j + 1)]; ++e)
        column[place[static_cast<std::size_t>(row_of_entry_[static_cast<std::size_t>(e)])]] +=
            value_[static_cast<std::size_t>(e)];
    }
    for (int c = 0; c < num_children_[static_cast<std::size_t>(k)]; ++c) {
      const int child = waiting.back(), first = get_num_columns(child), height = get_num_rows(child) - first;
      const int* child_rows = row_ + row_at_[child] + first;
      waiting.pop_back();
      top -= static_cast<std::size_t>(height) * static_cast<std::size_t>(height + 1) / 2;
      const double* x = stack.data() + top;
      for (int j = 0; j < height; ++j) {
        double* column =
            front_.data() + static_cast<std::ptrdiff_t>(place[static_cast<std::size_t>(child_rows[j])]) * num_rows;
        for (int i = j; i < height; ++i) column[place[static_cast<std::size_t>(child_rows[i])]] += *x++;
      }
    }
    const int own = eliminate(num, num_rows, rows);
    if (own < 0) return -1;
    negative += own;
    if (num_left == 0) continue;
    const double* left = front_.data() + num + static_cast<std::ptrdiff_t>(num) * num_rows;
    if (rows[num] >= static_cast<int>(num_own_)) {
      for (int j = 0; j < num_left; ++j)
        for (int i = j; i < num_left; ++i)
          schur(rows[num + i] - static_cast<int>(num_own_), rows[num + j] - static_cast<int>(num_own_)) +=
              left[i + static_cast<std::ptrdiff_t>(j) * num_rows];
      continue;
    }
    for (int j = 0; j < num_left; ++j) {
      std::copy_n(left + j + static_cast<std::ptrdiff_t>(j) * num_rows, num_left - j, stack.data() + top);
      top += static_cast<std::size_t>(num_left - j);
    }
    waiting.push_back(k);
  }
  return negative;
}

namespace {

/// Block by block with pivots of each alone, nearly all by products; -1 where one is too small.
int count_by_blocks(MatrixXd S) {
  constexpr int kColumns = 96;
  const auto n = static_cast<int>(S.rows());
  const VectorXd size = S.diagonal().cwiseAbs();
  FrontElimination elimination;
  int negative = 0;
  for (int first = 0; first < n; first += kColumns) {
    const int num = std::min(kColumns, n - first);
    const int own = elimination.eliminate(&S(first, first), n, num, n - first);
    if (own < 0) return -1;
    negative += own;
    for (int i = first + num; i < n; ++i)
      if (!(elimination.change(i - first - num) <= kMaxGrowth * size(i))) return -1;
  }
  return negative;
}

}  // namespace

int count_negative_of_dense(MatrixXd& S) {
  const auto n = static_cast<PetscBLASInt>(S.rows());
  if (n == 0) return 0;
  if (const int negative = count_by_blocks(S); negative >= 0) return negative;
  std::vector<PetscBLASInt> order(static_cast<std::size_t>(n));
  PetscBLASInt size = 64 * n, info = 0;
  std::vector<double> work(static_cast<std::size_t>(size));
  LAPACKsytrf_("L", &n, S.data(), &n, order.data(), work.data(), &size, &info);
  return info != 0 ? -1 : count_negative_pivots(S.data(), n, order.data());
}

}  // namespace bough::linear
