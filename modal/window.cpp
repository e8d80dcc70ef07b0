/// \file Modes of a range high in the spectrum by a shift inside it: those below are counted, not computed.
#include <algorithm>
#include <cmath>

#include "modal/canonical.hpp"
#include "modal/normal_modes.hpp"

namespace bough::modal::detail {
namespace {

/// Fewer below the range are found along with it in the time that factors with pivots take.
constexpr int kFewBelow = 60;
/// More in the range want more than one shift.
constexpr int kMostInside = 100;
constexpr int kGuard = 4;  ///< beyond the edges, to show the gaps

}  // namespace

/// Of --max-hz where that many roots lie below it; else, and without one, a little above as many as are asked for, by
/// growing steps, then halves.
std::optional<NormalModes::Edge> NormalModes::find_upper_edge(double lower) const {
  const auto count = [&](double mu) { return count_roots_below(pencil_.K.get(), pencil_.M.get(), mu); };
  const int least = range_.last + 1, most = range_.last + 2 * (range_.last - range_.first) + 20;
  double below = lower;
  Edge edge{options_.max_hz ? calc_lambda(*options_.max_hz) : 1.02 * lower};
  for (int attempt = 0; attempt < 60; ++attempt) {
    edge.count = count(edge.mu);
    if (edge.count < 0) return std::nullopt;
    if (edge.count >= least || options_.max_hz) break;
    const double step = edge.mu - below;
    below = edge.mu;
    edge.mu += 2 * step;
  }
  for (int attempt = 0; attempt < 60 && edge.count > most; ++attempt) {
    const double middle = 0.5 * (below + edge.mu);
    const int number = count(middle);
    if (number < 0) return std::nullopt;
    if (number >= least)
      edge = {middle, number};
    else
      below = middle;
  }
  return edge;
}

std::optional<EigenPairs> NormalModes::find_window(Diagnostics& said) {
  const int number = range_.last - range_.first;
  const bool is_for_it = options_.min_hz && options_.check_inertia && number > 0 && number <= kMostInside &&
                         range_.first > std::max(kFewBelow, 2 * number) && fe::initialize_petsc().size == 1;
  if (!is_for_it) return std::nullopt;
  const double lower = calc_lambda(*options_.min_hz);
  const auto upper = find_upper_edge(lower);
  if (!upper) return std::nullopt;
  const int inside = upper->count - range_.first;
  if (inside < number || inside > 3 * kMostInside) return std::nullopt;

  KrylovProblem krylov;
  krylov.A = pencil_.K.get();
  krylov.B = pencil_.M.get();
  krylov.deflate = MatrixXd(pencil_.num_rows(), 0);
  krylov.shift = 0.5 * (lower + upper->mu);
  krylov.tolerance = options_.tolerance;
  krylov.max_subspace = static_cast<int>((pencil_.M_diagonal.array() > 0).count()) - num_rigid();
  krylov.method = KrylovMethod::OneVector;
  krylov.progress = options_.progress;
  krylov.num_wanted = inside + kGuard;
  for (int attempt = 0; attempt < 3; ++attempt, krylov.num_wanted *= 2) {
    KrylovResult result;
    try {
      result = solve_krylov(krylov);
    } catch (const ComputationError&) {
      return std::nullopt;
    }
    if (result.is_singular) return std::nullopt;
    Roots roots{VectorXd(0), MatrixXd(pencil_.num_rows(), 0)};
    roots.add(result.values, result.vectors);
    std::vector<int> kept;
    for (int i = 0; i < roots.size(); ++i)
      if (roots.value(i) >= lower && roots.value(i) < upper->mu) kept.push_back(i);
    // As many as the two counts say there are: none is missing. A root on the edge may be on its other side.
    if (static_cast<int>(kept.size()) != inside) continue;
    Found found{roots.value(kept), roots.X(Eigen::all, kept), 0, 0, 0, number};
    int cut = number;
    while (cut < inside && found.lambda(cut) - found.lambda(cut - 1) <= 1e-6 * found.lambda(cut)) ++cut;
    if (cut > number) warn_of_cut_root(cut - number, said);
    auto pairs = finish_pairs(std::move(found), range_.first + cut, said);
    if (overlap_ < 1e-6 && pairs.residual.maxCoeff() <= fe::kResidualError) return pairs;
    return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace bough::modal::detail
