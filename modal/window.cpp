/// \file Modes of a range high in the spectrum by shifts inside it: those below are counted, not computed.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "modal/normal_modes.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::detail {
namespace {

/// Fewer below the range are found along with it in the time that factors with pivots take.
constexpr int kMaxModesBelow = 60;
constexpr int kMaxModesOfShift = 80;  ///< more are divided
constexpr int kGuard = 4;             ///< beyond the edges, to show the gaps

/// Between two eigenvalues, of which the larger may be out of all proportion.
double find_middle(double below, double above) {
  return above > 4 * below ? std::sqrt(below * above) : 0.5 * (below + above);
}

}  // namespace

/// Upper end of the range, reduced to a value with few more eigenvalues below it than requested; without an end, or
/// with one far above the last eigenvalue, by a few inertia counts and bisection. `count`: inertia count.
std::optional<NormalModes::Edge> NormalModes::find_upper_edge(const Edge& lower) const {
  Edge edge{options_.max_hz ? calc_upper(options_) : 1.02 * lower.mu};
  double below = lower.mu;
  for (int attempt = 0; attempt < 20; ++attempt) {
    edge.count = count_below(edge.mu);
    if (edge.count < 0) return std::nullopt;
    if (edge.count > range_.last || options_.max_hz) break;
    const double step = edge.mu - below;
    below = edge.mu;
    edge.mu += 2 * step;
  }
  below = lower.mu;
  const int min_number = std::min(range_.last + 1, edge.count),
            max_count = range_.last + 2 * (range_.last - range_.first) + 20;
  for (int attempt = 0; attempt < 60 && (edge.count > max_count || edge.mu > 1.2 * below); ++attempt) {
    const double middle = find_middle(below, edge.mu);
    const int number = count_below(middle);
    if (number < 0) return std::nullopt;
    if (number >= min_number)
      edge = {middle, number};
    else
      below = middle;
  }
  return edge;
}

/// Adds the eigenvalues between two edges; returns false if their number differs from the inertia counts. A large
/// number is divided into several windows.
bool NormalModes::add_window(const Edge& lower, const Edge& upper, Roots& roots, std::vector<SolverUse>& uses) const {
  const int inside = upper.count - lower.count;
  const double middle = find_middle(lower.mu, upper.mu);
  if (inside <= 0) return inside == 0;
  if (inside > kMaxModesOfShift && middle - lower.mu > kGap * lower.mu) {
    const Edge between{middle, count_below(middle)};
    return between.count >= 0 && add_window(lower, between, roots, uses) && add_window(between, upper, roots, uses);
  }
  EigenProblem krylov;
  krylov.A = pencil_.K;
  krylov.B = pencil_.M;
  krylov.deflate = MatrixXd(pencil_.size(), 0);
  krylov.shift = middle;
  krylov.tolerance = options_.tolerance;
  krylov.max_subspace = static_cast<int>((pencil_.M_diagonal.array() > 0).count()) - num_rigid();
  krylov.solver = options_.solver;
  krylov.progress = options_.progress;
  krylov.num_wanted = inside + kGuard;
  FactoredHandle factored;
  krylov.kept = &factored;
  for (int attempt = 0; attempt < 3; ++attempt, krylov.num_wanted *= 2) {
    Extraction result;
    try {
      result = extract(krylov);
    } catch (const ComputationError&) {
      return false;
    }
    if (result.is_singular) return false;
    std::vector<int> kept;
    for (int i = 0; i < result.values.size(); ++i)
      if (result.values(i) >= lower.mu && result.values(i) < upper.mu) kept.push_back(i);
    add_use(result.by, uses);
    if (static_cast<int>(kept.size()) != inside) continue;
    roots.add(result.values(kept), result.vectors(Eigen::all, kept));
    return true;
  }
  return false;
}

std::optional<EigenPairs> NormalModes::find_window(Diagnostics& diagnostics) {
  const int requested = range_.last - range_.first;
  if (!options_.min_hz || requested <= 0 || range_.first <= std::max(kMaxModesBelow, 2 * requested))
    return std::nullopt;
  const Edge lower{calc_lower(options_), range_.first};
  const auto upper = find_upper_edge(lower);
  if (!upper || upper->count < lower.count) return std::nullopt;
  const int inside = upper->count - lower.count, number = std::min(requested, inside);
  if (inside == 0) {
    range_.last = range_.first;
    return answer_nothing(diagnostics);
  }
  Roots roots{VectorXd(0), MatrixXd(pencil_.size(), 0)};
  std::vector<SolverUse> uses;
  if (!add_window(lower, *upper, roots, uses)) return std::nullopt;
  Found found{std::move(roots.value), std::move(roots.X), 0, 0, 0, number};
  int cut = number;
  while (cut < inside && found.lambda(cut) - found.lambda(cut - 1) <= kGap * found.lambda(cut)) ++cut;
  Diagnostics own;
  if (cut > number) warn_of_cut_root(cut - number, own);
  if (number < requested) warn_of_fewer(number, requested, true, own);
  auto pairs = finish_pairs(std::move(found), options_.check_inertia ? range_.first + cut : -1, own);
  if (!(overlap_ < kOverlap && pairs.residual.maxCoeff() <= linear::kResidualError)) return std::nullopt;
  pairs.solvers = std::move(uses);
  range_.last = range_.first + number;
  for (const auto& item : own.items()) diagnostics.add(item);
  return pairs;
}

}  // namespace bough::modal::detail
