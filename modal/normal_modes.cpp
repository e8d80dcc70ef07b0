#include "modal/normal_modes.hpp"

#include <algorithm>
#include <cmath>

#include "fe/linear/blas.hpp"
#include "fe/linear/memory_need.hpp"
#include "fe/linear/symmetric_matrix.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/matrices/system.hpp"
#include "modal/canonical.hpp"
#include "modal/eps_types.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::detail {
namespace {

/// Springs from ground to f-dofs, each as stiff as K is there.
std::vector<std::pair<int, double>> make_springs(const std::vector<int>& dofs, const VectorXd& K_diagonal) {
  std::vector<std::pair<int, double>> springs;
  const double largest = K_diagonal.maxCoeff(), plain = largest > 0 ? largest : 1;
  for (const int f : dofs) springs.emplace_back(f, K_diagonal(f) > 0 ? K_diagonal(f) : plain);
  return springs;
}

/// Releases the memory of many vectors: the next ones are longer and would not fit there.
void release_columns(Eigen::Index number) {
  if (number > kColumnsAtOnce) linear::release_freed_memory();
}

}  // namespace

void NormalModes::add_supports() {
  if (rigid_.supports.empty()) return;
  supported_ = linear::add_diagonal(pencil_.K, make_springs(rigid_.supports, pencil_.K_diagonal));
}

void warn_of_cut_root(int num_more, Diagnostics& diagnostics) {
  const std::string more = std::to_string(num_more);
  diagnostics.warning("modal.cut-root", {},
                      "the last mode belongs to a repeated root: " + more + " more mode(s) have the same frequency",
                      "ask for " + more + " more");
}

void warn_of_fewer(int found, int requested, bool is_range, Diagnostics& diagnostics) {
  diagnostics.warning("modal.fewer-modes", {},
                      "the model has " + std::to_string(found) + " modes" +
                          (is_range ? " from the start of the range on, " : ", ") + std::to_string(requested) +
                          " were asked for",
                      "ask for fewer, or use a finer mesh or a consistent mass");
}

EigenPairs NormalModes::answer_nothing(Diagnostics& diagnostics) {
  diagnostics.warning("modal.empty-range", {}, "no mode is in the requested frequency range",
                      "widen the range of EIGRL or of --min-hz and --max-hz");
  found_ = {VectorXd(0), MatrixXd(pencil_.size(), 0)};
  num_zero_ = 0;
  return make_pairs(0, range_.last, diagnostics);
}

/// A spring to ground on one dof of each massless motion: strain and mass of every eigenvector are indifferent to how
/// much of the motion is in it, so nothing else changes.
void NormalModes::hold_massless(Diagnostics& diagnostics) {
  if (rigid_.held.empty()) return;
  springs_ = make_springs(rigid_.held, pencil_.K_diagonal);
  pencil_.K = linear::add_diagonal(pencil_.K, springs_);  // the system's own stays as it is
  has_own_stiffness_ = false;
  std::string where;
  for (const int f : rigid_.held) where += (where.empty() ? "" : ", ") + describe(pencil_.model, f);
  diagnostics.warning(
      "modal.massless-motion", {},
      std::to_string(rigid_.held.size()) + " rigid-body motion(s) have neither strain nor mass; held at " + where,
      "use a consistent mass or give the model inertia about that axis");
}

/// Estimate by the inertia, -1 if the factor fails; the computed eigenvalues decide (fit_range).
int NormalModes::count_below(double lambda) const {
  return lambda > 0 ? count_roots_below(pencil_.K, pencil_.M, lambda) : 0;
}

void NormalModes::choose_range() {
  range_.first = options_.min_hz ? std::max(0, count_below(calc_lower(options_))) : 0;
  range_.last = options_.num_modes > 0 ? range_.first + options_.num_modes : pencil_.size();
  if (options_.max_hz) {
    const int below = count_below(calc_upper(options_));
    range_.last = std::min(range_.last, below >= 0 ? below : range_.first + 10);
  }
}

