#include "solver/state/difference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <vector>

#include "base/diagnostic.hpp"

namespace bough::solver {
namespace {

using Eigen::VectorXd;
constexpr std::size_t kMinLevels = 10, kOrders = 5;
constexpr int kMaxHalvings = 40, kCheckHalvings = 24, kRestartHalvings = 23;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
/// Two orders that agree to this part of the derivative end the shrinking of steps.
constexpr double kAgreed = 1e-8;
/// Changes of f above this part of its largest entry are no roundoff.
constexpr double kSmall = 1e-9;
/// Bends of a kink stay within this ratio over three halvings; those of a smooth function shrink to a quarter.
constexpr double kSteadyBend = 1.5;

/// Values on both sides of 0, at one step.
struct Pair {
  double h = 0;
  VectorXd change, slope, size;  ///< f(h) - f(-h); over 2 h; the larger abs
  VectorXd bend;                 ///< f'(0+) - f'(0-) by one-sided differences
};

/// Roundoff of the terms of f, of each entry: second differences, in steps so short that f is a straight line on either
/// side of 0. Next to an equilibrium in orbit f is 1e-6 of its terms or less, so that its size says nothing.
VectorXd measure_roundoff(const std::function<VectorXd(double)>& f, const VectorXd& f0, double step) {
  constexpr double kShort = 1.3e-9, kLuck = 4;  // no power of two, which may leave no roundoff
  VectorXd roundoff = VectorXd::Zero(f0.size());
  for (const double h : {kShort * step, -kShort * step}) {
    try {
      const VectorXd at[] = {f(h), f(2 * h), f(3 * h), f(4 * h)};
      for (int i = 0; i < 2; ++i) {
        const VectorXd bend = at[i] - 2 * at[i + 1] + at[i + 2];
        if (bend.allFinite()) roundoff = roundoff.cwiseMax(kLuck * bend.cwiseAbs());
      }
    } catch (const ComputationError&) {
      // No value on that side.
    }
  }
  return roundoff;
}

class Ladder {
 public:
  Ladder(const std::function<VectorXd(double)>& f, const VectorXd& f0, const VectorXd& roundoff)
      : f_(f), f0_(f0), roundoff_(roundoff) {}

  /// Returns false if f has no value there; why() then.
  bool calc_pair(double h, Pair& pair) {
    try {
      const VectorXd above = f_(h), below = f_(-h);
      pair.h = h;
      pair.change = above - below;
      pair.slope = pair.change / (2 * h);
      pair.size = above.cwiseAbs().cwiseMax(below.cwiseAbs());
      pair.bend = (above + below - 2 * f0_) / h;
    } catch (const ComputationError&) {
      why_ = std::current_exception();
      return false;
    }
    why_ = nullptr;
    return pair.slope.allFinite();
  }

  void run(double step, int max_halvings) {
    std::array<VectorXd, kOrders> row, before;
    std::size_t level = 0;
    for (int i = 0; i <= max_halvings; ++i) {
      Pair pair;
      if (!calc_pair(std::ldexp(step, -i), pair)) {
        if (level > 0) break;
        continue;
      }
      const double h = pair.h;
      before.swap(row);
      row[0] = pair.slope;
      const VectorXd rounding = (kEpsilon * pair.size).cwiseMax(roundoff_) / h;
      if (level == 0) {
        best_.value = pair.slope;
        best_.error = VectorXd::Constant(pair.slope.size(), std::numeric_limits<double>::infinity());
        best_step_ = VectorXd::Constant(pair.slope.size(), h);
      }
      double factor = 1;
      for (std::size_t k = 1; k <= level && k < kOrders; ++k) {
        factor *= 4;
        row[k] = row[k - 1] + (row[k - 1] - before[k - 1]) / (factor - 1);
        const VectorXd error =
            (row[k] - row[k - 1]).cwiseAbs().cwiseMax((row[k] - before[k - 1]).cwiseAbs()) + rounding;
        for (Eigen::Index e = 0; e < error.size(); ++e) {
          if (!(error[e] < best_.error[e])) continue;
          best_.error[e] = error[e];
          best_.value[e] = row[k][e];
          best_step_[e] = h;
        }
      }
      // Extrapolated, two short steps differ by roundoff alone.
      if (level > 0)
        steps_apart_.push_back(
            h * (row[std::min(level, kOrders - 1)] - before[std::min(level - 1, kOrders - 1)]).cwiseAbs());
      pairs_.push_back(std::move(pair));
      measure_noise();
      if (++level >= kMinLevels && is_settled()) break;
    }
    if (steps_apart_.size() < 3)
      noise_ = VectorXd::Zero(best_.value.size());
    else
      best_.error = best_.error.cwiseMax(noise_.cwiseQuotient(best_step_));
  }

