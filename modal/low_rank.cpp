#include "modal/low_rank.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "fe/linear/factor.hpp"
#include "fe/linear/products.hpp"
#include "fe/linear/symmetric_matrix.hpp"
#include "modal/canonical.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::detail {
namespace {

using linear::check_petsc;

struct Entry {
  int row;
  double value;
};
using Column = std::vector<Entry>;

/// Row i of M on every rank: its column, M being symmetric.
Column get_column(const linear::SymmetricMatrix& of, int i) {
  if (const linear::LowRankPart* part = of.low_rank()) {
    const Eigen::VectorXd t = part->W * Eigen::VectorXd(part->U.transpose().col(i));
    Eigen::VectorXd full = part->U * t;
    for (const auto& [row, value] : get_column(of.sparse_part(), i)) full(row) += value;
    Column column;
    for (Eigen::Index row = 0; row < full.size(); ++row)
      if (full(row) != 0) column.push_back({static_cast<int>(row), full(row)});
    return column;
  }
  Mat M = of.sparse();
  PetscInt first = 0, last = 0, num = 0;
  check_petsc(MatGetOwnershipRange(M, &first, &last));
  Column column;
  if (i >= first && i < last) {
    const PetscInt* rows = nullptr;
    const PetscScalar* values = nullptr;
    check_petsc(MatGetRow(M, i, &num, &rows, &values));
    for (PetscInt k = 0; k < num; ++k)
      if (values[k] != 0) column.push_back({rows[k], values[k]});
    check_petsc(MatRestoreRow(M, i, &num, &rows, &values));
  }
  if (linear::initialize_petsc().size == 1) return column;
  const PetscInt* starts = nullptr;
  check_petsc(MatGetOwnershipRanges(M, &starts));
  int owner = 0;
  while (i >= starts[owner + 1]) ++owner;
  int size = static_cast<int>(column.size());
  MPI_Bcast(&size, 1, MPI_INT, owner, PETSC_COMM_WORLD);
  column.resize(static_cast<std::size_t>(size));
  MPI_Bcast(column.data(), size * static_cast<int>(sizeof(Entry)), MPI_BYTE, owner, PETSC_COMM_WORLD);
  return column;
}

}  // namespace

std::optional<Eigen::SparseMatrix<double>> factor_low_rank(const linear::SymmetricMatrix& M,
                                                           const Eigen::VectorXd& diagonal, int max_rank) {
  // The rank is that of the sparse part at least, which is found from fewer entries.
  if (M.low_rank() && !factor_low_rank(M.sparse_part(), linear::get_diagonal(M.sparse_part()), max_rank))
    return std::nullopt;
  const auto n = static_cast<int>(diagonal.size());
  Eigen::VectorXd root(n), left(n), column = Eigen::VectorXd::Zero(n);
  for (int i = 0; i < n; ++i) {
    if (diagonal(i) < 0) return std::nullopt;
    root(i) = std::sqrt(diagonal(i));
    left(i) = diagonal(i) > 0 ? 1 : 0;
  }
  std::vector<Column> factor, of_row(static_cast<std::size_t>(n));  // by column, and by row: column, value
  for (double threshold = 0.3; threshold > kRankPivot; threshold *= 0.1)
    for (int i = 0; i < n; ++i) {
      if (!(left(i) > threshold)) continue;
      if (static_cast<int>(factor.size()) == max_rank) return std::nullopt;
      std::vector<int> touched;
      const auto add = [&](int row, double value) {
        if (column(row) == 0) touched.push_back(row);
        column(row) += value;
      };
      for (const auto& [row, value] : get_column(M, i))
        if (diagonal(row) > 0)
          add(row, value / (root(row) * root(i)));
        else
          return std::nullopt;
      for (const auto& [k, value] : of_row[static_cast<std::size_t>(i)])
        for (const auto& entry : factor[static_cast<std::size_t>(k)]) add(entry.row, -value * entry.value);
      const double pivot = std::sqrt(left(i));
      const auto k = static_cast<int>(factor.size());
      factor.push_back({{i, pivot}});
      left(i) = 0;
      for (const int row : touched) {
        const double value = column(row) / pivot;
        column(row) = 0;
        if (left(row) <= 0 || std::abs(value) < kRankEntry) continue;
        factor.back().push_back({row, value});
        of_row[static_cast<std::size_t>(row)].push_back({k, value});
        left(row) -= value * value;
        if (left(row) < kRankNegative) return std::nullopt;
      }
    }
  Eigen::SparseMatrix<double> C(n, static_cast<int>(factor.size()));
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t k = 0; k < factor.size(); ++k)
    for (const auto& [row, value] : factor[k]) entries.emplace_back(row, static_cast<int>(k), root(row) * value);
  C.setFromTriplets(entries.begin(), entries.end());
  return C;
}