void NormalModes::make_solver(const std::string& eps_type) {
  PencilProblem problem;
  problem.K = pencil_.K;
  problem.M = pencil_.M;
  problem.M_diagonal = pencil_.M_diagonal;
  problem.kinds = pencil_.kinds;
  problem.rigid = rigid_.modes;
  problem.supported = supported_;
  problem.is_complete = rigid_.is_complete;
  // hold_massless() puts springs into K that the caller's factor has not.
  if (rigid_.held.empty()) problem.factor = factor_;
  problem.tolerance = options_.tolerance;
  problem.solver = eps_type;
  problem.progress = options_.progress;
  // Beside the factor and the vectors of Lanczos K is an eighth of the memory; it is made again in a thirtieth of the
  // time.
  if (has_own_stiffness_ && pencil_.size() >= options_.least_rows_to_release) {
    problem.release = [this] { is_away_ = fe::drop_stiffness(pencil_.K); };
    problem.restore = [this] {
      if (!std::exchange(is_away_, false)) return;
      linear::release_freed_memory();  // of the factor and of the assembly
      fe::restore_stiffness(pencil_.model, pencil_.K);
      linear::release_freed_memory();
    };
  }
  solver_.emplace(problem, std::max(0, range_.last - num_rigid()));
}

bool NormalModes::add_roots(Roots& roots, int number, int guard, bool definite_only) {
  if (!solver_->solve(shift_, number, guard, definite_only, roots)) {
    if (definite_only) return false;
    throw_singular(pencil_, shift_);
  }
  num_zero_ = knows_motions() ? 0 : count_zeros(pencil_, roots);
  return true;
}

/// K itself is factored where supports hold the model: no shift to choose, and no second factor because it was too
/// high. A mechanism, or a mode too soft to tell from one, shows as a first vector with negligible strain.
void NormalModes::find_first() {
  constexpr int guard = 2;  // those above show the gap
  const int request = std::max(0, range_.last - num_rigid()) + guard;
  const Roots none{VectorXd(0), MatrixXd(pencil_.size(), 0)};
  found_ = none;
  shift_ = 0;
  if (has_supports()) {
    add_roots(found_, request, guard);
    return;
  }
  if (num_rigid() == 0 && rigid_.held.empty() && add_roots(found_, request, guard, true) && found_.size() > 0 &&
      num_zero_ == 0 && found_.value(0) > 0 &&
      pencil_.calc_relative_energy(found_.X.col(0), found_.value(0)) > kStrainlessEnergy)
    return;
  shift_ = kShiftOfEstimate * estimate_first_eigenvalue(pencil_);
  for (int attempt = 0; attempt < 6; ++attempt) {
    found_ = none;
    add_roots(found_, request, guard);
    // A shift far above the first eigenvalue with strain costs digits, and the vectors where it is out of all
    // proportion; one far below it lets the zero-energy motions into them: move it by what the strain energies say.
    const VectorXd energy = found_.X.cwiseProduct(pencil_.calc_K_times(found_.X)).colwise().sum();
    double lowest = 0;
    for (int i = 0; i < found_.size(); ++i)
      if (pencil_.calc_relative_energy(found_.X.col(i), energy(i)) > kStrainedEnergy &&
          (lowest == 0 || energy(i) < lowest))
        lowest = energy(i);
    if (!(lowest > 0) || (shift_ <= kMaxShift * lowest && shift_ >= kMinShift * lowest)) break;
    shift_ = kShiftOfFirst * lowest;
  }
  if (pencil_.model.prestress()) find_negative();
}

/// Finds a shift >= shift_ for which K + shift M is positive definite; 0 if none of the trials is.
double NormalModes::find_definite_shift() const {
  const auto is_above = [&](double shift) { return count_roots_below(pencil_.K, pencil_.M, -shift) == 0; };
  double shift = shift_;
  for (int attempt = 0; attempt < 30 && !is_above(shift); ++attempt) shift *= 4;
  return shift == shift_ || is_above(shift) ? shift : 0;
}