  bool is_empty() const { return pairs_.empty(); }
  const std::exception_ptr& why() const { return why_; }
  const Difference& best() const { return best_; }
  /// The pair with the longest step not above h; none if all are longer.
  const Pair* find_pair(double h) const {
    const auto found = std::find_if(pairs_.begin(), pairs_.end(), [&](const Pair& pair) { return pair.h <= h; });
    return found == pairs_.end() ? nullptr : &*found;
  }

  /// Roundoff of f at its largest, of each entry.
  VectorXd calc_floor(const Pair& pair) const {
    const double all = pair.size.size() > 0 ? 16 * kEpsilon * pair.size.maxCoeff() : 0;
    return (1e3 * kEpsilon * pair.size)
        .cwiseMax(VectorXd::Constant(pair.size.size(), all))
        .cwiseMax(4 * noise_.cwiseMax(roundoff_));
  }

  /// A value below its error is roundoff, unless f changes by the same amount at all short steps.
  bool is_roundoff(Eigen::Index e) const {
    constexpr std::size_t kLast = 5;
    if (!(std::abs(best_.value[e]) <= best_.error[e])) return false;
    if (pairs_.size() < kLast) return true;
    double low = std::numeric_limits<double>::infinity(), high = 0;
    const double sign = pairs_.back().change[e];
    for (std::size_t i = pairs_.size() - kLast; i < pairs_.size(); ++i) {
      const double change = pairs_[i].change[e];
      if (!(change * sign > 0)) return true;
      low = std::min(low, std::abs(change));
      high = std::max(high, std::abs(change));
    }
    const Pair& last = pairs_.back();
    return high > 2 * low || low <= std::max(1e3 * kEpsilon * last.size[e], 1e-12 * last.size.maxCoeff());
  }

  /// (f'(0+) - f'(0-)) / 2 of entries whose bend does not shrink with the step.
  VectorXd calc_kinks() const {
    constexpr std::size_t kLast = 3;
    VectorXd kinks = VectorXd::Zero(best_.value.size());
    if (pairs_.size() < kLast) return kinks;
    const Pair& last = pairs_.back();
    const VectorXd floor = calc_floor(last);
    for (Eigen::Index e = 0; e < kinks.size(); ++e) {
      double low = std::numeric_limits<double>::infinity(), high = 0;
      for (std::size_t i = pairs_.size() - kLast; i < pairs_.size(); ++i) {
        low = std::min(low, std::abs(pairs_[i].bend[e]));
        high = std::max(high, std::abs(pairs_[i].bend[e]));
      }
      if (high <= kSteadyBend * low && low * last.h > 4 * floor[e]) kinks[e] = last.bend[e] / 2;
    }
    return kinks;
  }

 private:
  /// Two orders agree, or three steps changed nothing but roundoff, which does not shrink with the step.
  bool is_settled() const {
    const Pair& last = pairs_.back();
    const double all = last.size.size() > 0 ? last.size.maxCoeff() : 0;
    const VectorXd &apart = steps_apart_.back(), &apart_before = steps_apart_[steps_apart_.size() - 2];
    for (Eigen::Index e = 0; e < apart.size(); ++e) {
      if (std::max(best_.error[e], noise_[e] / best_step_[e]) <= kAgreed * std::abs(best_.value[e])) continue;
      if (noise_[e] <= std::max(kEpsilon * std::max(1e3 * last.size[e], 16 * all), roundoff_[e])) continue;
      if (!(apart[e] <= kSmall * all && apart[e] >= 0.25 * apart_before[e])) return false;
    }
    return true;
  }

