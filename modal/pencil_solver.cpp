#include "modal/pencil_solver.hpp"

#include <algorithm>
#include <cmath>

#include "fe/linear/blas.hpp"
#include "fe/linear/mechanism.hpp"
#include "fe/linear/residual.hpp"
#include "modal/canonical.hpp"

namespace bough::modal::detail {
namespace {

constexpr Eigen::Index kBlock = 24;  ///< right-hand sides at once

MatrixXd symmetrize(const MatrixXd& A) { return 0.5 * (A + A.transpose()); }

constexpr double kReach = 1e6;  ///< how far above the first root of a stage the digits suffice

/// X without the M-orthonormal R.
void take_out(const fe::OwnRows& rows, Mat M, const MatrixXd& R, MatrixXd& X) {
  if (R.cols() == 0) return;
  const MatrixXd MR = rows.multiply(M, R);
  for (int pass = 0; pass < 2; ++pass) X -= R * rows.dot(MR, X);
}

/// Values and vectors among X by K itself.
void solve_among(Mat K, Mat M, Roots& roots) {
  const MatrixXd& X = roots.X;
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> ritz(symmetrize(X.transpose() * fe::multiply(K, X)),
                                                                symmetrize(X.transpose() * fe::multiply(M, X)));
  if (ritz.info() != Eigen::Success) return;
  roots.value = ritz.eigenvalues();
  roots.X = (X * ritz.eigenvectors()).eval();
}

}  // namespace

PencilSolver::PencilSolver(const PencilProblem& problem, int request) : problem_(problem) {
  if (problem_.rows.size == 0) problem_.rows = fe::make_whole_rows(problem.M);
  const auto k = static_cast<int>(problem.rigid.cols());
  num_available_ = std::max(0, static_cast<int>((problem.M_diagonal.array() > 0).count()) - k);
  C_ = factor_low_rank(problem.M, problem.M_diagonal, std::min(3 * request + 100 + k, 4000));
  if (C_) num_available_ = std::max(0, static_cast<int>(C_->cols()) - k);
}

bool PencilSolver::solve_whole(double shift, int number, bool definite_only, Roots& roots) {
  // C has few columns, and its solutions are whole.
  const MatrixXd rigid = problem_.rows.replicate(problem_.rigid);
  const auto r = C_->cols(), k = rigid.cols();
  const fe::PetscMat shifted = shift == 0 ? fe::PetscMat() : add(problem_.K, shift, problem_.M);
  Mat A = problem_.supported ? problem_.supported : shift == 0 ? problem_.K : shifted.get();
  std::optional<fe::SymmetricFactor> own;
  const fe::SymmetricFactor* factor = shift == 0 && !problem_.supported ? problem_.factor : nullptr;
  if (!factor) factor = &own.emplace(A, false);
  if (factor->is_singular()) return false;
  if (definite_only && fe::initialize_petsc().size == 1 && !factor->is_definite()) return false;
  // With a shift, mechanisms have the energy of their mass: little, but not roundoff.
  if (k == 0 && !problem_.is_complete &&
      fe::calc_softest_energy(A, problem_.kinds, *factor) < (shift == 0 ? fe::kMechanismEnergy : 3e-16))
    return false;

  // In stages: beside values a million times as large roundoff is all that G has of the small ones.
  Roots all{VectorXd(0), MatrixXd(C_->rows(), 0)};
  MatrixXd known = rigid;
  const auto wanted = std::min<Eigen::Index>(roots.size() + number, r - k);
  while (all.size() < wanted) {
    Roots stage = solve_stage(*factor, shift, known, static_cast<int>(wanted) - all.size());
    if (stage.size() == 0) break;
    if (all.size() > 0) solve_among(problem_.K, problem_.M, stage);
    if (all.size() + stage.size() < wanted) {
      MatrixXd X = stage.X;
      orthonormalize_ascending(X.transpose() * fe::multiply(problem_.M, X), X);
      known = join(known, X);
    }
    all.add(stage.value, stage.X);
  }
  roots = std::move(all);
  if (problem_.rows.is_cut) roots.X = problem_.rows.take(roots.X);
  return true;
}

/// The lowest roots besides the M-orthonormal `known` ones, up to kReach times the first of them.
Roots PencilSolver::solve_stage(const fe::SymmetricFactor& factor, double shift, const MatrixXd& known, int number) {
  const auto r = C_->cols(), k = known.cols();
  // Z: what is orthogonal to the known ones, whose Cᵀx are orthonormal.
  MatrixXd Z = MatrixXd::Identity(r, r);
  if (k > 0) {
    const Eigen::HouseholderQR<MatrixXd> qr(MatrixXd(C_->transpose() * known));
    Z = MatrixXd(qr.householderQ()).rightCols(r - k);
  }
  const bool is_first = k == problem_.rigid.cols();
  const auto solve_for = [&](const MatrixXd& Y) {
    MatrixXd X = factor.solve(MatrixXd(*C_ * Y));
    if (!is_first || problem_.supported) take_out(fe::make_whole_rows(problem_.M), problem_.M, known, X);
    return X;
  };
  MatrixXd G(Z.cols(), Z.cols());
  for (Eigen::Index first = 0; first < Z.cols(); first += kBlock) {
    const auto size = std::min(kBlock, Z.cols() - first);
    G.middleCols(first, size) = Z.transpose() * (C_->transpose() * solve_for(Z.middleCols(first, size)));
  }
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(symmetrize(G));
  const VectorXd theta = solver.eigenvalues(), lambda = theta.cwiseInverse().array() - shift;
  const double largest = theta.size() > 0 ? theta.cwiseAbs().maxCoeff() : 0;
  std::vector<int> order;
  for (int i = 0; i < lambda.size(); ++i)
    if (std::abs(theta(i)) > 1e-14 * largest && std::isfinite(lambda(i))) order.push_back(i);  // the rest is roundoff
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return lambda(a) < lambda(b); });
  order.resize(std::min(order.size(), static_cast<std::size_t>(number)));
  while (!order.empty() && std::abs(lambda(order.back()) + shift) > kReach * std::abs(lambda(order[0]) + shift))
    order.pop_back();

  Roots stage{lambda(order), MatrixXd(C_->rows(), static_cast<Eigen::Index>(order.size()))};
  const MatrixXd Y = Z * solver.eigenvectors()(Eigen::all, order);
  for (Eigen::Index first = 0; first < Y.cols(); first += kBlock) {
    const auto size = std::min(kBlock, Y.cols() - first);
    stage.X.middleCols(first, size) =
        solve_for(Y.middleCols(first, size)) * (stage.value.segment(first, size).array() + shift).matrix().asDiagonal();
  }
  return stage;
}

