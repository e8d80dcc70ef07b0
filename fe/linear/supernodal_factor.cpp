#include "fe/linear/supernodal_factor.hpp"

// First: the BLAS header needs PETSc's own names.
#include <petscsys.h>

#include <petscblaslapack.h>

#include <cholmod.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "base/diagnostic.hpp"
#include "fe/linear/blas.hpp"
#include "fe/linear/dissection.hpp"
#include "fe/linear/memory_need.hpp"
#include "fe/linear/supernodes.hpp"

namespace bough::fe {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// One part with the rows between: its LLᵀ by CHOLMOD, and the trailing block of that as a dense matrix.
class Part {
 public:
  Part() {
    cholmod_start(&common_);
    common_.print = 0;
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_NATURAL;
    common_.postorder = 0;  // the rows between stay last
    common_.supernodal = CHOLMOD_SUPERNODAL;
    common_.final_ll = 1;
    common_.quick_return_if_not_posdef = 1;
  }
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;
  ~Part() {
    cholmod_free_factor(&factor_, &common_);
    cholmod_finish(&common_);
  }

  /// (K_pp, K_ps; K_sp, K_ss / 2 + δ) in the order of `own`, postordered, then `between`. False where CHOLMOD wants
  /// another order or no supernodes.
  bool analyse(const MatrixRows& A, std::vector<PetscInt> own, const std::vector<PetscInt>& between,
               const VectorXd& delta);
  double num_entries() const { return common_.lnz; }
  /// False: not positive definite.
  bool factor();
  /// L_ss L_ssᵀ.
  MatrixXd calc_schur() const;
  /// K_pp z = B_p as far as L goes; `carried`, kFewSides or kManySides x rows between, becomes K_sp K_pp⁻¹ B_p.
  void forward(const Eigen::Ref<const MatrixXd>& B, MatrixXd& carried);
  /// Then X_p, with the solution of the rows between.
  void backward(const MatrixXd& X_s, Eigen::Ref<MatrixXd> X);

 private:
  /// The upper triangle of `rows`, of which the first are the part's own.
  void take(const MatrixRows& A, const std::vector<PetscInt>& rows, std::size_t num_own, const VectorXd& delta);
  cholmod_sparse as_sparse();
  Supernodes get_supernodes() const {
    return {static_cast<int>(factor_->nsuper),    static_cast<const int*>(factor_->super),
            static_cast<const int*>(factor_->pi), static_cast<const int*>(factor_->px),
            static_cast<const int*>(factor_->s),  static_cast<const double*>(factor_->x)};
  }
  void check() const {
    if (common_.status == CHOLMOD_OUT_OF_MEMORY || common_.status == CHOLMOD_TOO_LARGE)
      throw ComputationError(
          "fe.out-of-memory", {}, "the factor of the stiffness matrix does not fit the memory",
          "use a coarser mesh, or run on more processes of a larger machine (mpirun -n 2 bough ...)");
  }

