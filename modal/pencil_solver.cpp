#include "bough/modal/pencil_solver.hpp"

#include <algorithm>
#include <cmath>

#include "bough/fe/blas.hpp"
#include "bough/fe/mechanism.hpp"

namespace bough::modal::detail {
namespace {

constexpr Eigen::Index kBlock = 24;  ///< right-hand sides at once

MatrixXd symmetrize(const MatrixXd& A) { return 0.5 * (A + A.transpose()); }

/// The columns far above the first were found beside values 1e6 times theirs and more: the lower vectors taken out of
/// them, they are solved among themselves, where K has their digits.
void refine_high(const PencilProblem& problem, Roots& roots, double shift) {
  const VectorXd distance = (roots.value.array() + shift).abs();
  int low = 0;
  while (low < roots.size() && distance(low) <= 1e6 * distance(0)) ++low;
  const int high = roots.size() - low;
  if (high == 0) return;
  const MatrixXd below = join(problem.rigid, roots.X.leftCols(low));
  MatrixXd X = roots.X.rightCols(high);
  for (int pass = 0; pass < 2; ++pass) {
    if (below.cols() > 0) X -= below * (fe::multiply(problem.M, below).transpose() * X).eval();
    const VectorXd mass = X.cwiseProduct(fe::multiply(problem.M, X)).colwise().sum();
    X = (X * mass.cwiseMax(1e-300).cwiseSqrt().cwiseInverse().asDiagonal()).eval();
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> ritz(symmetrize(X.transpose() * fe::multiply(problem.K, X)),
                                                                symmetrize(X.transpose() * fe::multiply(problem.M, X)));
  if (ritz.info() != Eigen::Success) return;
  roots.value.tail(high) = ritz.eigenvalues();
  roots.X.rightCols(high) = X * ritz.eigenvectors();
}

}  // namespace

PencilSolver::PencilSolver(const PencilProblem& problem, int request) : problem_(problem) {
  const auto k = static_cast<int>(problem.rigid.cols());
  num_available_ = std::max(0, static_cast<int>((problem.M_diagonal.array() > 0).count()) - k);
  C_ = factor_low_rank(problem.M, problem.M_diagonal, std::min(3 * request + 100 + k, 4000));
  if (C_) num_available_ = std::max(0, static_cast<int>(C_->cols()) - k);
}

void PencilSolver::take_out_rigid(MatrixXd& X) const {
  if (!problem_.supported || problem_.rigid.cols() == 0) return;
  for (int pass = 0; pass < 2; ++pass)
    X -= problem_.rigid * (fe::multiply(problem_.M, problem_.rigid).transpose() * X).eval();
}

bool PencilSolver::solve_whole(double shift, int number, bool definite_only, Roots& roots) {
  const auto r = C_->cols(), k = problem_.rigid.cols();
  const fe::PetscMat shifted = shift == 0 ? fe::PetscMat() : add(problem_.K, shift, problem_.M);
  Mat A = problem_.supported ? problem_.supported : shift == 0 ? problem_.K : shifted.get();
  std::optional<fe::SymmetricFactor> own;
  const fe::SymmetricFactor* factor = shift == 0 && !problem_.supported ? problem_.factor : nullptr;
  if (!factor) factor = &own.emplace(A, false);
  if (factor->is_singular()) return false;
  if (definite_only && fe::initialize_petsc().size == 1 && !factor->is_definite()) return false;
  // With a shift, mechanisms have the energy of their mass: little, but not roundoff.
  if ((k == 0 || problem_.supported) &&
      fe::calc_softest_energy(A, *factor) < (shift == 0 ? fe::kMechanismEnergy : 3e-16))
    return false;

  MatrixXd G(r, r);
  for (Eigen::Index first = 0; first < r; first += kBlock) {
    const auto size = std::min(kBlock, r - first);
    G.middleCols(first, size) = C_->transpose() * factor->solve(MatrixXd(C_->middleCols(first, size)));
  }
  // Z: what is orthogonal to the rigid motions, whose Cᵀx are orthonormal.
  MatrixXd Z = MatrixXd::Identity(r, r);
  if (k > 0) {
    const Eigen::HouseholderQR<MatrixXd> qr(MatrixXd(C_->transpose() * problem_.rigid));
    Z = MatrixXd(qr.householderQ()).rightCols(r - k);
  }
  if (Z.cols() == 0) return true;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(symmetrize(Z.transpose() * G * Z));
  const VectorXd lambda = solver.eigenvalues().cwiseInverse().array() - shift;
  std::vector<int> order;
  for (int i = 0; i < lambda.size(); ++i)
    if (std::isfinite(lambda(i))) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return lambda(a) < lambda(b); });
  order.resize(std::min(order.size(), static_cast<std::size_t>(roots.size() + number)));

  Roots all;
  all.value = lambda(order);
  all.X.resize(C_->rows(), all.size());
  const MatrixXd Y = Z * solver.eigenvectors()(Eigen::all, order);
  for (Eigen::Index first = 0; first < Y.cols(); first += kBlock) {
    const auto size = std::min(kBlock, Y.cols() - first);
    all.X.middleCols(first, size) = factor->solve(MatrixXd(*C_ * Y.middleCols(first, size))) *
                                    (all.value.segment(first, size).array() + shift).matrix().asDiagonal();
  }
  take_out_rigid(all.X);
  refine_high(problem_, all, shift);
  roots = Roots{VectorXd(0), MatrixXd(C_->rows(), 0)};
  roots.add(all.value, all.X);
  return true;
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
  krylov.start = round_++;
  krylov.definite_only = definite_only;
  krylov.method = problem_.method;
  if (shift == 0 && !problem_.supported && problem_.factor && problem_.factor->is_definite())
    krylov.factor = problem_.factor->get();
  krylov.progress = problem_.progress;
  auto result = solve_krylov(krylov);
  if (result.is_singular) return false;
  take_out_rigid(result.vectors);
  roots.add(result.values, result.vectors);
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
