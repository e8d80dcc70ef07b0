#include "modal/response/load_steps.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/number_text.hpp"
#include "modal/response/sampled_curve.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::response {
namespace {

using Kind = records::DynamicLoad::Kind;
using Type = records::DynamicLoad::Excitation;

/// Pulses shorter than this number of steps are divided into parts.
constexpr int kShortPulse = 16, kPulseParts = 32;
/// Steps in a period of TLOAD2 below which a warning is issued.
constexpr double kMinSteps = 10;
/// Largest number of corners of a motion without a warning.
constexpr int kMaxSilentCorners = 4;

std::string describe(const ExcitationTerm& term) {
  return (term.card->kind == Kind::Tload1 ? "TLOAD1 " : "TLOAD2 ") + std::to_string(term.card->sid);
}
/// Times of the points of a table, ascending.
std::vector<double> list_points(const ExcitationTerm& term) {
  std::vector<double> times;
  const auto* table = term.table_a;
  if (!table) return times;
  if (table->kind == 4) return {table->x3 + term.delay, table->x4 + term.delay};
  for (const auto& [x, y] : table->points) {
    const double t = table->kind == 2 ? x + table->x1 : table->kind == 3 ? table->x1 + table->x2 * x : x;
    times.push_back(t + term.delay);
  }
  std::sort(times.begin(), times.end());
  return times;
}

/// Where a load has corners.
std::vector<double> list_corners(const ExcitationTerm& term, const TimeGrid& grid) {
  if (term.card->kind == Kind::Tload1) return list_points(term);
  const double t1 = term.card->t1 + term.delay, t2 = term.card->t2 + term.delay;
  std::vector<double> times{t1, t2};
  const double* first = grid.time.data();
  const auto n = grid.time.size();
  const auto after = std::max<Eigen::Index>(std::lower_bound(first, first + n, t1) - first, 1);
  if (after >= n) return times;
  const double h = grid.time(after) - grid.time(after - 1);
  const bool is_constant = term.card->frequency_hz == 0 && term.card->growth == 0 && term.card->power == 0;
  if (!is_constant && t2 - t1 < kShortPulse * h)
    for (int i = 1; i < kPulseParts; ++i) times.push_back(t1 + (t2 - t1) * i / kPulseParts);
  return times;
}

/// Distance of the load at t from a line between the steps around t; 0 at a step and outside.
double calc_missed(const ExcitationTerm& term, const VectorXd& time, double t) {
  const double* first = time.data();
  const auto i = std::upper_bound(first, first + time.size(), t) - first;
  if (i == 0 || i >= time.size()) return 0;
  const double a = time(i - 1), b = time(i), reach = detail::kSideOfStep * (b - a);
  if (t - a <= 10 * reach || b - t <= 10 * reach) return 0;
  const double f0 = calc_history(term, a, Side::After, reach), f1 = calc_history(term, b, Side::Before, reach);
  const double line = f0 + (f1 - f0) * (t - a) / (b - a);
  return std::max(std::abs(calc_history(term, t, Side::Before, reach) - line),
                  std::abs(calc_history(term, t, Side::After, reach) - line));
}

double calc_largest(const ExcitationTerm& term, const TimeGrid& grid, const std::vector<double>& corners) {
  double largest = 0;
  for (const double t : grid.time) largest = std::max(largest, std::abs(calc_history(term, t, Side::Mean, 0)));
  for (const double t : corners)
    if (t > 0 && t < grid.time(grid.time.size() - 1))
      for (const auto side : {Side::Before, Side::After})
        largest = std::max(largest, std::abs(calc_history(term, t, side, 0)));
  return largest;
}

class Refiner {
 public:
  Refiner(const records::DynamicDeck& deck, const Excitation& excitation, TimeGrid grid, Diagnostics& diagnostics)
      : deck_(deck), excitation_(excitation), grid_(std::move(grid)), diagnostics_(diagnostics) {}

  TimeGrid refine(int max_corners) {
    for (const auto* terms : {&excitation_.forces, &excitation_.motions})
      for (const auto& term : *terms) {
        if (!said_.insert({term.card, term.delay}).second) continue;
        report_few_steps(term);
        report_before_table(term);
        if (terms == &excitation_.motions) report_corners(term);
      }
    add_corners(max_corners);
    return std::move(grid_);
  }

 private:
  void report_few_steps(const ExcitationTerm& term) {
    if (term.card->kind != Kind::Tload2 || term.card->frequency_hz == 0) return;
    const auto n = grid_.time.size();
    double longest = 0;
    for (Eigen::Index i = 1; i < n; ++i)
      if (grid_.time(i) > term.card->t1 + term.delay && grid_.time(i - 1) < term.card->t2 + term.delay)
        longest = std::max(longest, grid_.time(i) - grid_.time(i - 1));
    const double steps = longest > 0 ? 1 / (std::abs(term.card->frequency_hz) * longest) : kMinSteps;
    const bool is_short = term.card->t2 - term.card->t1 < kShortPulse * longest;  // divided, see list_corners
    if (steps >= kMinSteps || (is_short && term.card->excitation == Type::Force)) return;
    diagnostics_.warning("modal.coarse-steps", deck_.locate(term.card->at),
                         describe(term) + ": " + show_number(steps) + " steps in a period of " +
                             show_number(1 / std::abs(term.card->frequency_hz)) +
                             ": between the steps it is taken as a line, a motion as a spline",
                         "take steps of " + show_number(1 / (20 * std::abs(term.card->frequency_hz))) + " or less");
  }