/// Stress may leave a free body roots below zero (fe.preload-tips): the shift goes below the lowest of them.
void NormalModes::find_negative() {
  const double shift = find_definite_shift();
  if (!(shift > shift_)) return;
  shift_ = shift;
  found_ = {VectorXd(0), MatrixXd(pencil_.size(), 0)};
  add_roots(found_, std::max(0, range_.last - num_rigid()) + 2, 2);
}

/// A spring may leave single roots so far below zero that Lanczos sees nothing of them from near the others: `missing`
/// more by a shift below all, then back. False if there is no such shift.
bool NormalModes::add_far_below(int missing) {
  const double near = shift_, far = shift_ > 0 ? find_definite_shift() : 0;
  if (!(far > near)) return false;
  shift_ = far;
  add_roots(found_, missing, 0);
  shift_ = near;
  return true;
}

RootSearchResult NormalModes::search() {
  RootSearch search;
  search.requested = std::min(range_.last - num_rigid(), solver_->num_available());
  search.num_available = solver_->num_available();
  search.counts = options_.check_inertia;
  search.lowest = num_rigid() > 0 && !(found_.size() > 0 && found_.value(0) < 0) ? 0 : -shift_;
  search.shift = shift_;
  search.solve = [&](Roots& roots, int number) { add_roots(roots, number, 0); };
  search.closeness = [&](const Roots& roots, int i) {
    if (i + 1 < num_zero_) return std::numeric_limits<double>::infinity();  // zeros are copies of each other
    if (i < num_zero_) return kCloseness;
    return calc_cluster_tolerance(pencil_, roots.X.col(i), roots.value(i));
  };
  search.roundoff = [&](const Roots& roots, int i) {
    return i < num_zero_ ? 1 : calc_roundoff(pencil_, roots.X.col(i), roots.value(i));
  };
  search.count = [&](double mu) {
    const int count = count_roots_below(pencil_.K, pencil_.M, mu);
    return count < 0 ? -1 : count - num_rigid();
  };
  return search_roots(search, found_);
}

bool NormalModes::fit_range(int cut) {
  VectorXd lambda(num_rigid() + found_.size());
  for (int i = 0; i < lambda.size(); ++i) lambda(i) = value(i);
  return range_.fit(options_, lambda, cut, num_rigid() + solver_->num_available());
}

/// Returns true if as many eigenvalues as the rank of M are found and verified: then no count can find more.
bool NormalModes::has_every_root() {
  if (!solver_->knows_rank()) return false;
  add_roots(found_, solver_->num_available() - found_.size(), 0);
  if (found_.size() < solver_->num_available()) return false;
  const VectorXd residual =
      linear::calc_pair_residuals(pencil_.K_diagonal, pencil_.M_diagonal, found_.value, found_.X,
                                  pencil_.calc_K_times(found_.X), pencil_.calc_M_times(found_.X), pencil_.kinds);
  return residual.size() > 0 && residual.maxCoeff() <= linear::kResidualError;
}

EigenPairs NormalModes::make_pairs(int cut, int count, Diagnostics& diagnostics) {
  const int k = std::min(num_rigid(), cut);
  Found found{VectorXd(cut), MatrixXd(pencil_.size(), cut), k, num_rigid() + num_zero_};
  for (int i = 0; i < cut; ++i) found.lambda(i) = value(i);
  found.X << rigid_.modes.leftCols(k), found_.X.leftCols(cut - k);
  found_.X.resize(0, 0);
  release_columns(cut);
  found.first = std::min(range_.first, cut);
  found.size = std::clamp(range_.last, found.first, cut) - found.first;
  return finish_pairs(std::move(found), count, diagnostics);
}

