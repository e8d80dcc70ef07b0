#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "fe/linear/inertia.hpp"
#include "fe/linear/residual.hpp"
#include "fe/linear/symmetric_matrix.hpp"
#include "fe/loads/second_order.hpp"
#include "modal/canonical.hpp"
#include "modal/eigen.hpp"
#include "modal/extraction.hpp"
#include "modal/pencil.hpp"
#include "modal/roots.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal {

namespace {

using detail::Roots;

/// -K_G φ = θ K φ by descending |θ|; λ = 1/θ.
class BucklingModes {
 public:
  BucklingModes(const fe::System& system, const fe::AppliedLoad& load, const VectorXd& u_g, const EigenOptions& options,
                Diagnostics& diagnostics, const fe::InitialForces* initial)
      : model_(system.model),
        options_(options),
        diagnostics_(diagnostics),
        pencil_(system),
        K_G_(fe::assemble_geometric_stiffness(model_, fe::DofSet::Free, load, u_g, initial)),
        factor_(options.factor ? options.factor : system.factor) {}

  EigenPairs solve();

 private:
  /// Load factors that are sought: both signs by magnitude, or one sign.
  enum Side { Negative = -1, Both = 0, Positive = 1 };

  /// Up to `number` more, by magnitude.
  void add_roots(Side side, int number, Roots& roots);
  int count_below(Side side, double magnitude) const;
  /// The first `requested` of one side (or both), complete; `available` exist at most.
  void find(Side side, int requested, int available, Roots& roots);
  Roots find_in_range();
  Roots find_on_side(Side side, double low, double high);
  /// The first `number` in the range.
  EigenPairs make_pairs(Roots roots, int number);

