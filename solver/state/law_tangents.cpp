#include "solver/state/law_tangents.hpp"

#include <algorithm>
#include <limits>

#include "solver/state/difference.hpp"

namespace bough::solver {
namespace {

using Eigen::Map;
using Eigen::VectorXd;
/// A kink within this part of x is at x.
constexpr double kClose = 1e-12;
/// Slopes that differ by this part of the larger are two.
constexpr double kDiffers = 1e-6;
/// A slope below this part of the other one is 0.
constexpr double kNegligible = 1e-9;
/// A slope with a larger error, relative to it, is unknown.
constexpr double kUnknown = 1e-4;

}  // namespace

void LawTangents::record() {
  mode_ = Mode::Record;
  for (auto& [key, law] : laws_) {
    law.next = 0;
    for (Entry& entry : law.entries) std::fill(entry.has_moved.begin(), entry.has_moved.end(), 0);
  }
}

void LawTangents::replay(int side) {
  mode_ = Mode::Replay;
  side_ = side;
  for (auto& [key, law] : laws_) law.next = 0;
}

std::vector<LawKink> LawTangents::list_kinks() const {
  std::vector<LawKink> kinks;
  for (const auto& [key, law] : laws_) {
    for (const Entry& entry : law.entries) {
      for (Eigen::Index i = 0; i < entry.x.size(); ++i) {
        Eigen::Index worst = 0;
        if (entry.has_moved[static_cast<std::size_t>(i)] == 0 || entry.bend.col(i).cwiseAbs().maxCoeff(&worst) == 0)
          continue;
        const double mean = entry.slope(worst, i), half = entry.bend(worst, i) / 2;
        const auto clean = [&](double s) { return std::abs(s) <= kNegligible * std::abs(half) ? 0 : s; };
        kinks.push_back({entry.label, entry.x[i], clean(mean - half), clean(mean + half)});
      }
    }
  }
  return kinks;
}

void LawTangents::take(Entry& entry, const double* reach, const Slope& slope) {
  const Eigen::Index n = entry.x.size(), m = entry.y.size();
  entry.slope.resize(m, n);
  entry.bend.setZero(m, n);
  entry.has_moved.assign(static_cast<std::size_t>(n), 0);
  VectorXd at = entry.x, above(m), below(m), above_beside(m), below_beside(m), above_far(m), below_far(m);
  for (int i = 0; i < n; ++i) {
    slope(at.data(), i, 1, above.data());
    slope(at.data(), i, -1, below.data());
    const double beside =
        reach == nullptr ? 0 : kClose * std::abs(entry.x[i]) + 16 * std::numeric_limits<double>::epsilon() * reach[i];
    const auto take_at = [&](double distance, VectorXd& higher, VectorXd& lower) {
      at[i] = entry.x[i] + distance;
      slope(at.data(), i, 1, higher.data());
      at[i] = entry.x[i] - distance;
      slope(at.data(), i, -1, lower.data());
      at[i] = entry.x[i];
    };
    above_beside = above_far = above;
    below_beside = below_far = below;
    if (beside > 0) {
      take_at(beside, above_beside, below_beside);
      take_at(4 * beside, above_far, below_far);
    }
    for (Eigen::Index e = 0; e < m; ++e) {
      const double bend = above_beside[e] - below_beside[e];
      // Slopes of a curve, too, differ from one side to the other, in proportion to the distance.
      const bool is_kink = std::abs(bend) > kDiffers * std::max(std::abs(above_beside[e]), std::abs(below_beside[e])) &&
                           std::abs(above_far[e] - below_far[e]) < 2 * std::abs(bend);
      entry.bend(e, i) = is_kink ? bend : 0;
      entry.slope(e, i) = is_kink ? (above_beside[e] + below_beside[e]) / 2 : (above[e] + below[e]) / 2;
    }
  }
}

void LawTangents::evaluate(const LawOwner& owner, int slot, const std::vector<double>& x, const double* reach,
                           int num_y, const std::function<void(const double* x, double* y)>& law, const Slope& slope,
                           double* y) {
  if (mode_ == Mode::Off) return law(x.data(), y);
  Law& of = laws_[{owner.key, slot}];
  const std::size_t k = of.next++;
  const Map<const VectorXd> at(x.data(), static_cast<Eigen::Index>(x.size()));
  if (mode_ == Mode::Replay) {
    if (k >= of.entries.size()) return law(x.data(), y);
    Entry& entry = of.entries[k];
    for (std::size_t i = 0; i < x.size(); ++i)
      if (x[i] != entry.x[static_cast<Eigen::Index>(i)]) entry.has_moved[i] = 1;
    Map<VectorXd>(y, num_y) = entry.y + (entry.slope + side_ / 2.0 * entry.bend) * (at - entry.x);
    return;
  }
  law(x.data(), y);
  if (k >= of.entries.size()) of.entries.resize(k + 1);
  Entry& entry = of.entries[k];
  const Map<const VectorXd> value(y, num_y);
  // At the operating point the functions are evaluated again and again.
  if (entry.x.size() == at.size() && entry.y.size() == num_y && entry.x == at && entry.y == value) return;
  entry.label = *owner.noun != 0 ? std::string(owner.noun) + " '" + owner.name + "'" : owner.name;
  entry.x = at;
  entry.y = value;
  take(entry, reach, slope);
}

void evaluate_black_box(LawTangents* tangents, const LawOwner& owner, int slot, const std::vector<double>& x, int num_y,
                        const std::function<void(const double* x, double* y)>& law, double* y) {
  if (tangents == nullptr) return law(x.data(), y);
  const auto slope = [&](const double* at, int i, int direction, double* to) {
    std::vector<double> moved(at, at + x.size());
    const double step = 0.1 * std::max(1.0, std::abs(at[i]));
    const Difference d = differentiate(
        [&](double h) {
          VectorXd out(num_y);
          moved[static_cast<std::size_t>(i)] = at[i] + h;
          law(moved.data(), out.data());
          return out;
        },
        step);
    // A slope that the differences do not find counts as two.
    const VectorXd lost =
        (d.error.array() > kUnknown * d.value.array().abs() && d.calc_clean().array() != 0).select(d.error, 0.0);
    Map<VectorXd>(to, num_y) = d.calc_clean() + direction * (d.kink.array() != 0).select(d.kink, lost);
  };
  tangents->evaluate(owner, slot, x, nullptr, num_y, law, slope, y);
}

}  // namespace bough::solver