  /// The least of many estimates is too good if all of them are roundoff: three steps in a row measure the roundoff.
  void measure_noise() {
    const std::size_t n = steps_apart_.size();
    if (n < 3) return;
    const VectorXd noise = steps_apart_[n - 1].cwiseMax(steps_apart_[n - 2]).cwiseMax(steps_apart_[n - 3]);
    noise_ = n == 3 ? noise : VectorXd(noise_.cwiseMin(noise));
  }

  const std::function<VectorXd(double)>& f_;
  const VectorXd &f0_, &roundoff_;
  Difference best_;
  VectorXd best_step_, noise_;
  std::vector<Pair> pairs_;
  std::vector<VectorXd> steps_apart_;  ///< h abs(change of the best slope from one step to the next)
  std::exception_ptr why_;
};

}  // namespace

VectorXd Difference::calc_clean() const {
  VectorXd clean = value;
  for (Eigen::Index e = 0; e < clean.size(); ++e)
    if (is_roundoff[static_cast<std::size_t>(e)] != 0) clean[e] = 0;
  return clean;
}

Difference differentiate(const std::function<VectorXd(double)>& f, double step, bool has_large_terms) {
  const VectorXd f0 = f(0);
  const VectorXd roundoff = has_large_terms ? measure_roundoff(f, f0, step) : VectorXd(VectorXd::Zero(f0.size()));
  Ladder ladder(f, f0, roundoff);
  ladder.run(step, kMaxHalvings);
  if (ladder.is_empty()) {
    if (ladder.why()) std::rethrow_exception(ladder.why());
    throw ComputationError("linear.no-derivative", {}, "the accelerations next to the operating point are not finite",
                           "check the state there; bough run shows the motion from it");
  }
  Difference found = ladder.best();
  const Eigen::Index size = found.value.size();
  found.kink = ladder.calc_kinks();
  found.is_roundoff.assign(static_cast<std::size_t>(size), 0);
  for (Eigen::Index e = 0; e < size; ++e)
    found.is_roundoff[static_cast<std::size_t>(e)] = ladder.is_roundoff(e) ? 1 : 0;
  // Details of f below all steps.
  const double check = std::ldexp(step, -kCheckHalvings);
  Pair pair;
  if (const Pair* known = ladder.find_pair(check))
    pair = *known;
  else if (!ladder.calc_pair(check, pair))
    return found;
  const VectorXd floor = ladder.calc_floor(pair) / pair.h;
  const VectorXd apart = (pair.slope - found.value).cwiseAbs();
  std::vector<Eigen::Index> misled;
  for (Eigen::Index e = 0; e < size; ++e) {
    if (found.kink[e] != 0 && !(std::abs(pair.bend[e] - 2 * found.kink[e]) < std::abs(found.kink[e]) + floor[e]))
      found.kink[e] = 0;
    if (apart[e] > floor[e] + 10 * found.error[e] + 1e-6 * std::abs(found.value[e])) misled.push_back(e);
  }
  if (misled.empty()) return found;
  Ladder fine(f, f0, roundoff);
  fine.run(std::ldexp(step, -kRestartHalvings), kMaxHalvings - kRestartHalvings);
  if (fine.is_empty()) return found;
  const VectorXd fine_kinks = fine.calc_kinks();
  for (const Eigen::Index e : misled) {
    if (!(fine.best().error[e] < 0.1 * std::abs(fine.best().value[e] - found.value[e]))) continue;
    found.value[e] = fine.best().value[e];
    found.error[e] = fine.best().error[e];
    found.kink[e] = fine_kinks[e];
    found.is_roundoff[static_cast<std::size_t>(e)] = fine.is_roundoff(e) ? 1 : 0;
  }
  return found;
}

}  // namespace bough::solver