/// Residuals, computed for some columns at a time.
VectorXd NormalModes::calc_residuals(const VectorXd& lambda, const MatrixXd& X) const {
  VectorXd residual(X.cols());
  for (Eigen::Index c = 0; c < X.cols(); c += kColumnsAtOnce) {
    const auto num = std::min(kColumnsAtOnce, X.cols() - c);
    const auto some = X.middleCols(c, num);
    MatrixXd KX = pencil_.calc_K_times(some);
    for (const auto& [f, stiffness] : springs_) KX.row(f) -= stiffness * some.row(f);  // rigid-body motions move them
    residual.segment(c, num) =
        linear::calc_pair_residuals(pencil_.K_diagonal, pencil_.M_diagonal, lambda.segment(c, num), some, KX,
                                    pencil_.calc_M_times(some), pencil_.kinds);
  }
  return residual;
}

EigenPairs NormalModes::finish_pairs(Found found, int count, Diagnostics& diagnostics) {
  const auto& model = pencil_.model;
  auto& [lambda, X, k, num_zero, first, size] = found;
  const auto cut = static_cast<int>(lambda.size());
  if (cut > k) {
    // Purification and separate Krylov runs leave the vectors orthogonal to nine digits or so: again.
    const MatrixXd& R = rigid_.modes;
    MatrixXd Y = k > 0 ? MatrixXd(X.rightCols(cut - k)) : std::move(X);
    if (R.cols() > 0) Y -= R * pencil_.dot(pencil_.calc_M_times(R), Y);
    const MatrixXd G = pencil_.calc_mass_gram(Y);
    overlap_ = (G - MatrixXd::Identity(cut - k, cut - k)).cwiseAbs().maxCoeff();
    orthonormalize_ascending(G, Y);
    if (k > 0)
      X.rightCols(cut - k) = Y;
    else
      X = std::move(Y);
  }
  release_columns(cut);
  const auto find_end = [&, &lambda = lambda, &X = X, num_zero = num_zero](int a) {
    if (a < num_zero) return std::min(num_zero, cut);
    return find_cluster_end(lambda, a, calc_cluster_tolerance(pencil_, X.col(a), lambda(a)), 0);
  };
  make_canonical(
      calc_basis_weights(model), k, find_end, [&](const MatrixXd& Y) { return MatrixXd(model.T() * Y); }, lambda, X);
  EigenPairs pairs;
  pairs.Phi = fe::expand(model, X);
  if (cut > 0) {
    // Where constraints have large factors, sums over the matrix of the f-set lose digits that those over elements
    // have.
    const MatrixXd G = fe::calc_mass_gram(model, model.mass_kind(), pairs.Phi);
    if ((G - MatrixXd::Identity(cut, cut)).cwiseAbs().maxCoeff() > kElementMassError) {
      orthonormalize_ascending(G, X);
      pairs.Phi = fe::expand(model, X);
    } else {
      pairs.modal_mass = G.diagonal();
    }
  }

  if (size < cut) {
    X = X.middleCols(first, size).eval();
    pairs.Phi = pairs.Phi.middleCols(first, size).eval();
    if (pairs.modal_mass.size() > 0) pairs.modal_mass = pairs.modal_mass.segment(first, size).eval();
  }
  pairs.lambda = lambda.segment(first, size);
  pairs.num_rigid = std::clamp(num_zero - first, 0, size);
  pairs.inertia_count = count;
  pairs.num_massless = static_cast<int>(rigid_.held.size());
  warn_of_roundoff(pencil_, pairs.lambda, X, pairs.num_rigid, diagnostics);
  worst_roundoff_ = 0;
  pairs.energy_share.resize(size);
  for (int j = 0; j < size; ++j) {
    pairs.energy_share(j) = pencil_.calc_relative_energy(X.col(j), pairs.lambda(j));
    if (j >= pairs.num_rigid) worst_roundoff_ = std::max(worst_roundoff_, calc_roundoff(pairs.energy_share(j)));
  }
  pairs.residual = calc_residuals(pairs.lambda, X);
  fix_signs(pairs.Phi);
  return pairs;
}

