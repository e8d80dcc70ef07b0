#include "bough/modal/eigen.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "bough/fe/blas.hpp"
#include "bough/fe/residual.hpp"
#include "bough/modal/canonical.hpp"
#include "bough/modal/krylov.hpp"
#include "bough/modal/pencil.hpp"
#include "bough/modal/pencil_solver.hpp"

namespace bough::modal {

namespace {

using detail::Pencil;
using detail::RigidMotions;
using detail::Roots;

double square(double x) { return x * x; }
double calc_lambda(double hz) { return square(2 * std::numbers::pi * hz); }

/// How far apart copies of one root may lie: the roundoff of K seen by this vector.
double calc_cluster_tolerance(double relative_energy) {
  return std::clamp(20 * 2.2e-16 / std::max(relative_energy, 1e-300), 1e-8, 1e-4);
}

/// Mechanisms beyond Φ_R (a pinned link, a free scalar point): eigenvalues at the level of roundoff and far below the
/// next one.
int count_zeros(const Pencil& pencil, const Roots& found) {
  int low = 0;
  while (low < found.size() && pencil.calc_relative_energy(found.X.col(low), found.value(low)) < 1e-12) ++low;
  for (int k = low; k > 0; --k) {
    if (k < found.size() ? std::abs(found.value(k - 1)) < 1e-3 * found.value(k)
                         : pencil.calc_relative_energy(found.X.col(k - 1), found.value(k - 1)) < 1e-14)
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
  /// Eigenvalue by position in the whole list: rigid ones, then the found ones.
  double value(int i) const { return i < num_rigid() + num_zero_ ? 0 : found_.value(i - num_rigid()); }
  int count_below(double hz) const;
  void hold_massless();
  void choose_range(detail::KrylovMethod method);
  /// False when `definite_only` and the shifted stiffness is not definite.
  bool add_roots(Roots& roots, int number, int guard, bool definite_only = false);
  void find_first();
  detail::RootSearchResult search();
  bool fit_range(int cut);
  bool has_every_root();
  /// The modes by one method; `is_sound` false where it missed some or left a residual.
  EigenPairs find_pairs(detail::KrylovMethod method, bool& is_sound, Diagnostics& said);
  EigenPairs make_pairs(int cut, int count, Diagnostics& said);
  double calc_roundoff(const Roots& roots, int i) const;
  void warn_of_roundoff(const EigenPairs& pairs, const MatrixXd& X, Diagnostics& said) const;

  const EigenOptions& options_;
  Diagnostics& diagnostics_;
  Pencil pencil_;
  RigidMotions rigid_;
  std::vector<std::pair<int, double>> springs_;  ///< f-dofs of the massless motions, held by them in K
  std::optional<detail::PencilSolver> solver_;
  int first_ = 0, last_ = 0;  ///< positions wanted, [first, last)
  double shift_ = 0;          ///< K + shift M is definite
  Roots found_;               ///< besides the rigid motions, ascending
  int num_zero_ = 0;          ///< mechanisms among them, first: no strain either
  double overlap_ = 0;        ///< how far the vectors found were from M-orthonormal
};

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
    springs_.emplace_back(f, stiffness);
    where += (where.empty() ? "" : ", ") + detail::describe(pencil_.model, f);
  }
  fe::check_petsc(MatAssemblyBegin(pencil_.K.get(), MAT_FINAL_ASSEMBLY));
  fe::check_petsc(MatAssemblyEnd(pencil_.K.get(), MAT_FINAL_ASSEMBLY));
  diagnostics_.warning(
      "modal.massless-motion", {},
      std::to_string(rigid_.held.size()) + " rigid motion(s) have neither strain nor mass; held at " + where,
      "use a consistent mass or give the model inertia about that axis");
}

int NormalModes::count_below(double hz) const {
  if (!(hz > 0)) return 0;
  const int count = detail::count_roots_below(pencil_.K.get(), pencil_.M.get(), calc_lambda(hz));
  if (count < 0) detail::throw_singular(pencil_, -calc_lambda(hz));
  return count;
}

void NormalModes::choose_range(detail::KrylovMethod method) {
  first_ = options_.min_hz ? count_below(*options_.min_hz) : 0;
  last_ = options_.num_modes > 0 ? first_ + options_.num_modes : pencil_.size();
  if (options_.max_hz) last_ = std::min(last_, count_below(*options_.max_hz));
  detail::PencilProblem problem;
  problem.K = pencil_.K.get();
  problem.M = pencil_.M.get();
  problem.M_diagonal = pencil_.M_diagonal;
  problem.rigid = rigid_.modes;
  // hold_massless() puts springs into K that the caller's factor has not.
  if (rigid_.held.empty()) problem.factor = options_.factor;
  problem.tolerance = options_.tolerance;
  problem.method = method;
  problem.progress = options_.progress;
  solver_.emplace(problem, std::max(0, last_ - num_rigid()));
}

bool NormalModes::add_roots(Roots& roots, int number, int guard, bool definite_only) {
  if (!solver_->solve(shift_, number, guard, definite_only, roots)) {
    if (definite_only) return false;
    detail::throw_singular(pencil_, shift_);
  }
  num_zero_ = count_zeros(pencil_, roots);
  return true;
}

/// K itself is factored where supports hold the model: no shift to choose, and no second factor because it was too
/// high. A mechanism, or a mode too soft to tell from one, shows as a first vector with next to no strain.
void NormalModes::find_first() {
  constexpr int guard = 2;  // those above show the gap
  const int request = std::max(0, last_ - num_rigid()) + guard;
  const Roots none{VectorXd(0), MatrixXd(pencil_.size(), 0)};
  found_ = none;
  shift_ = 0;
  if (num_rigid() == 0 && rigid_.held.empty() && add_roots(found_, request, guard, true) && found_.size() > 0 &&
      num_zero_ == 0 && found_.value(0) > 0 && pencil_.calc_relative_energy(found_.X.col(0), found_.value(0)) > 1e-13)
    return;
  shift_ = 0.01 * detail::estimate_first_eigenvalue(pencil_);
  for (int attempt = 0; attempt < 6; ++attempt) {
    found_ = none;
    add_roots(found_, request, guard);
    // A shift far above the first eigenvalue with strain costs digits, and the vectors where it is out of all
    // proportion; one far below it lets the motions without strain into them: move it by what the strain energies say.
    const VectorXd energy = found_.X.cwiseProduct(pencil_.calc_K_times(found_.X)).colwise().sum();
    double lowest = 0;
    for (int i = 0; i < found_.size(); ++i)
      if (pencil_.calc_relative_energy(found_.X.col(i), energy(i)) > 1e-12 && (lowest == 0 || energy(i) < lowest))
        lowest = energy(i);
    if (!(lowest > 0) || (shift_ <= 10 * lowest && shift_ >= 1e-5 * lowest)) return;
    shift_ = 0.1 * lowest;
  }
}

detail::RootSearchResult NormalModes::search() {
  detail::RootSearch search;
  search.wanted = std::min(last_ - num_rigid(), solver_->num_available());
  search.num_available = solver_->num_available();
  search.counts = options_.check_inertia;
  search.lowest = num_rigid() > 0 ? 0 : -shift_;
  search.shift = shift_;
  search.solve = [&](Roots& roots, int number) { add_roots(roots, number, 0); };
  search.closeness = [&](const Roots& roots, int i) {
    if (i + 1 < num_zero_) return std::numeric_limits<double>::infinity();  // zeros are copies of each other
    if (i < num_zero_) return 1e-8;
    return calc_cluster_tolerance(pencil_.calc_relative_energy(roots.X.col(i), roots.value(i)));
  };
  search.roundoff = [&](const Roots& roots, int i) { return calc_roundoff(roots, i); };
  search.count = [&](double mu) {
    const int count = detail::count_roots_below(pencil_.K.get(), pencil_.M.get(), mu);
    return count < 0 ? -1 : count - num_rigid();
  };
  return detail::search_roots(search, found_);
}

/// The ends of the range by the roots themselves: the count that guessed them is off where parts move without strain
/// and with next to no mass. True when the list is too short for the range.
bool NormalModes::fit_range(int cut) {
  if (!options_.min_hz && !options_.max_hz) return false;
  const auto count_values = [&](const std::optional<double>& hz) {
    int n = 0;
    while (hz && n < cut && value(n) < calc_lambda(std::max(*hz, 0.0))) ++n;
    return n;
  };
  const int first = count_values(options_.min_hz), before = last_;
  int last = options_.num_modes > 0 ? first + options_.num_modes : last_;
  if (options_.max_hz) {
    const int above = count_values(options_.max_hz);  // the list's end says nothing of what comes after it
    last = std::min(last, above < cut ? above : std::max(before, above));
  }
  first_ = first;
  last_ = std::max(first, last);
  return last_ > before && last_ > cut && cut < num_rigid() + solver_->num_available();
}

/// Whether as many roots as M has rank are found, each a root indeed: then no count can find more.
bool NormalModes::has_every_root() {
  if (!solver_->knows_rank()) return false;
  add_roots(found_, solver_->num_available() - found_.size(), 0);
  if (found_.size() < solver_->num_available()) return false;
  const VectorXd residual =
      fe::calc_residuals(fe::calc_residual_scale(pencil_.K_diagonal, pencil_.M_diagonal, found_.value), found_.X,
                         pencil_.calc_K_times(found_.X), pencil_.calc_M_times(found_.X) * found_.value.asDiagonal());
  return residual.size() > 0 && residual.maxCoeff() <= fe::kResidualError;
}

EigenPairs NormalModes::make_pairs(int cut, int count, Diagnostics& said) {
  const auto& model = pencil_.model;
  const int k = num_rigid(), num_zero = k + num_zero_;
  VectorXd lambda(cut);
  for (int i = 0; i < cut; ++i) lambda(i) = value(i);
  MatrixXd X(pencil_.size(), cut);
  X << rigid_.modes.leftCols(std::min(k, cut)), found_.X.leftCols(std::max(0, cut - k));

  const VectorXd weights = detail::calc_basis_weights(model);
  if (cut > k) {
    // Purification and separate Krylov runs leave the vectors orthogonal to nine digits or so: once more.
    const MatrixXd& R = rigid_.modes;
    MatrixXd Y = X.rightCols(cut - k);
    if (k > 0) Y -= R * (pencil_.calc_M_times(R).transpose() * Y).eval();
    MatrixXd G(cut - k, cut - k);
    fe::multiply_dense(true, Y, pencil_.calc_M_times(Y), 0, G);
    overlap_ = (G - MatrixXd::Identity(cut - k, cut - k)).cwiseAbs().maxCoeff();
    detail::orthonormalize_ascending(G, Y);
    X.rightCols(cut - k) = Y;
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
  warn_of_roundoff(pairs, X, said);
  MatrixXd KX = pencil_.calc_K_times(X);
  for (const auto& [f, stiffness] : springs_) KX.row(f) -= stiffness * X.row(f);  // rigid motions move them
  pairs.residual = fe::calc_residuals(fe::calc_residual_scale(pencil_.K_diagonal, pencil_.M_diagonal, pairs.lambda), X,
                                      KX, pencil_.calc_M_times(X) * pairs.lambda.asDiagonal());
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

double NormalModes::calc_roundoff(const Roots& roots, int i) const {
  return i < num_zero_ ? 1 : calc_roundoff_of(pencil_, roots.X.col(i), roots.value(i));
}

void NormalModes::warn_of_roundoff(const EigenPairs& pairs, const MatrixXd& X, Diagnostics& said) const {
  for (int j = pairs.num_rigid; j < pairs.lambda.size(); ++j) {
    const double error = calc_roundoff_of(pencil_, X.col(j), pairs.lambda(j));
    if (error < 1e-4) return;
    said.warning("modal.roundoff", {},
                 "mode " + std::to_string(j + 1) + " is so soft on its mesh that roundoff may change its " +
                     "eigenvalue by a part in " + std::to_string(static_cast<long>(std::max(1.0, 1 / error))),
                 "use a coarser mesh: elements far shorter than the waves of the modes only add roundoff");
  }
}

EigenPairs NormalModes::find_pairs(detail::KrylovMethod method, bool& is_sound, Diagnostics& said) {
  choose_range(method);
  is_sound = true;
  if (last_ <= first_) {
    said.warning("modal.empty-range", {}, "no mode lies in the frequency range asked for",
                 "widen the range of EIGRL or of --min-hz and --max-hz");
    found_ = {VectorXd(0), MatrixXd(pencil_.size(), 0)};
    num_zero_ = 0;
    return make_pairs(0, last_, said);
  }
  find_first();
  auto result = search();
  for (int round = 0; round < 3 && fit_range(num_rigid() + result.cut); ++round) result = search();
  const int wanted = last_, cut = num_rigid() + result.cut;
  if (result.is_missing && has_every_root()) {
    result.is_missing = false;
    std::swap(result.doubtful, result.count);
    result.count = -1;
  }
  if (result.is_missing) {
    is_sound = false;
    if (method == detail::KrylovMethod::Fastest) return {};  // another method may find them
  }
  detail::report_count(result, num_rigid(), "modes", options_.check_inertia, said);
  last_ = std::min(last_, cut);
  if (last_ < wanted && options_.num_modes > 0)
    said.warning("modal.fewer-modes", {},
                 "the model has " + std::to_string(std::max(0, last_ - first_)) + " modes, " +
                     std::to_string(wanted - first_) + " were asked for",
                 "ask for fewer, or use a finer mesh or a consistent mass");
  if (cut > last_ && last_ > 0 && value(cut - 1) > 0 && value(last_) - value(last_ - 1) <= 3e-4 * value(last_))
    said.warning("modal.cut-root", {},
                 "the last mode belongs to a repeated root: " + std::to_string(cut - last_) +
                     " more mode(s) have the same frequency",
                 "ask for " + std::to_string(cut - first_) + " modes");
  auto pairs = make_pairs(cut, result.count < 0 ? -1 : num_rigid() + result.count, said);
  // As many vectors as modes, orthogonal and each with a small residual: they are there, whatever the pivots say.
  if (options_.check_inertia && result.count < 0) is_sound = overlap_ < 1e-6;
  is_sound = is_sound && (pairs.residual.size() == 0 || pairs.residual.maxCoeff() <= fe::kResidualError);
  return pairs;
}

EigenPairs NormalModes::solve() {
  if (!(pencil_.M_diagonal.maxCoeff() > 0))
    throw ComputationError("modal.no-mass", {}, "no free dof of the model has mass",
                           "give RHO in MAT1, NSM in a property, or CONM2 and CMASS cards");
  hold_massless();
  bool is_sound = false;
  Diagnostics said;
  auto pairs = find_pairs(detail::KrylovMethod::Fastest, is_sound, said);
  if (!is_sound) {
    said = {};
    pairs = find_pairs(detail::KrylovMethod::Blocks, is_sound, said);
  }
  for (const auto& item : said.items()) diagnostics_.add(item);
  fe::check_residuals(pairs.residual, "mode", diagnostics_);
  return pairs;
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
