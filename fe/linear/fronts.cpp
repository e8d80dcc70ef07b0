#include "fe/linear/fronts.hpp"

// First: the BLAS header needs PETSc's own names.
#include <petscsys.h>

#include <petscblaslapack.h>

#include <cholmod.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fe/linear/dissection.hpp"
#include "fe/linear/low_rank_sum.hpp"
#include "fe/linear/memory_need.hpp"

extern "C" void dsytrs2_(const char* uplo, const PetscBLASInt* n, const PetscBLASInt* num_sides, double* A,
                         const PetscBLASInt* lda, const PetscBLASInt* pivots, double* B, const PetscBLASInt* ldb,
                         double* work, PetscBLASInt* info);

namespace bough::fe {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// What a front may add to a diagonal entry, over what the matrices have there. LLᵀ of a definite matrix takes off no
/// more than is there; a hundred times costs two digits of sixteen.
constexpr double kMostGrowth = 100;

/// A + factor B by rows, both triangles.
struct Sum {
  MatrixRows A, B;
  double factor = 0;

  /// use(column, value) for the entries of a row, ascending.
  template <class Use>
  void visit(PetscInt row, const Use& use) const {
    PetscInt a = A.start[row], b = B.start[row];
    const PetscInt a_end = A.start[row + 1], b_end = B.start[row + 1];
    while (a < a_end || b < b_end) {
      if (b == b_end || (a < a_end && A.column[a] < B.column[b])) {
        use(A.column[a], A.value[a]);
        ++a;
      } else if (a == a_end || B.column[b] < A.column[a]) {
        use(B.column[b], factor * B.value[b]);
        ++b;
      } else {
        use(A.column[a], A.value[a] + factor * B.value[b]);
        ++a;
        ++b;
      }
    }
  }

  /// |A_ii| + |factor B_ii|.
  double calc_size(PetscInt row) const {
    const auto find = [row](const MatrixRows& M) {
      const PetscInt* at = std::lower_bound(M.column + M.start[row], M.column + M.start[row + 1], row);
      return at != M.column + M.start[row + 1] && *at == row ? std::abs(M.value[at - M.column]) : 0.0;
    };
    return find(A) + std::abs(factor) * find(B);
  }
};

/// The rows of one part and those between, which come last and are not eliminated.
class PartFronts {
 public:
  PartFronts() {
    cholmod_start(&common_);
    common_.print = 0;
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_NATURAL;
    common_.postorder = 0;
    common_.supernodal = CHOLMOD_SUPERNODAL;
  }
  PartFronts(const PartFronts&) = delete;
  PartFronts& operator=(const PartFronts&) = delete;
  ~PartFronts() {
    cholmod_free_factor(&factor_, &common_);
    cholmod_finish(&common_);
  }

  /// False where CHOLMOD has no supernodes in this order, or the part couples to a row that is not its own.
  bool analyse(const Sum& sum, const std::vector<PetscInt>& own, const std::vector<PetscInt>& between);
  /// Numbers that count() keeps at the same time.
  double num_numbers() const { return most_stack_ + square(most_rows_) + square(most_columns_) * 2; }
  /// Of the part's own rows, and what they leave on those between, lower triangle; -1 where a pivot is too small.
  int count(MatrixXd& schur);

 private:
  static double square(double x) { return x * x; }
  /// One triangle of `rows`. False where the part's own couple to others.
  bool take(const Sum& sum, const std::vector<PetscInt>& rows, bool upper);
  cholmod_sparse as_sparse(int stype);
  /// Eliminates the first `num` of the front's rows; -1 as above.
  int eliminate(int num, int num_rows, const int* rows);
  int get_num_columns(int k) const { return std::min(super_[k + 1], static_cast<int>(num_own_)) - super_[k]; }
  int get_num_rows(int k) const { return row_at_[k + 1] - row_at_[k]; }
  void check() const {
    if (common_.status == CHOLMOD_OUT_OF_MEMORY || common_.status == CHOLMOD_TOO_LARGE)
      throw ComputationError("fe.out-of-memory", {}, "a factor for the count of the modes does not fit the memory",
                             "leave the count out (--no-check)");
  }