namespace {

constexpr Eigen::Index kBlock = 24;  ///< right-hand sides at once

/// Values and vectors among X by K itself.
void solve_among(const linear::SymmetricMatrix& K, const linear::SymmetricMatrix& M, Roots& roots) {
  const MatrixXd& X = roots.X;
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> ritz(
      linear::symmetrize(X.transpose() * linear::multiply(K, X)),
      linear::symmetrize(X.transpose() * linear::multiply(M, X)));
  if (ritz.info() != Eigen::Success) return;
  roots.value = ritz.eigenvalues();
  roots.X = (X * ritz.eigenvectors()).eval();
}

/// The lowest roots besides the M-orthonormal `known` ones, up to kStageReach times the first of them.
Roots solve_stage(const LowRankProblem& problem, const MatrixXd& known, int number) {
  const Eigen::SparseMatrix<double>& C = *problem.C;
  const double shift = problem.shift;
  const auto r = C.cols(), k = known.cols();
  // Z: what is orthogonal to the known ones, whose Cᵀx are orthonormal.
  MatrixXd Z = MatrixXd::Identity(r, r);
  if (k > 0) {
    const Eigen::HouseholderQR<MatrixXd> qr(MatrixXd(C.transpose() * known));
    Z = MatrixXd(qr.householderQ()).rightCols(r - k);
  }
  const bool is_first = k == problem.known.cols();
  const auto solve_for = [&](const MatrixXd& Y) {
    MatrixXd X = problem.solve(MatrixXd(C * Y));
    if (!is_first || problem.projects_known) project_out(problem.M, known, X);
    return X;
  };
  MatrixXd G(Z.cols(), Z.cols());
  for (Eigen::Index first = 0; first < Z.cols(); first += kBlock) {
    const auto size = std::min(kBlock, Z.cols() - first);
    G.middleCols(first, size) = Z.transpose() * (C.transpose() * solve_for(Z.middleCols(first, size)));
  }
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(linear::symmetrize(G));
  const VectorXd theta = solver.eigenvalues(), lambda = theta.cwiseInverse().array() + shift;
  const double largest = theta.size() > 0 ? theta.cwiseAbs().maxCoeff() : 0;
  std::vector<int> order;
  for (int i = 0; i < lambda.size(); ++i)
    if (std::abs(theta(i)) > kNoDigit * largest && std::isfinite(lambda(i)))
      order.push_back(i);  // the rest is roundoff
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return lambda(a) < lambda(b); });
  order.resize(std::min(order.size(), static_cast<std::size_t>(number)));
  while (!order.empty() && std::abs(lambda(order.back()) - shift) > kStageReach * std::abs(lambda(order[0]) - shift))
    order.pop_back();

  Roots stage{lambda(order), MatrixXd(C.rows(), static_cast<Eigen::Index>(order.size()))};
  const MatrixXd Y = Z * solver.eigenvectors()(Eigen::all, order);
  for (Eigen::Index first = 0; first < Y.cols(); first += kBlock) {
    const auto size = std::min(kBlock, Y.cols() - first);
    stage.X.middleCols(first, size) =
        solve_for(Y.middleCols(first, size)) * (stage.value.segment(first, size).array() - shift).matrix().asDiagonal();
  }
  return stage;
}

}  // namespace

Roots solve_low_rank(const LowRankProblem& problem) {
  // In stages: next to values a million times as large roundoff is all that G has of the small ones.
  Roots all{VectorXd(0), MatrixXd(problem.C->rows(), 0)};
  MatrixXd known = problem.known;
  const auto requested = std::min<Eigen::Index>(problem.num_wanted, problem.C->cols() - known.cols());
  while (all.size() < requested) {
    Roots stage = solve_stage(problem, known, static_cast<int>(requested) - all.size());
    if (stage.size() == 0) break;
    if (all.size() > 0) solve_among(problem.K, problem.M, stage);
    if (all.size() + stage.size() < requested) {
      MatrixXd X = stage.X;
      orthonormalize_ascending(X.transpose() * linear::multiply(problem.M, X), X);
      known = join(known, X);
    }
    all.add(stage.value, stage.X);
  }
  return all;
}

}  // namespace bough::modal::detail
