#include "bough/modal/eigen.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "bough/fe/blas.hpp"
#include "bough/modal/canonical.hpp"
#include "bough/modal/krylov.hpp"
#include "bough/modal/pencil.hpp"

namespace bough::modal {

namespace {

using detail::Pencil;
using detail::RigidMotions;

/// Below this size, or when more than half of the eigenvalues are wanted, Krylov has nothing to offer over LAPACK-style
/// dense reduction; above the second size a dense matrix is out of the question.
constexpr int kDenseSize = 60, kDenseLimit = 4000;

double square(double x) { return x * x; }
double calc_lambda(double hz) { return square(2 * std::numbers::pi * hz); }

MatrixXd join(const MatrixXd& A, const MatrixXd& B) {
  MatrixXd C(A.rows(), A.cols() + B.cols());
  C << A, B;
  return C;
}

/// Eigenpairs found so far besides the rigid motions, ascending; the first num_zero are mechanisms: no strain either.
struct Found {
  VectorXd lambda;
  MatrixXd X;
  int num_zero = 0;

  void keep(int count) {
    lambda.conservativeResize(count);
    X.conservativeResize(Eigen::NoChange, count);
  }

  void add(const VectorXd& values, const MatrixXd& vectors) {
    VectorXd all(lambda.size() + values.size());
    all << lambda, values;
    const MatrixXd both = join(X, vectors);
    std::vector<int> order(all.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return all(a) < all(b); });
    lambda = all(order);
    X = both(Eigen::all, order);
  }
};

/// How far apart copies of one root may lie: the roundoff of K seen by this vector.
double calc_cluster_tolerance(double relative_energy) {
  return std::clamp(20 * 2.2e-16 / std::max(relative_energy, 1e-300), 1e-8, 1e-4);
}

/// Mechanisms beyond Φ_R (a pinned link, a free scalar point): eigenvalues at the level of roundoff and far below the
/// next one.
int count_zeros(const Pencil& pencil, const Found& found) {
  const auto size = static_cast<int>(found.lambda.size());
  int low = 0;
  while (low < size && pencil.calc_relative_energy(found.X.col(low), found.lambda(low)) < 1e-12) ++low;
  for (int k = low; k > 0; --k) {
    if (k < size ? std::abs(found.lambda(k - 1)) < 1e-3 * found.lambda(k)
                 : pencil.calc_relative_energy(found.X.col(k - 1), found.lambda(k - 1)) < 1e-14)
      return k;
  }
  return 0;
}

class NormalModes {
 public:
  NormalModes(const fe::Model& model, const EigenOptions& options, Diagnostics& diagnostics)
      : options_(options), diagnostics_(diagnostics), pencil_(model), rigid_(detail::find_rigid_motions(pencil_)) {}

  EigenPairs solve();

 private:
  int num_rigid() const { return static_cast<int>(rigid_.modes.cols()); }
  int num_found() const { return num_rigid() + static_cast<int>(found_.lambda.size()); }
  /// Eigenvalue by position in the whole list: rigid ones, then the found ones.
  double value(int i) const { return i < num_rigid() + found_.num_zero ? 0 : found_.lambda(i - num_rigid()); }
  int count_below(double mu) const;
  void hold_massless();
  void choose_range();
  void solve_dense();
  /// False when `definite_only` and the shifted stiffness is not definite.
  bool run_krylov(int num_wanted, int num_guard, bool definite_only = false);
  bool find_unshifted(int request, int guard);
  void find_all();
  int find_cut() const;
  EigenPairs make_pairs(int cut, int count);
  double calc_roundoff(int i) const;
  void warn_of_roundoff(const EigenPairs& pairs, const MatrixXd& X) const;