  cholmod_common common_{};
  cholmod_factor* factor_ = nullptr;
  std::size_t num_own_ = 0;
  int num_fronts_ = 0;
  const int *super_ = nullptr, *row_at_ = nullptr, *row_ = nullptr;
  std::vector<int> num_children_;
  double most_stack_ = 0;
  int most_rows_ = 0, most_columns_ = 0;

  std::vector<int> start_, row_of_entry_;  ///< one triangle of the sum, by columns
  std::vector<double> value_;
  VectorXd diagonal_;  ///< |A| + |factor B|
  std::vector<double> front_, pivots_, right_, work_;
  std::vector<PetscBLASInt> pivot_order_;
};

bool PartFronts::take(const Sum& sum, const std::vector<PetscInt>& rows, bool upper) {
  const PetscInt last = *std::max_element(rows.begin(), rows.end());
  std::vector<int> place(static_cast<std::size_t>(last) + 1, -1);
  for (std::size_t i = 0; i < rows.size(); ++i) place[static_cast<std::size_t>(rows[i])] = static_cast<int>(i);
  start_.assign(1, 0);
  row_of_entry_.clear();
  value_.clear();
  bool is_closed = true;
  for (int j = 0; j < static_cast<int>(rows.size()); ++j) {
    const bool is_own = j < static_cast<int>(num_own_);
    sum.visit(rows[static_cast<std::size_t>(j)], [&](PetscInt column, double value) {
      const int i = column <= last ? place[static_cast<std::size_t>(column)] : -1;
      if (i < 0) {
        is_closed = is_closed && !is_own;
        return;
      }
      if (upper ? i > j : i < j) return;
      row_of_entry_.push_back(i);
      if (!upper) value_.push_back(value);
    });
    start_.push_back(static_cast<int>(row_of_entry_.size()));
  }
  return is_closed;
}

cholmod_sparse PartFronts::as_sparse(int stype) {
  cholmod_sparse matrix{};
  matrix.nrow = matrix.ncol = start_.size() - 1;
  matrix.nzmax = row_of_entry_.size();
  matrix.p = start_.data();
  matrix.i = row_of_entry_.data();
  matrix.stype = stype;
  matrix.itype = CHOLMOD_INT;
  matrix.xtype = CHOLMOD_PATTERN;
  matrix.dtype = CHOLMOD_DOUBLE;
  matrix.packed = 1;
  return matrix;
}

bool PartFronts::analyse(const Sum& sum, const std::vector<PetscInt>& own, const std::vector<PetscInt>& between) {
  num_own_ = own.size();
  take(sum, own, true);
  cholmod_sparse alone = as_sparse(1);
  std::vector<int> parent(num_own_), post(num_own_);
  if (!cholmod_etree(&alone, parent.data(), &common_)) return false;
  if (cholmod_postorder(parent.data(), num_own_, nullptr, post.data(), &common_) != static_cast<int>(num_own_))
    return false;
  std::vector<PetscInt> rows;
  rows.reserve(num_own_ + between.size());
  for (const int i : post) rows.push_back(own[static_cast<std::size_t>(i)]);
  rows.insert(rows.end(), between.begin(), between.end());
  if (!take(sum, rows, false)) return false;
  cholmod_sparse matrix = as_sparse(-1);
  factor_ = cholmod_analyze(&matrix, &common_);
  check();
  if (!factor_ || !factor_->is_super) return false;
  const int* order = static_cast<const int*>(factor_->Perm);
  for (int i = 0; i < static_cast<int>(rows.size()); ++i)
    if (order[i] != i) return false;

  diagonal_.resize(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) diagonal_(static_cast<Eigen::Index>(i)) = sum.calc_size(rows[i]);
  super_ = static_cast<const int*>(factor_->super);
  row_at_ = static_cast<const int*>(factor_->pi);
  row_ = static_cast<const int*>(factor_->s);
  std::vector<int> front_of(rows.size());
  for (int k = 0; k < static_cast<int>(factor_->nsuper); ++k)
    for (int j = super_[k]; j < super_[k + 1]; ++j) front_of[static_cast<std::size_t>(j)] = k;
  while (num_fronts_ < static_cast<int>(factor_->nsuper) && super_[num_fronts_] < static_cast<int>(num_own_))
    ++num_fronts_;
  // Children come just before their parents: what they leave is on top of the stack.
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
    if (next >= static_cast<int>(num_own_)) continue;  // goes to the rows between
    const int above = front_of[static_cast<std::size_t>(next)];
    ++num_children_[static_cast<std::size_t>(above)];
    left.push_back(0.5 * num_left * (num_left + 1.0));
    stack += left.back();
    most_stack_ = std::max(most_stack_, stack);
  }
  return left.empty();
}