/// Of fewer roots than were asked for some may be what roundoff made of a root with more copies than a Krylov space
/// sees; those whose residual is large are looked for once more, beside the good ones.
void PencilSolver::drop_rough(KrylovResult& result) const {
  const VectorXd K_diagonal = fe::get_diagonal(problem_.K).cwiseAbs(), M_diagonal = fe::get_diagonal(problem_.M);
  const VectorXd residual = fe::calc_pair_residuals(
      K_diagonal, M_diagonal, result.values, result.vectors, problem_.rows.multiply(problem_.K, result.vectors),
      problem_.rows.multiply(problem_.M, result.vectors), problem_.kinds, problem_.rows);
  std::vector<int> kept;
  for (int j = 0; j < residual.size(); ++j)
    if (residual(j) <= fe::kResidualWarning) kept.push_back(j);
  if (kept.empty() || static_cast<Eigen::Index>(kept.size()) == residual.size()) return;
  result.values = result.values(kept).eval();
  result.vectors = result.vectors(Eigen::all, kept).eval();
}

bool PencilSolver::solve(double shift, int number, int num_guard, bool definite_only, Roots& roots) {
  const int left = num_available_ - roots.size();
  if (left <= 0) return true;
  if (C_) return solve_whole(shift, std::min(number, left), definite_only, roots);
  KrylovProblem krylov;
  krylov.A = problem_.supported ? problem_.supported : problem_.K;
  krylov.B = problem_.M;
  krylov.shift = -shift;
  krylov.max_subspace = left;
  krylov.num_wanted = std::min(number, left);
  krylov.num_guard = number <= left ? num_guard : 0;
  krylov.deflate = join(problem_.rigid, roots.X);
  krylov.tolerance = problem_.tolerance;
  constexpr int kMostColumns = 48;
  krylov.start = round_++;
  if (krylov.start > 0 && number <= kMostColumns) krylov.block = std::max(4, number);  // what the first round missed
  krylov.definite_only = definite_only;
  krylov.method = problem_.method;
  if (shift == 0 && !problem_.supported && problem_.factor && problem_.factor->is_definite())
    krylov.factor = problem_.factor->get();
  krylov.progress = problem_.progress;
  krylov.release = problem_.release;
  krylov.restore = problem_.restore;
  auto result = [&] {
    try {
      return solve_krylov(krylov);
    } catch (...) {
      if (krylov.restore) krylov.restore();  // another way may be tried
      throw;
    }
  }();
  if (krylov.restore) krylov.restore();
  if (result.is_singular) return false;
  if (problem_.supported) take_out(problem_.rows, problem_.M, problem_.rigid, result.vectors);
  if (krylov.start == 0 && !problem_.supported && result.values.size() < krylov.num_wanted) drop_rough(result);
  roots.add(result.values, std::move(result.vectors));
  return true;
}

int count_roots_below(Mat K, Mat M, double mu) {
  for (int attempt = 0; attempt < 4; ++attempt, mu *= 1 + 1e-9) {
    const int count = count_negative(K, -mu, M);
    if (count >= 0) return count;
  }
  return -1;
}

}  // namespace bough::modal::detail