  const EigenOptions& options_;
  Diagnostics& diagnostics_;
  Pencil pencil_;
  RigidMotions rigid_;
  int max_elastic_ = 0;       ///< no more finite eigenvalues than this besides the rigid ones
  int first_ = 0, last_ = 0;  ///< positions wanted, [first, last)
  double shift_ = 0;          ///< K + shift M is definite
  int round_ = 0;
  Found found_;
};

int NormalModes::count_below(double mu) const {
  for (int attempt = 0; attempt < 4; ++attempt) {
    const int count = detail::count_negative(pencil_.K.get(), -mu, pencil_.M.get());
    if (count >= 0) return count;
    mu *= 1 + 1e-9;
  }
  detail::throw_singular(pencil_, -mu);
}

/// A spring to ground on one dof of each massless motion: strain and mass of every eigenvector are indifferent to how
/// much of the motion is in it, so nothing else changes.
void NormalModes::hold_massless() {
  if (rigid_.held.empty()) return;
  PetscInt first = 0, last = 0;
  fe::check_petsc(MatGetOwnershipRange(pencil_.K.get(), &first, &last));
  const double largest = pencil_.K_diagonal.maxCoeff();
  std::string where;
  for (const int f : rigid_.held) {
    const double stiffness = pencil_.K_diagonal(f) > 0 ? pencil_.K_diagonal(f) : largest;
    if (f >= first && f < last) fe::check_petsc(MatSetValue(pencil_.K.get(), f, f, stiffness, ADD_VALUES));
    where += (where.empty() ? "" : ", ") + detail::describe(pencil_.model, f);
  }
  fe::check_petsc(MatAssemblyBegin(pencil_.K.get(), MAT_FINAL_ASSEMBLY));
  fe::check_petsc(MatAssemblyEnd(pencil_.K.get(), MAT_FINAL_ASSEMBLY));
  diagnostics_.warning(
      "modal.massless-motion", {},
      std::to_string(rigid_.held.size()) + " rigid motion(s) have neither strain nor mass; held at " + where,
      "use a consistent mass or give the model inertia about that axis");
}

void NormalModes::choose_range() {
  max_elastic_ = static_cast<int>((pencil_.M_diagonal.array() > 0).count()) - num_rigid();
  const int available = num_rigid() + max_elastic_;
  first_ = options_.min_hz && *options_.min_hz > 0 ? count_below(calc_lambda(*options_.min_hz)) : 0;
  last_ = options_.num_modes > 0 ? first_ + options_.num_modes : available;
  if (options_.max_hz) last_ = std::min(last_, *options_.max_hz > 0 ? count_below(calc_lambda(*options_.max_hz)) : 0);
}

void NormalModes::solve_dense() {
  const int n = pencil_.size();
  const MatrixXd identity = MatrixXd::Identity(n, n);
  MatrixXd K = pencil_.calc_K_times(identity);
  MatrixXd M = pencil_.calc_M_times(identity);
  K = 0.5 * (K + K.transpose()).eval();
  M = 0.5 * (M + M.transpose()).eval();

  const VectorXd scale = M.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
  const Eigen::SelfAdjointEigenSolver<MatrixXd> mass(scale.asDiagonal() * M * scale.asDiagonal(),
                                                     Eigen::EigenvaluesOnly);
  const auto rank = static_cast<int>((mass.eigenvalues().array() > 1e-12).count());
  max_elastic_ = std::max(0, rank - num_rigid());

  // Z spans what is M-orthogonal to the rigid motions.
  MatrixXd Z = identity;
  if (num_rigid() > 0) {
    const Eigen::HouseholderQR<MatrixXd> qr(M * rigid_.modes);
    Z = MatrixXd(qr.householderQ()).rightCols(n - num_rigid());
  }
  const MatrixXd Mz = Z.transpose() * M * Z;
  const MatrixXd A = Z.transpose() * K * Z + shift_ * Mz;
  if (A.rows() == 0 || max_elastic_ == 0) {
    found_.X.resize(n, 0);
    return;
  }
  if (Eigen::LLT<MatrixXd>(A).info() != Eigen::Success) detail::throw_singular(pencil_, shift_);
  // M x = θ (K + s M) x, θ = 1/(λ + s): the massless dofs sit harmlessly at θ = 0.
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(Mz, A);
  const VectorXd theta = solver.eigenvalues().reverse().head(max_elastic_);
  MatrixXd X = Z * solver.eigenvectors().rowwise().reverse().leftCols(max_elastic_);
  X = X * theta.cwiseSqrt().cwiseInverse().asDiagonal();
  found_ = {};
  found_.X.resize(n, 0);
  found_.add(theta.cwiseInverse().array() - shift_, X);
}

bool NormalModes::run_krylov(int num_wanted, int num_guard, bool definite_only) {
  detail::KrylovProblem problem;
  problem.A = pencil_.K.get();
  problem.B = pencil_.M.get();
  problem.shift = -shift_;
  problem.max_subspace = max_elastic_ - static_cast<int>(found_.lambda.size());
  if (problem.max_subspace <= 0) return true;
  problem.num_wanted = std::min(num_wanted, problem.max_subspace);
  problem.num_guard = num_wanted <= problem.max_subspace ? num_guard : 0;
  problem.deflate = join(rigid_.modes, found_.X);
  problem.tolerance = options_.tolerance;
  problem.start = round_++;
  problem.definite_only = definite_only;
  if (shift_ == 0 && options_.factor && options_.factor->is_definite()) problem.factor = options_.factor->get();
  problem.progress = options_.progress;
  const auto result = detail::solve_krylov(problem);
  if (result.is_singular && definite_only) return false;
  if (result.is_singular) detail::throw_singular(pencil_, shift_);
  found_.add(result.values, result.vectors);
  found_.num_zero = count_zeros(pencil_, found_);
  return true;
}

/// First position at or after last_ where the list has a gap: what lies below it can be counted.
int NormalModes::find_cut() const {
  for (int c = last_; c < num_found(); ++c) {
    double tolerance = 1e-8;
    if (c > num_rigid() + found_.num_zero) {
      const int j = c - 1 - num_rigid();
      tolerance = calc_cluster_tolerance(pencil_.calc_relative_energy(found_.X.col(j), found_.lambda(j)));
    }
    const double below = c > 0 ? value(c - 1) : -shift_;
    if (value(c) - below > std::max(1e-6, 2 * tolerance) * (below + shift_)) return c;
  }
  return static_cast<int>(found_.lambda.size()) >= max_elastic_ ? num_found() : -1;
}

/// K itself as the matrix to factor, where supports hold the model: no shift to choose, and no second factor because it
/// was too high. A mechanism, or a mode too soft to tell from one, shows as a first vector with next to no strain.
bool NormalModes::find_unshifted(int request, int guard) {
  if (num_rigid() > 0 || !rigid_.held.empty()) return false;
  shift_ = 0;
  return run_krylov(request, guard, true) && found_.lambda.size() > 0 && found_.num_zero == 0 && found_.lambda(0) > 0 &&
         pencil_.calc_relative_energy(found_.X.col(0), found_.lambda(0)) > 1e-13;
}

void NormalModes::find_all() {
  constexpr int guard = 2;  // those above show the gap
  const int request = std::max(0, last_ - num_rigid()) + guard;
  const bool dense = pencil_.size() <= kDenseSize || (2 * request >= max_elastic_ && pencil_.size() <= kDenseLimit);
  found_.X.resize(pencil_.size(), 0);
  if (!dense && find_unshifted(request, guard)) return;
  shift_ = 0.01 * detail::estimate_first_eigenvalue(pencil_);
  for (int attempt = 0; attempt < 4; ++attempt) {
    found_ = {};
    found_.X.resize(pencil_.size(), 0);
    if (dense) {
      solve_dense();
      found_.num_zero = count_zeros(pencil_, found_);
    } else {
      run_krylov(request, guard);
    }
    // A shift far above the first eigenvalue costs digits: move it down and solve again.
    if (found_.num_zero >= found_.lambda.size()) return;
    const double lowest = found_.lambda(found_.num_zero);
    if (!(lowest > 0) || shift_ <= 10 * lowest) return;
    shift_ = 0.1 * lowest;
  }
}

EigenPairs NormalModes::make_pairs(int cut, int count) {
  const auto& model = pencil_.model;
  const int k = num_rigid(), num_zero = k + found_.num_zero;
  VectorXd lambda(cut);
  for (int i = 0; i < cut; ++i) lambda(i) = value(i);
  MatrixXd X(pencil_.size(), cut);
  X << rigid_.modes.leftCols(std::min(k, cut)), found_.X.leftCols(std::max(0, cut - k));

  const VectorXd weights = detail::calc_basis_weights(model);
  if (cut > k) {
    // Purification and separate Krylov runs leave the vectors orthogonal to nine digits or so: once more,
    // symmetrically.
    const MatrixXd& R = rigid_.modes;
    MatrixXd Y = X.rightCols(cut - k);
    if (k > 0) Y -= R * (pencil_.calc_M_times(R).transpose() * Y).eval();
    MatrixXd G(cut - k, cut - k);
    fe::multiply_dense(true, Y, pencil_.calc_M_times(Y), 0, G);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> gram(0.5 * (G + G.transpose()));
    fe::multiply_dense(false, Y, gram.operatorInverseSqrt(), 0, X.rightCols(cut - k));
  }
  for (int a = std::min(k, cut), b = a; a < cut; a = b) {
    if (a < num_zero) {
      b = std::min(num_zero, cut);
    } else {
      const double energy = pencil_.calc_relative_energy(X.col(a), lambda(a));
      b = detail::find_cluster_end(lambda, a, calc_cluster_tolerance(energy), 0);
    }
    const MatrixXd Y = X.middleCols(a, b - a);
    X.middleCols(a, b - a) = Y * detail::calc_cluster_rotation(weights, MatrixXd(model.T() * Y));
    lambda.segment(a, b - a).setConstant(lambda.segment(a, b - a).mean());
  }

  EigenPairs pairs;
  const int first = std::min(first_, cut), size = std::clamp(last_, first, cut) - first;
  X = X.middleCols(first, size).eval();
  pairs.lambda = lambda.segment(first, size);
  pairs.num_rigid = std::clamp(num_zero - first, 0, size);
  pairs.inertia_count = count;
  pairs.num_massless = static_cast<int>(rigid_.held.size());
  warn_of_roundoff(pairs, X);
  const MatrixXd KX = pencil_.calc_K_times(X);
  const MatrixXd R = KX - pencil_.calc_M_times(X) * pairs.lambda.asDiagonal();
  pairs.residual.resize(size);
  for (int j = 0; j < size; ++j) {
    const double scale = j < pairs.num_rigid ? pencil_.K_diagonal.cwiseProduct(X.col(j)).norm() : KX.col(j).norm();
    pairs.residual(j) = scale > 0 ? R.col(j).norm() / scale : 0;
  }
  pairs.Phi = model.T() * X;
  detail::fix_signs(pairs.Phi);
  return pairs;
}

/// Relative error of an eigenvalue by roundoff: the strain energy of a soft mode on a fine mesh is a small difference
/// of large numbers. Measured on beams of 100 to 2000 elements it is about 0.02 ε over the share of the energy that is
/// left.
double calc_roundoff_of(const Pencil& pencil, const VectorXd& x, double lambda) {
  return 0.02 * 2.2e-16 / std::max(pencil.calc_relative_energy(x, lambda), 1e-300);
}

double NormalModes::calc_roundoff(int i) const {
  const int j = i - num_rigid();
  return j < found_.num_zero ? 0 : calc_roundoff_of(pencil_, found_.X.col(j), found_.lambda(j));
}

void NormalModes::warn_of_roundoff(const EigenPairs& pairs, const MatrixXd& X) const {
  for (int j = pairs.num_rigid; j < pairs.lambda.size(); ++j) {
    const double error = calc_roundoff_of(pencil_, X.col(j), pairs.lambda(j));
    if (error < 1e-4) return;
    diagnostics_.warning("modal.roundoff", {},
                         "mode " + std::to_string(j + 1) + " is so soft on its mesh that roundoff may change its " +
                             "eigenvalue by a part in " + std::to_string(static_cast<long>(std::max(1.0, 1 / error))),
                         "use a coarser mesh: elements far shorter than the waves of the modes only add roundoff");
  }
}

EigenPairs NormalModes::solve() {
  if (!(pencil_.M_diagonal.maxCoeff() > 0))
    throw ComputationError("modal.no-mass", {}, "no free dof of the model has mass",
                           "give RHO in MAT1, NSM in a property, or CONM2 and CMASS cards");
  hold_massless();
  choose_range();
  if (last_ <= first_) {
    diagnostics_.warning("modal.empty-range", {}, "no mode lies in the frequency range asked for",
                         "widen the range of EIGRL or of --min-hz and --max-hz");
    return make_pairs(0, last_);
  }
  const int wanted = last_;
  last_ = std::min(last_, num_rigid() + max_elastic_);
  find_all();
  last_ = std::min(last_, num_rigid() + max_elastic_);
  if (last_ < wanted && options_.num_modes > 0)
    diagnostics_.warning("modal.fewer-modes", {},
                         "the model has " + std::to_string(last_ - first_) + " modes, " +
                             std::to_string(wanted - first_) + " were asked for",
                         "ask for fewer, or use a finer mesh or a consistent mass");

  constexpr int kRounds = 8;
  int count = -1, cut = -1;
  for (int round = 0; round < kRounds; ++round) {
    int missing = last_ - num_found();
    cut = -1;
    if (missing <= 0) {
      cut = find_cut();
      missing = cut < 0 ? 4 : 0;
    }
    if (missing == 0 && options_.check_inertia) {
      // Above the last one, but not in the next gap's upper half; roundoff differs between this factor and the
      // solver's.
      const double top = cut > 0 ? value(cut - 1) : -shift_;
      const double step = (top + shift_) * std::clamp(100 * calc_roundoff(cut - 1), 1e-3, 0.5);
      const double mu = top + (cut < num_found() ? std::min(0.5 * (value(cut) - top), step) : step);
      count = count_below(mu);
      missing = count - cut;
    }
    if (missing == 0) {
      if (cut > last_ && value(cut - 1) > 0)
        diagnostics_.warning("modal.cut-root", {},
                             "the last mode belongs to a repeated root: " + std::to_string(cut - last_) +
                                 " more mode(s) have the same frequency",
                             "ask for " + std::to_string(cut - first_) + " modes");
      return make_pairs(cut, count);
    }
    if (missing < 0) break;
    if (cut >= num_rigid()) found_.keep(cut - num_rigid());  // those above may be rough
    const int before = num_found();
    run_krylov(missing + 2, 0);
    if (num_found() == before) break;
  }
  throw ComputationError(
      "modal.missed-modes", {},
      "found " + std::to_string(cut < 0 ? num_found() : cut) + " modes" +
          (count < 0 ? " and converged on no more" : ", the inertia of the factor counts " + std::to_string(count)),
      "ask for more modes; look for negative springs; if stiffness spans many orders, soften the "
      "stiffest parts or use rigid elements");
}

}  // namespace

EigenPairs calc_normal_modes(const fe::Model& model, const EigenOptions& options, Diagnostics& diagnostics) {
  if (model.num_fdofs() == 0)
    throw ComputationError("modal.no-dofs", {}, "the model has no free dof", "check its SPC sets and rigid elements");
  detail::initialize_slepc();
  return NormalModes(model, options, diagnostics).solve();
}

MatrixXd calc_effective_mass(const fe::Model& model, const MatrixXd& Phi) {
  return calc_effective_mass(model, Phi, fe::calc_mass_times(model, model.mass_kind(), Phi));
}

MatrixXd calc_effective_mass(const fe::Model& model, const MatrixXd& Phi, const MatrixXd& M_Phi) {
  const MatrixXd L = M_Phi.transpose() * model.calc_rigid_modes();
  const VectorXd modal_mass = Phi.cwiseProduct(M_Phi).colwise().sum();
  return modal_mass.cwiseInverse().asDiagonal() * L.cwiseAbs2();
}

}  // namespace bough::modal