int PartFronts::eliminate(int num, int num_rows, const int* rows) {
  const PetscBLASInt n = num, m = num_rows - num, ld = num_rows;
  const double one = 1, minus = -1;
  double *F = front_.data(), *below = F + num, *left = below + static_cast<std::ptrdiff_t>(num) * ld;
  PetscBLASInt info = 0;
  for (int j = 0; j < num; ++j)
    std::copy_n(F + j + static_cast<std::ptrdiff_t>(j) * ld, num - j,
                pivots_.data() + j + static_cast<std::ptrdiff_t>(j) * num);
  VectorXd before(m);
  for (int i = 0; i < m; ++i) before(i) = left[i + static_cast<std::ptrdiff_t>(i) * ld];
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
    for (int j = 0; j < num; ++j) {
      const bool is_pair = pivot_order_[static_cast<std::size_t>(j)] < 0;  // of one eigenvalue of each sign
      if (is_pair || pivots_[static_cast<std::size_t>(j) * static_cast<std::size_t>(num + 1)] < 0) ++negative;
      if (is_pair) ++j;
    }
    if (m == 0) return negative;
    right_.resize(static_cast<std::size_t>(num) * static_cast<std::size_t>(m));
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < num; ++j)
        right_[static_cast<std::size_t>(i) * static_cast<std::size_t>(num) + static_cast<std::size_t>(j)] =
            below[i + static_cast<std::ptrdiff_t>(j) * ld];
    dsytrs2_("L", &n, &m, pivots_.data(), &n, pivot_order_.data(), right_.data(), &n, work_.data(), &info);
    // By blocks of columns, the lower triangle only.
    constexpr int kColumns = 64;
    for (int first = 0; first < m; first += kColumns) {
      const PetscBLASInt width = std::min(kColumns, m - first), height = m - first;
      BLASgemm_("N", "N", &height, &width, &n, &minus, below + first, &ld,
                right_.data() + static_cast<std::ptrdiff_t>(first) * num, &n, &one,
                left + first + static_cast<std::ptrdiff_t>(first) * ld, &ld);
    }
  }
  for (int i = 0; i < m; ++i) {
    const double change = std::abs(left[i + static_cast<std::ptrdiff_t>(i) * ld] - before(i));
    if (!(change <= kMostGrowth * diagonal_(rows[num + i]))) return -1;
  }
  return negative;
}