  const fe::Model& model_;
  const EigenOptions& options_;
  Diagnostics& diagnostics_;
  detail::Pencil pencil_;
  linear::SymmetricMatrix K_G_, signed_K_G_;
  Side signed_as_ = Both;
  std::optional<linear::SymmetricFactor> own_factor_;
  const linear::SymmetricFactor* factor_;  ///< of K
  double largest_theta_ = 0;
  int round_ = 0, count_ = -1;
  std::vector<SolverUse> uses_;
};

Roots make_none(const detail::Pencil& pencil) { return {VectorXd(0), MatrixXd(pencil.size(), 0)}; }

void BucklingModes::add_roots(Side side, int number, Roots& roots) {
  // A: -K_G, whose positive θ are positive load factors, or K_G for the negative ones.
  const Side sign = side == Negative ? Negative : Positive;
  if (!signed_K_G_ || signed_as_ != sign) {
    signed_K_G_ = linear::scale(K_G_, -sign);
    signed_as_ = sign;
  }
  if (!factor_) factor_ = &own_factor_.emplace(pencil_.K, false);
  if (factor_->is_singular()) detail::throw_singular(pencil_, 0);
  detail::EigenProblem problem;
  problem.A = signed_K_G_;
  problem.B = pencil_.K;
  problem.factor = factor_;
  problem.solver = options_.solver;
  problem.spectrum = side == Both ? detail::Spectrum::LargestMagnitude : detail::Spectrum::LargestPositive;
  problem.max_subspace = pencil_.size() - roots.size();
  if (problem.max_subspace <= 0 || number <= 0) return;
  problem.num_wanted = std::min(number, problem.max_subspace);
  problem.deflate = roots.X;
  problem.tolerance = options_.tolerance;
  problem.start = round_++;
  problem.progress = options_.progress;
  const auto result = detail::extract(problem);
  add_use(result.by, uses_);
  if (result.values.size() == 0) return;
  // θ = 0 is the dofs that no internal force stiffens: no load buckles them.
  largest_theta_ = std::max(largest_theta_, result.values.cwiseAbs().maxCoeff());
  std::vector<int> kept;
  for (int i = 0; i < result.values.size(); ++i)
    if (std::abs(result.values(i)) > detail::kNoLoadFactor * largest_theta_ && (side == Both || result.values(i) > 0))
      kept.push_back(i);
  roots.add(sign * result.values(kept).cwiseInverse(), result.vectors(Eigen::all, kept), true);
}

/// Load factors between zero and ±magnitude, by the inertia of K ± λ K_G; -1 where a pivot stays zero.
int BucklingModes::count_below(Side side, double magnitude) const {
  int sum = 0;
  for (const int sign : {1, -1}) {
    if (side == -sign) continue;
    int count = -1;
    for (double f = magnitude; count < 0 && f < 1.001 * magnitude; f *= 1 + detail::kMoveOfLoadFactor)
      count = linear::count_negative_eigenvalues(pencil_.K, sign * f, K_G_).value_or(-1);
    if (count < 0) return -1;
    sum += count;
  }
  return sum;
}

void BucklingModes::find(Side side, int requested, int available, Roots& roots) {
  detail::RootSearch search;
  search.requested = std::min(requested, available);
  search.num_available = available;
  search.by_magnitude = true;
  search.counts = options_.check_inertia;
  search.solve = [&](Roots& known, int number) { add_roots(side, std::min(number, available - known.size()), known); };
  search.closeness = [](const Roots&, int) { return detail::kCloseness; };
  search.roundoff = [](const Roots&, int) { return 0.0; };
  search.count = [&](double mu) { return mu > 0 ? count_below(side, mu) : 0; };
  search.solve(roots, search.requested + std::max(4, requested / 10));
  const auto result = detail::search_roots(search, roots);
  detail::report_count(result, 0, "load factors", search.counts, diagnostics_);
  count_ = result.count < 0 || count_ < -1 ? -2 : std::max(count_, 0) + result.count;
  roots.keep(result.cut);
}

/// The first num_modes of one sign between two magnitudes, and those below them (they are counted with them).
Roots BucklingModes::find_on_side(Side side, double low, double high) {
  Roots roots = make_none(pencil_);
  if (!(high > low)) return roots;
  // Number of load factors that exist: without it the solver would look for the last of a kind that does not exist.
  const double end = std::min(high, 1e6 / largest_theta_);
  const int available = count_below(side, end), below = low > 0 ? count_below(side, low) : 0;
  if (available < 0 || below < 0) detail::throw_singular(pencil_, 0);
  const int requested = std::min(below + options_.num_modes, available);
  if (requested > below) find(side, requested, available, roots);
  return roots;
}

/// Within [min_hz, max_hz] of the load factor, one sign after the other.
Roots BucklingModes::find_in_range() {
  const double infinity = std::numeric_limits<double>::infinity();
  const double low = options_.min_hz.value_or(-infinity), high = options_.max_hz.value_or(infinity);
  Roots nearest = make_none(pencil_);
  add_roots(Both, 1, nearest);
  if (nearest.size() == 0) return nearest;
  Roots roots = find_on_side(Positive, std::max(low, 0.0), high);
  const Roots negative = find_on_side(Negative, std::max(-high, 0.0), -low);
  roots.add(negative.value, negative.X, true);
  return roots;
}

EigenPairs BucklingModes::make_pairs(Roots roots, int number) {
  VectorXd lambda = roots.value;
  MatrixXd X = roots.X;
  detail::orthonormalize_ascending(X.transpose() * pencil_.calc_K_times(X), X);
  detail::make_canonical(
      detail::calc_basis_weights(model_), [&](const MatrixXd& Y) { return MatrixXd(model_.T() * Y); }, lambda, X);
  std::vector<int> kept;
  for (int i = 0; i < roots.size() && static_cast<int>(kept.size()) < number; ++i)
    if (!(options_.min_hz && lambda(i) < *options_.min_hz) && !(options_.max_hz && lambda(i) > *options_.max_hz))
      kept.push_back(i);
  lambda = VectorXd(lambda(kept));
  X = MatrixXd(X(Eigen::all, kept));
  EigenPairs pairs;
  pairs.lambda = lambda;
  pairs.Phi = model_.T() * X;
  detail::fix_signs(pairs.Phi);
  pairs.inertia_count = std::max(count_, -1);
  pairs.solvers = uses_;
  pairs.residual =
      linear::calc_residuals(linear::calc_residual_scale(pencil_.K_diagonal, linear::get_diagonal(K_G_), lambda), X,
                             pencil_.calc_K_times(X), -linear::multiply(K_G_, X) * lambda.asDiagonal(), pencil_.kinds);
  linear::check_residuals(pairs.residual, "load factor", diagnostics_);
  return pairs;
}

EigenPairs BucklingModes::solve() {
  const auto rigid = detail::find_rigid_motions(pencil_);
  if (rigid.modes.cols() + rigid.massless.cols() > 0)
    throw ComputationError(
        "modal.buckling-free", {},
        "buckling needs a supported model: " + std::to_string(rigid.modes.cols() + rigid.massless.cols()) +
            " rigid-body motion(s) are free",
        "add SPC cards and select them with SPC in the case control");
  Roots roots = make_none(pencil_);
  int requested = options_.num_modes;
  if (requested > 0 && (options_.min_hz || options_.max_hz)) {
    roots = find_in_range();
  } else {
    double bound = 0;
    for (const auto& end : {options_.min_hz, options_.max_hz})
      if (end) bound = std::max(bound, std::abs(*end));
    if (requested <= 0) requested = bound > 0 ? count_below(Both, bound) : pencil_.size();
    if (requested < 0) detail::throw_singular(pencil_, 0);
    if (requested > 0) find(Both, requested, pencil_.size(), roots);
    if (roots.size() < requested && options_.num_modes > 0)
      diagnostics_.warning("modal.fewer-modes", {},
                           "the load has " + std::to_string(roots.size()) + " buckling modes, " +
                               std::to_string(requested) + " were asked for",
                           "ask for fewer");
  }
  auto pairs = make_pairs(std::move(roots), requested);
  if (pairs.lambda.size() == 0)
    diagnostics_.warning("modal.empty-range", {}, "no load factor is in the requested range",
                         "widen V1 and V2 of the card; a load that only stiffens has negative load factors alone");
  return pairs;
}

void demand_dofs(const fe::Model& model) {
  if (model.num_fdofs() == 0)
    throw ComputationError("modal.no-dofs", {}, "the model has no free dof", "check its SPC sets and rigid elements");
}

}  // namespace

EigenPairs calc_buckling_modes(const fe::Model& model, const fe::AppliedLoad& load, const VectorXd& u_g,
                               const EigenOptions& options, Diagnostics& diagnostics,
                               const fe::InitialForces* initial) {
  demand_dofs(model);
  return calc_buckling_modes(fe::System(model), load, u_g, options, diagnostics, initial);
}

EigenPairs calc_buckling_modes(const fe::System& system, const fe::AppliedLoad& load, const VectorXd& u_g,
                               const EigenOptions& options, Diagnostics& diagnostics,
                               const fe::InitialForces* initial) {
  BOUGH_DEMAND(u_g.size() == system.model.num_gdofs());
  demand_dofs(system.model);
  detail::initialize_slepc();
  return BucklingModes(system, load, u_g, options, diagnostics, initial).solve();
}

}  // namespace bough::modal
