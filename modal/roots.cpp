#include "modal/roots.hpp"
#include "modal/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "base/diagnostic.hpp"

namespace bough::modal::detail {

MatrixXd join(const MatrixXd& A, const MatrixXd& B) {
  MatrixXd C(A.rows(), A.cols() + B.cols());
  C << A, B;
  return C;
}

void Roots::keep(int count) {
  value.conservativeResize(count);
  X.conservativeResize(Eigen::NoChange, count);
}

void Roots::add(const VectorXd& values, MatrixXd vectors, bool by_magnitude) {
  VectorXd all(value.size() + values.size());
  all << value, values;
  if (X.cols() > 0) vectors = join(X, vectors);
  X.resize(0, 0);
  const auto key = [&](int i) { return by_magnitude ? std::abs(all(i)) : all(i); };
  std::vector<int> order(static_cast<std::size_t>(all.size()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  value = all(order);
  X = std::is_sorted(order.begin(), order.end()) ? std::move(vectors) : MatrixXd(vectors(Eigen::all, order));
}

namespace {

double get_key(const RootSearch& search, const Roots& roots, int i) {
  if (i < 0) return search.lowest;
  return search.by_magnitude ? std::abs(roots.value(i)) : roots.value(i);
}

/// First position at or after `requested` with a gap in the list, where an inertia count is possible. -1: none yet.
int find_cut(const RootSearch& search, const Roots& roots) {
  for (int c = std::max(search.requested, 0); c < roots.size(); ++c) {
    const double tolerance = c > 0 ? search.closeness(roots, c - 1) : kCloseness, below = get_key(search, roots, c - 1);
    if (get_key(search, roots, c) - below > std::max(kGap, 2 * tolerance) * std::abs(below + search.shift)) return c;
  }
  return roots.size() >= search.num_available ? roots.size() : -1;
}

/// Just above the last one, since roundoff differs between this factor and the solver's; a count that falls short of
/// what was found is made again higher in the gap.
int count_below_gap(const RootSearch& search, const Roots& roots, int cut) {
  const double top = get_key(search, roots, cut - 1), length = std::abs(top + search.shift);
  const double half = cut < roots.size() ? 0.5 * (get_key(search, roots, cut) - top) : 0.5 * length;
  double step = length * std::clamp(cut > 0 ? 100 * search.roundoff(roots, cut - 1) : 0.0, kCountStep, 0.5);
  int count = -1;
  for (int attempt = 0; attempt < 3 && count < cut; ++attempt, step *= 20) {
    count = std::max(count, search.count(top + std::min(step, half)));
    if (step >= half) break;
  }
  return count;
}

/// Just above the last one, which shows no gap: hundreds of parts alike have a root as often.
int count_copies(const RootSearch& search, const Roots& roots) {
  const double top = get_key(search, roots, roots.size() - 1);
  return search.count(top + kCountStep * std::abs(top + search.shift));
}

}  // namespace

RootSearchResult search_roots(const RootSearch& search, Roots& roots) {
  constexpr int kStuck = 4;
  RootSearchResult result;
  // Roots that were found are not lost for want of a second factor.
  const auto count_if_memory = [&](int cut) {
    if (!result.no_memory.empty()) return -1;
    try {
      return cut < 0 ? count_copies(search, roots) : count_below_gap(search, roots, cut);
    } catch (const ComputationError& error) {
      if (error.items().front().id != "fe.out-of-memory") throw;
      result.no_memory = error.items().front().what;
      return -1;
    }
  };
  int best_cut = -1, best_size = 0, num_stuck = 0;
  int num_without_gap = 0, known = 0;  // as many roots are there, found or not
  for (;;) {
    int missing = search.requested - roots.size(), cut = -1, count = -1;
    if (missing <= 0) {
      cut = find_cut(search, roots);
      if (cut < 0 && known <= roots.size() && search.counts && ++num_without_gap % 3 == 0) known = count_if_memory(-1);
      missing = cut < 0 ? std::max(4, std::min(known, search.num_available) - roots.size()) : 0;
    }
    if (missing == 0 && search.counts) {
      count = count_if_memory(cut);
      if (count > search.num_available) {  // more than exist
        result.cut = cut;
        result.doubtful = count;
        return result;
      }
      missing = std::max(0, count - cut);
      known = std::max(known, count);
    }
    if (missing > 0) {
      const int before = roots.size();
      if (cut >= 0) roots.keep(cut);  // those above may be rough
      const int kept = roots.size();
      // New roots, or old ones told apart: else the solver finds the same again and again.
      num_stuck = cut > best_cut || before > best_size ? 0 : num_stuck + 1;
      best_cut = std::max(best_cut, cut);
      best_size = std::max(best_size, before);
      if (num_stuck < kStuck) search.solve(roots, std::min(missing, kMaxMissing) + kMaxMissingColumns - kMaxMissing);
      if (roots.size() > kept) continue;
      result.is_missing = cut >= 0;
      if (cut < 0 && search.counts && kept > 0) {  // the solver finds no further eigenvalues
        count = count_if_memory(kept);
        result.is_missing = count > kept && count <= search.num_available;
      }
      cut = kept;
    }
    result.cut = cut;
    (count < cut || count > search.num_available ? result.doubtful : result.count) = count;
    return result;
  }
}

void report_count(const RootSearchResult& result, int num_known, const std::string& name, bool counts,
                  Diagnostics& diagnostics) {
  const std::string found = std::to_string(num_known + result.cut) + " " + name;
  if (result.is_missing)
    throw ComputationError(
        "modal.missed-modes", {},
        "found " + found + ", the inertia of the factor counts " + std::to_string(num_known + result.count),
        "look for negative springs and for DMIG that take stiffness away; if stiffness spans many "
        "orders, soften the stiffest parts or use rigid elements");
  if (!counts || result.count >= 0 || result.cut == 0) return;
  if (!result.no_memory.empty()) {
    diagnostics.warning("modal.not-counted", {},
                        found + " were found, each with its own residual, but not counted: " + result.no_memory,
                        "one between may be missing; count on a larger machine, or on more processes of several "
                        "(mpirun -n 2 bough ...)");
    return;
  }
  diagnostics.warning(
      "modal.uncertain-count", {},
      found + " were found, each with its own residual, but the inertia of the factor " +
          (result.doubtful < 0 ? std::string("cannot be counted")
                               : "counts " + std::to_string(num_known + result.doubtful)) +
          ": its pivots are roundoff (stiffness over many orders, or zero-energy motions and mass), and one "
          "between may be missing",
      "replace the stiffest parts by rigid elements");
}

}  // namespace bough::modal::detail