int PartFronts::count(MatrixXd& schur) {
  const auto n_s = diagonal_.size() - static_cast<Eigen::Index>(num_own_);
  schur = MatrixXd::Zero(n_s, n_s);
  front_.resize(static_cast<std::size_t>(most_rows_) * static_cast<std::size_t>(most_rows_));
  pivots_.resize(static_cast<std::size_t>(most_columns_) * static_cast<std::size_t>(most_columns_));
  pivot_order_.resize(static_cast<std::size_t>(most_columns_));
  work_.resize(static_cast<std::size_t>(most_columns_) * 64 + 64);
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

/// Of a dense matrix, of which the lower triangle is given; -1 where a pivot is zero.
int count_dense(MatrixXd& S) {
  const auto n = static_cast<PetscBLASInt>(S.rows());
  if (n == 0) return 0;
  std::vector<PetscBLASInt> order(static_cast<std::size_t>(n));
  PetscBLASInt size = 64 * n, info = 0;
  std::vector<double> work(static_cast<std::size_t>(size));
  LAPACKsytrf_("L", &n, S.data(), &n, order.data(), work.data(), &size, &info);
  if (info != 0) return -1;
  int negative = 0;
  for (PetscBLASInt j = 0; j < n; ++j) {
    const bool is_pair = order[static_cast<std::size_t>(j)] < 0;
    if (is_pair || S(j, j) < 0) ++negative;
    if (is_pair) ++j;
  }
  return negative;
}

/// -1 where a pivot is too small, or B couples the parts.
int count_of_sum(const Sum& sum, const TwoParts& cut) {
  std::vector<const std::vector<PetscInt>*> own;
  for (const auto* rows : {&cut.first, &cut.second})
    if (!rows->empty()) own.push_back(rows);
  const std::size_t num = own.size();
  std::vector<PartFronts> parts(num);
  std::vector<int> result(num, 0);
  do_all(num, [&](std::size_t p) { result[p] = parts[p].analyse(sum, *own[p], cut.between) ? 0 : -1; });
  const auto has_failed = [&] { return std::any_of(result.begin(), result.end(), [](int one) { return one < 0; }); };
  if (num == 0 || has_failed()) return -1;
  double num_numbers = 0, num_rows = static_cast<double>(cut.between.size());
  for (std::size_t p = 0; p < num; ++p) {
    num_numbers += parts[p].num_numbers();
    num_rows += static_cast<double>(own[p]->size());
  }
  require_memory(num_rows, num_numbers, calc_free_memory());

  std::vector<MatrixXd> schur(num);
  do_all(num, [&](std::size_t p) { result[p] = parts[p].count(schur[p]); });
  if (has_failed()) return -1;
  int negative = 0;
  for (const int one : result) negative += one;
  for (std::size_t p = 1; p < num; ++p) schur[0] += schur[p];
  std::vector<int> place;
  for (std::size_t j = 0; j < cut.between.size(); ++j) {
    const auto place_of = [&](PetscInt row) -> Eigen::Index {
      const auto at = std::lower_bound(cut.between.begin(), cut.between.end(), row);
      return at != cut.between.end() && *at == row ? at - cut.between.begin() : -1;
    };
    sum.visit(cut.between[j], [&](PetscInt column, double value) {
      if (const Eigen::Index i = place_of(column); i >= static_cast<Eigen::Index>(j))
        schur[0](i, static_cast<Eigen::Index>(j)) += value;
    });
  }
  const int last = count_dense(schur[0]);
  return last < 0 ? -1 : negative + last;
}

}  // namespace

std::optional<int> count_negative_by_fronts(Mat A, double factor, Mat B, PetscInt least) {
  if (initialize_petsc().size > 1 || find_low_rank(A) || find_low_rank(B)) return std::nullopt;
  auto cut = find_parts(A, least);
  if (!cut) return std::nullopt;
  std::sort(cut->between.begin(), cut->between.end());
  int count = -1;
  visit_rows(A, [&](const MatrixRows& a, PetscInt) {
    visit_rows(B, [&](const MatrixRows& b, PetscInt) { count = count_of_sum({a, b, factor}, *cut); });
  });
  if (count < 0) return std::nullopt;
  return count;
}

}  // namespace bough::fe