  cholmod_common common_{};
  cholmod_factor* factor_ = nullptr;
  std::vector<int> start_, row_;
  std::vector<double> value_;
  std::vector<PetscInt> rows_;  ///< of A, in the order of L; those of the part alone
  Eigen::Index num_between_ = 0;
  MatrixXd L_ss_;  ///< lower
  MatrixXd Z_;     ///< right-hand sides x rows of L
};

cholmod_sparse Part::as_sparse() {
  cholmod_sparse matrix{};
  matrix.nrow = matrix.ncol = start_.size() - 1;
  matrix.nzmax = row_.size();
  matrix.p = start_.data();
  matrix.i = row_.data();
  matrix.x = value_.data();
  matrix.stype = 1;
  matrix.itype = CHOLMOD_INT;
  matrix.xtype = CHOLMOD_REAL;
  matrix.dtype = CHOLMOD_DOUBLE;
  matrix.packed = 1;
  return matrix;
}

void Part::take(const MatrixRows& A, const std::vector<PetscInt>& rows, std::size_t num_own, const VectorXd& delta) {
  const PetscInt last = *std::max_element(rows.begin(), rows.end());
  std::vector<int> place(static_cast<std::size_t>(last) + 1, -1);
  for (std::size_t i = 0; i < rows.size(); ++i) place[static_cast<std::size_t>(rows[i])] = static_cast<int>(i);
  start_.assign(1, 0);
  row_.clear();
  value_.clear();
  std::size_t most = rows.size();  // of the upper triangle
  for (const PetscInt row : rows) most += static_cast<std::size_t>(A.start[row + 1] - A.start[row]);
  row_.reserve(most / 2);
  value_.reserve(most / 2);
  for (std::size_t j = 0; j < rows.size(); ++j) {
    for (PetscInt k = A.start[rows[j]]; k < A.start[rows[j] + 1]; ++k) {
      const int i = A.column[k] <= last ? place[static_cast<std::size_t>(A.column[k])] : -1;
      if (i < 0 || i > static_cast<int>(j)) continue;  // of the other part, or below the diagonal
      const bool is_between = i >= static_cast<int>(num_own), is_diagonal = i == static_cast<int>(j);
      row_.push_back(i);
      value_.push_back(is_between ? 0.5 * A.value[k] + (is_diagonal ? delta(i - static_cast<int>(num_own)) : 0.0)
                                  : A.value[k]);
    }
    start_.push_back(static_cast<int>(row_.size()));
  }
}

bool Part::analyse(const MatrixRows& A, std::vector<PetscInt> own, const std::vector<PetscInt>& between,
                   const VectorXd& delta) {
  const auto n_p = own.size();
  take(A, own, n_p, delta);
  cholmod_sparse alone = as_sparse();
  std::vector<int> parent(n_p), post(n_p);
  if (!cholmod_etree(&alone, parent.data(), &common_)) return false;
  if (cholmod_postorder(parent.data(), n_p, nullptr, post.data(), &common_) != static_cast<int>(n_p)) return false;
  rows_.clear();
  for (const int i : post) rows_.push_back(own[static_cast<std::size_t>(i)]);

  own = rows_;
  own.insert(own.end(), between.begin(), between.end());
  take(A, own, n_p, delta);
  num_between_ = static_cast<Eigen::Index>(between.size());
  cholmod_sparse matrix = as_sparse();
  factor_ = cholmod_analyze(&matrix, &common_);
  check();
  if (!factor_ || !factor_->is_super) return false;
  const int* order = static_cast<const int*>(factor_->Perm);
  for (std::size_t i = 0; i < own.size(); ++i)
    if (order[i] != static_cast<int>(i)) return false;
  return true;
}

bool Part::factor() {
  cholmod_sparse matrix = as_sparse();
  cholmod_factorize(&matrix, factor_, &common_);
  check();
  start_ = std::vector<int>();  // {} would keep the memory
  row_ = std::vector<int>();
  value_ = std::vector<double>();
  if (common_.status != CHOLMOD_OK || factor_->minor < factor_->n) return false;
  const auto n_p = static_cast<int>(rows_.size());
  const auto n_s = num_between_;
  L_ss_ = MatrixXd::Zero(n_s, n_s);
  const Supernodes L = get_supernodes();
  for (int k = 0; k < L.num; ++k) {
    if (L.super[k + 1] <= n_p) continue;
    const int num_rows = L.row_at[k + 1] - L.row_at[k];
    for (int j = std::max(L.super[k], n_p); j < L.super[k + 1]; ++j)
      for (int i = j - L.super[k]; i < num_rows; ++i)
        L_ss_(L.row[L.row_at[k] + i] - n_p, j - n_p) =
            L.value[L.value_at[k] + static_cast<std::ptrdiff_t>(j - L.super[k]) * num_rows + i];
  }
  return true;
}

MatrixXd Part::calc_schur() const {
  MatrixXd schur(num_between_, num_between_);
  multiply_dense(false, L_ss_, MatrixXd(L_ss_.transpose()), 0, schur);
  return schur;
}

void Part::forward(const Eigen::Ref<const MatrixXd>& B, MatrixXd& carried) {
  const auto n_p = static_cast<Eigen::Index>(rows_.size()), n_s = num_between_, m = B.cols();
  Z_.resize(m <= kFewSides ? kFewSides : kManySides, n_p + n_s);
  for (Eigen::Index i = 0; i < n_p; ++i) {
    double* z = Z_.col(i).data();
    const double* b = B.data() + rows_[static_cast<std::size_t>(i)];
    for (Eigen::Index c = 0; c < m; ++c) z[c] = b[c * B.outerStride()];
    std::fill(z + m, z + Z_.rows(), 0.0);
  }
  Z_.rightCols(n_s).setZero();
  solve_lower(get_supernodes(), Z_);
  // L_ss z_s = -L_sp z_p
  carried = -Z_.rightCols(n_s) * L_ss_.triangularView<Eigen::Lower>().transpose();
}

void Part::backward(const MatrixXd& X_s, Eigen::Ref<MatrixXd> X) {
  const auto n_p = static_cast<Eigen::Index>(rows_.size());
  // L_ssᵀ x_s as the right side of the rows between, so that they come out as they are.
  Z_.rightCols(num_between_).noalias() = X_s * L_ss_.triangularView<Eigen::Lower>();
  solve_lower_transposed(get_supernodes(), Z_);
  for (Eigen::Index i = 0; i < n_p; ++i) {
    const double* z = Z_.col(i).data();
    double* x = X.data() + rows_[static_cast<std::size_t>(i)];
    for (Eigen::Index c = 0; c < X.cols(); ++c) x[c * X.outerStride()] = z[c];
  }
}

struct Parts {
  std::vector<std::unique_ptr<Part>> part;
  std::vector<PetscInt> between;
  MatrixXd L;  ///< of the Schur complement of the rows between
};

PetscErrorCode destroy_parts(Mat A) {
  void* context = nullptr;
  check_petsc(MatShellGetContext(A, static_cast<void*>(&context)));
  delete static_cast<Parts*>(context);
  return 0;
}

Parts* find_factor(Mat A) { return static_cast<Parts*>(find_shell_context(A, destroy_parts)); }

/// False: not positive definite.
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

VectorXd calc_row_sums(const MatrixRows& A, const std::vector<PetscInt>& rows, PetscInt size) {
  std::vector<char> is_in(static_cast<std::size_t>(size), 0);
  for (const PetscInt row : rows) is_in[static_cast<std::size_t>(row)] = 1;
  VectorXd sums = VectorXd::Zero(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (PetscInt k = A.start[rows[i]]; k < A.start[rows[i] + 1]; ++k)
      if (is_in[static_cast<std::size_t>(A.column[k])]) sums(static_cast<Eigen::Index>(i)) += std::abs(A.value[k]);
  return sums;
}

}  // namespace

SupernodalFactor make_supernodal_factor(Mat A, PetscInt least) {
  SupernodalFactor result;
  if (initialize_petsc().size > 1) return result;
  auto cut = find_parts(A, least);
  if (!cut) return result;
  auto parts = std::make_unique<Parts>();
  parts->between = std::move(cut->between);
  std::vector<std::vector<PetscInt>> own;
  for (auto* rows : {&cut->first, &cut->second})
    if (!rows->empty()) own.push_back(std::move(*rows));
  const std::size_t num = own.size();
  for (std::size_t p = 0; p < num; ++p) parts->part.push_back(std::make_unique<Part>());

  std::vector<char> is_fine(num, 0);
  VectorXd delta;
  visit_rows(A, [&](const MatrixRows& rows, PetscInt size) {
    delta = calc_row_sums(rows, parts->between, size);
    do_all(num, [&](std::size_t p) {
      is_fine[p] = parts->part[p]->analyse(rows, std::move(own[p]), parts->between, delta) ? 1 : 0;
    });
  });
  const auto are_all = [&] { return std::all_of(is_fine.begin(), is_fine.end(), [](char one) { return one != 0; }); };
  if (!are_all()) return result;
  PetscInt n = 0;
  check_petsc(MatGetSize(A, &n, nullptr));
  double num_entries = 0;
  for (const auto& part : parts->part) num_entries += part->num_entries();
  release_freed_memory();
  require_memory(static_cast<double>(n), num_entries, calc_free_memory());

  std::vector<MatrixXd> schur(num);
  do_all(num, [&](std::size_t p) {
    is_fine[p] = parts->part[p]->factor() ? 1 : 0;
    if (is_fine[p] != 0) schur[p] = parts->part[p]->calc_schur();
  });
  result.is_definite = are_all();
  if (!result.is_definite) return result;
  if (num > 1) {
    parts->L = schur[0] + schur[1];
    parts->L.diagonal() -= 2 * delta;
    result.is_definite = factor_dense(parts->L);
    if (!result.is_definite) return result;
  }
  result.num_parts = static_cast<int>(num);
  check_petsc(MatCreateShell(PETSC_COMM_WORLD, n, n, n, n, parts.get(), result.factor.out()));
  check_petsc(MatShellSetOperation(result.factor.get(), MATOP_DESTROY, reinterpret_cast<void (*)()>(destroy_parts)));
  parts.release();
  return result;
}

bool is_supernodal_factor(Mat factor) { return find_factor(factor) != nullptr; }

bool solve_supernodal(Mat factor, const Eigen::Ref<const MatrixXd>& B, MatrixXd& X) {
  Parts* parts = find_factor(factor);
  if (!parts) return false;
  const std::size_t num = parts->part.size();
  X.resize(B.rows(), B.cols());
  for (Eigen::Index first = 0; first < B.cols(); first += kManySides) {
    const auto m = std::min(kManySides, B.cols() - first);
    const auto B_block = B.middleCols(first, m);
    auto X_block = X.middleCols(first, m);
    std::vector<MatrixXd> carried(num);
    do_all(num, [&](std::size_t p) { parts->part[p]->forward(B_block, carried[p]); });
    MatrixXd X_s = B_block(parts->between, Eigen::all);
    for (const MatrixXd& share : carried) X_s -= share.topRows(m).transpose();
    solve_dense(parts->L, X_s);
    X_block(parts->between, Eigen::all) = X_s;
    MatrixXd x_s = MatrixXd::Zero(carried[0].rows(), X_s.rows());
    x_s.topRows(m) = X_s.transpose();
    do_all(num, [&](std::size_t p) { parts->part[p]->backward(x_s, X_block); });
  }
  return true;
}

}  // namespace bough::fe