  void report_before_table(const ExcitationTerm& term) {
    const auto points = list_points(term);
    if (points.size() < 2 || term.table_a->kind == 4 || term.table_a->is_flat) return;
    const double first = points.front(), end = grid_.time(grid_.time.size() - 1);
    if (!(first > 0) || calc_history(term, 0, Side::Mean, 0) == 0) return;
    diagnostics_.warning("modal.before-table", deck_.locate(term.card->at),
                         describe(term) + ": until t = " + show_number(std::min(first, end)) + " table " +
                             std::to_string(term.table_a->id) +
                             " has no points; on the line of its first two it begins with " +
                             show_number(calc_history(term, 0, Side::Mean, 0)),
                         "begin the table with two points of value 0, or a delayed one with 0. twice at its start");
  }

  void report_corners(const ExcitationTerm& term) {
    if (term.card->excitation != Type::Displacement) return;
    const auto n = grid_.time.size();
    VectorXd before(n), after(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      before(i) = i > 0 ? calc_history(term, grid_.time(i), Side::Before, 0) : 0;
      after(i) = calc_history(term, grid_.time(i), Side::After, 0);
    }
    const auto curve = make_curve(grid_.time, before, after);
    if (curve.num_corners <= kMaxSilentCorners) return;
    diagnostics_.warning("modal.motion-corners", deck_.locate(term.card->at),
                         describe(term) + " moves supports along a line with " + std::to_string(curve.num_corners) +
                             " corners, the first at t = " + show_number(grid_.time(curve.first_corner)) +
                             ": each is an impulse, from which the accelerations of stiff modes are large",
                         "give a smooth motion a point for each step, or take TYPE ACCE");
  }

  /// Corners that the steps miss are added until none is: a new step may reveal others near it.
  void add_corners(int max_corners) {
    const TimeGrid given = grid_;
    for (const auto& term : excitation_.forces)
      largest_.push_back(calc_largest(term, grid_, list_corners(term, grid_)));
    while (true) {
      auto missed = list_missed();
      if (missed.empty()) break;
      const int left = max_corners - static_cast<int>(grid_.time.size() - given.time.size());
      if (static_cast<int>(missed.size()) > left) {
        report_missed(missed[static_cast<std::size_t>(left)], max_corners);
        missed.resize(static_cast<std::size_t>(left));
      }
      const auto before = grid_.time.size();
      add_steps(missed);
      if (grid_.time.size() == before) break;
    }
    for (int& i : grid_.shown) {
      const double* first = grid_.time.data();
      i = static_cast<int>(std::lower_bound(first, first + grid_.time.size(), given.time(i)) - first);
    }
  }

  /// (part of the largest value, time), the largest first.
  std::vector<std::pair<double, double>> list_missed() const {
    std::map<double, double> missed;
    for (std::size_t i = 0; i < excitation_.forces.size(); ++i) {
      const auto& term = excitation_.forces[i];
      const double largest = largest_[i];
      for (const double t : list_corners(term, grid_)) {
        const double part = largest > 0 ? calc_missed(term, grid_.time, t) / largest : 0;
        if (part > detail::kMissedLoad) missed[t] = std::max(missed[t], part);
      }
    }
    std::vector<std::pair<double, double>> order;
    for (const auto& [t, part] : missed) order.emplace_back(part, t);
    std::sort(order.rbegin(), order.rend());
    return order;
  }

  void report_missed(const std::pair<double, double>& next, int max_corners) {
    if (next.first <= 0.01) return;
    diagnostics_.warning("modal.load-between-steps", deck_.locate(excitation_.forces.front().card->at),
                         "the loads have more than " + std::to_string(max_corners) +
                             " corners between the steps; at t = " + show_number(next.second) +
                             " a line between the steps misses " + show_number(100 * next.first) +
                             " % of the largest value",
                         "take steps as fine as the tables of the loads");
  }

  void add_steps(const std::vector<std::pair<double, double>>& missed) {
    std::vector<double> added;
    for (const auto& [part, t] : missed) added.push_back(t);
    std::sort(added.begin(), added.end());
    std::vector<double> all(grid_.time.begin(), grid_.time.end());
    for (const double t : added) {
      const auto next = std::lower_bound(all.begin(), all.end(), t);
      // Two loads with all but the same corner.
      if (next == all.begin() || next == all.end() || t - *(next - 1) < detail::kSameInstant * t ||
          *next - t < detail::kSameInstant * t)
        continue;
      all.insert(next, t);
    }
    grid_.time = Eigen::Map<const VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
  }

  const records::DynamicDeck& deck_;
  const Excitation& excitation_;
  TimeGrid grid_;
  Diagnostics& diagnostics_;
  std::vector<double> largest_;  ///< of each force
  std::set<std::pair<const records::DynamicLoad*, double>> said_;
};

}  // namespace

TimeGrid refine_times(const records::DynamicDeck& deck, const Excitation& excitation, TimeGrid grid, int max_corners,
                      Diagnostics& diagnostics) {
  return Refiner(deck, excitation, std::move(grid), diagnostics).refine(max_corners);
}

}  // namespace bough::modal::response