EigenPairs NormalModes::find_pairs(const std::string& eps_type, bool& is_valid, Diagnostics& diagnostics) {
  choose_range();
  is_valid = true;
  // Where it costs little the roots decide that too.
  if (range_.is_empty() && range_.first > 100) return answer_nothing(diagnostics);
  if (auto pairs = find_window(diagnostics)) return std::move(*pairs);
  make_solver(eps_type);
  find_first();
  auto result = search();
  if (result.is_missing && add_far_below(std::max(1, result.count - result.cut))) result = search();
  for (int cut = -1; fit_range(num_rigid() + result.cut) && result.cut > cut;) {
    cut = result.cut;
    result = search();
  }
  if (range_.is_empty() && (options_.min_hz || options_.max_hz)) return answer_nothing(diagnostics);
  // A range from --min-hz on was cut to what exists already.
  const bool has_open_end = options_.num_modes > 0 && !options_.max_hz;
  const int requested = has_open_end ? range_.first + options_.num_modes : range_.last, cut = num_rigid() + result.cut;
  if (result.is_missing && has_every_root()) {
    result.is_missing = false;
    std::swap(result.doubtful, result.count);
    result.count = -1;
  }
  if (result.is_missing) {
    is_valid = false;
    if (eps_type.empty() && has_second_solver()) return {};
  }
  report_count(result, num_rigid(), "modes", options_.check_inertia, diagnostics);
  range_.last = std::min(range_.last, cut);
  if (range_.last < requested && options_.num_modes > 0)
    warn_of_fewer(std::max(0, range_.last - range_.first), requested - range_.first, options_.min_hz.has_value(),
                  diagnostics);
  int copies = 0;  // of the last one, that are left out
  if (range_.last > 0)
    for (int i = range_.last; i < cut && value(i) - value(i - 1) <= kCutRoot * value(i); ++i) ++copies;
  if (copies > 0 && value(range_.last) > 0) warn_of_cut_root(copies, diagnostics);
  const int num_above = range_.last > 0 ? cut - range_.last - copies : 0;  // found to see the ends of the range
  auto pairs = make_pairs(cut, result.count < 0 ? -1 : num_rigid() + result.count - num_above, diagnostics);
  pairs.solvers = solver_->get_uses();
  // A complete set of orthogonal vectors with small residuals is valid, whatever the count of pivots.
  if (options_.check_inertia && result.count < 0) is_valid = overlap_ < kOverlap;
  is_valid = is_valid && (pairs.residual.size() == 0 || pairs.residual.maxCoeff() <= linear::kResidualError);
  return pairs;
}

bool NormalModes::has_second_solver() const {
  if (!options_.solver.empty() || !solver_) return false;
  const auto& uses = solver_->get_uses();
  return std::any_of(uses.begin(), uses.end(), [](const SolverUse& use) { return use.eps == "krylovschur"; });
}

NormalModes::NormalModes(const fe::System& system, const EigenOptions& options, FindRigid find_rigid)
    : options_(options),
      factor_(options.factor ? options.factor : system.factor),
      pencil_(system),
      rigid_(find_rigid(pencil_)) {
  rigid_.massless.resize(pencil_.size(), 0);  // no function uses them
  if (!(pencil_.M_diagonal.maxCoeff() > 0))
    throw ComputationError("modal.no-mass", {}, "no free dof of the model has mass",
                           "give RHO in MAT1, NSM in a property, or CONM2 and CMASS cards");
  hold_massless(about_model_);
  add_supports();
}

Answer NormalModes::solve(const std::string& eps_type) {
  Answer answer;
  answer.diagnostics = about_model_;
  answer.pairs = find_pairs(eps_type, answer.is_valid, answer.diagnostics);
  answer.worst_roundoff = worst_roundoff_;
  return answer;
}

}  // namespace bough::modal::detail
