#include "solver/linear/difference.hpp"

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
constexpr std::size_t kLevels = 10, kOrders = 5;
constexpr int kHalvings = 30;

/// (f(h) - f(-h)) / 2h and max(|f(h)|, |f(-h)|); false where f has no value, with why.
bool calc_central(const std::function<VectorXd(double)>& f, double h, VectorXd& slope, VectorXd& size,
                  std::exception_ptr& why) {
  try {
    const VectorXd above = f(h), below = f(-h);
    slope = (above - below) / (2 * h);
    size = above.cwiseAbs().cwiseMax(below.cwiseAbs());
  } catch (const ComputationError&) {
    why = std::current_exception();
    return false;
  }
  why = nullptr;
  return slope.allFinite();
}

}  // namespace

Difference differentiate(const std::function<VectorXd(double)>& f, double step) {
  Difference best;
  std::array<VectorXd, kOrders> row, before;
  VectorXd slope, size, best_step;
  std::vector<VectorXd> steps_apart;  // h |change of the best slope from one step to the next|
  std::exception_ptr why;
  std::size_t level = 0;
  for (int i = 0; i < kHalvings && level < kLevels; ++i) {
    const double h = std::ldexp(step, -i);
    if (!calc_central(f, h, slope, size, why)) {
      if (level > 0) break;
      continue;
    }
    before.swap(row);
    row[0] = slope;
    // Rounding of f alone; what else is lost shows in the table.
    const VectorXd rounding = std::numeric_limits<double>::epsilon() / h * size;
    if (level == 0) {
      best.value = slope;
      best.error = VectorXd::Constant(slope.size(), std::numeric_limits<double>::infinity());
      best_step = VectorXd::Constant(slope.size(), h);
    }
    double factor = 1;
    for (std::size_t k = 1; k <= level && k < kOrders; ++k) {
      factor *= 4;
      row[k] = row[k - 1] + (row[k - 1] - before[k - 1]) / (factor - 1);
      const VectorXd error = (row[k] - row[k - 1]).cwiseAbs().cwiseMax((row[k] - before[k - 1]).cwiseAbs()) + rounding;
      for (Eigen::Index e = 0; e < error.size(); ++e) {
        if (!(error[e] < best.error[e])) continue;
        best.error[e] = error[e];
        best.value[e] = row[k][e];
        best_step[e] = h;
      }
    }
    // Extrapolated, two steps differ by rounding alone once they are short.
    if (level > 0)
      steps_apart.push_back(h *
                            (row[std::min(level, kOrders - 1)] - before[std::min(level - 1, kOrders - 1)]).cwiseAbs());
    ++level;
  }
  if (level == 0) {
    if (why) std::rethrow_exception(why);
    throw ComputationError("linear.no-derivative", {}, "the accelerations next to the operating point are not finite",
                           "look at the state there; bough run shows what becomes of it");
  }
  // The least of many estimates is too good where all of them are rounding: three steps in a row tell how much that is.
  if (steps_apart.size() < 3) return best;
  VectorXd noise = VectorXd::Constant(best.value.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i + 2 < steps_apart.size(); ++i)
    noise = noise.cwiseMin(steps_apart[i].cwiseMax(steps_apart[i + 1]).cwiseMax(steps_apart[i + 2]));
  best.error = best.error.cwiseMax(noise.cwiseQuotient(best_step));
  return best;
}

}  // namespace bough::solver
