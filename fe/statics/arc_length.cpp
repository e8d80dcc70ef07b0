// Continuation by arc length: the load is an unknown of each step, so that limit points are passed (Riks 1979; updated
// normal plane of Ramm 1981). docs/theory/nonlinear-statics.md.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fe/statics/nonlinear_tangent.hpp"

namespace bough::fe {

namespace {

constexpr int kMaxIterationsToGrow = 5;    ///< a step of no more lets the next one grow
constexpr int kMaxStepsOfIncrement = 200;  ///< number of steps at most, per increment
constexpr double kMinCosine = 0.5;         ///< of the angle between a step and the one before

std::string format_share(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", 100 * share);
  return text;
}

}  // namespace

/// The path of states over the share of the way from one load to the next.
struct NonlinearStatics::Arc {
  NonlinearStatics& owner;
  const PathLoad &start, &to;
  VectorXd F_start, dF;  ///< dead forces at share 0, and their change to share 1
  VectorXd enforced;     ///< displacements of the g-set per share; empty: none
  VectorXd weight;       ///< of the unknowns in the length of a step: diagonal of the first tangent stiffness
  bool is_dead;          ///< the change of the loads does not depend on the state

  /// Tangent stiffness, residual and its derivative by the share, of the unknowns, at the state.
  struct Point {
    SparseRows K;
    VectorXd r, slope;
  };
  Point evaluate(double share) {
    VectorXd slope = -dF;
    if (!is_dead) {  // the residual is linear in the loads
      owner.set_loads(start, to, share + 1);
      slope = owner.evaluate(F_start + (share + 1) * dF).residual;
    }
    owner.set_loads(start, to, share);
    const Tangent tangent = owner.evaluate(F_start + share * dF);
    owner.residual_ = tangent.residual;
    if (!is_dead) slope -= tangent.residual;
    slope = owner.collect(std::move(slope));
    if (enforced.size() > 0) slope += tangent.K * enforced;
    const auto& T = owner.model_.T();
    return {owner.reduce(tangent.K), T.transpose() * owner.collect(tangent.residual), T.transpose() * slope};
  }

  void advance(const VectorXd& q, double share) {
    VectorXd step = owner.model_.T() * q;
    if (enforced.size() > 0) step += share * enforced;
    owner.advance(step);
  }
  double calc_product(const VectorXd& a, const VectorXd& b) const { return a.dot(weight.cwiseProduct(b)); }

  /// Newton's method from a predicted state: corrections are normal to the step so far, or at a fixed share. False
  /// where it does not come to an end.
  bool correct(VectorXd& total, double& share, bool is_share_fixed, int max_iterations, int& num_iterations) {
    double reference = 0, last = 0;
    int num_stuck = 0;
    for (num_iterations = 0; num_iterations <= max_iterations; ++num_iterations) {
      const Point point = evaluate(share);
      if (!point.r.allFinite() || owner.max_turn_ > kMaxTurn) return false;
      const TangentFactor factor(point.K, owner.is_symmetric_);
      if (!factor.is_made()) return false;
      VectorXd q = -factor.solve(point.r);
      double change = 0;
      if (!is_share_fixed) {
        const VectorXd along = -factor.solve(point.slope);
        change = -calc_product(total, q) / calc_product(total, along);
        q += change * along;
      }
      if (!q.allFinite() || !std::isfinite(change)) return false;
      ++owner.num_iterations_;
      advance(q, change);
      total += q;
      share += change;
      owner.residual_work_ = std::abs(q.dot(point.r + change * point.slope));
      reference = std::max({reference, owner.energy_, std::abs(total.dot(point.slope))});
      num_stuck = owner.residual_work_ > 0.8 * last ? num_stuck + 1 : 0;
      last = owner.residual_work_;
      if (last <= kWorkTolerance * reference || (num_stuck >= 3 && last <= kStagnation * reference)) return true;
      if (num_iterations > 5 && last > 1e6 * reference) return false;
    }
    return false;
  }
};

void NonlinearStatics::follow_arc(const PathLoad& to, const NonlinearOptions& options, Diagnostics& diagnostics) {
  const PathLoad start = load_;
  const VectorXd dd = to.d - d_;
  const auto is_constant = [&](const PathLoad& load) {
    return load.moving.empty() && load.arms.empty() && load.initial.of.empty() &&
           (offset_masses_.empty() || load.A_I.isZero(0));
  };
  Arc arc{*this,
          start,
          to,
          F_,
          calc_dead_forces(to) - F_,
          dd.isZero(0) ? VectorXd() : VectorXd(model_.T_fixed() * dd),
          {},
          is_constant(start) && is_constant(to)};
  double share = 0, full = 0, length = 0, first_limit = 0;
  int num_limits = 0;
  double last_change = 0;
  VectorXd previous;
  const auto fail = [&] {
    set_loads(start, to, share);
    residual_ = evaluate(arc.F_start + share * arc.dF).residual;
    throw ComputationError(
        "fe.no-equilibrium", {},
        "no static equilibrium is found on the path beyond " + format_share(share) + " % of the load",
        "lower the load there, or give more --increments");
  };
  for (int num = 0; share < 1; ++num) {
    const DeformedState before = state_;
    const double share_before = share;
    const auto point = arc.evaluate(share);
    const TangentFactor factor(point.K, is_symmetric_);
    if (!factor.is_made() || num > kMaxStepsOfIncrement * options.num_increments) fail();
    if (arc.weight.size() == 0) {
      arc.weight = VectorXd(point.K.diagonal()).cwiseAbs();
      arc.weight = arc.weight.cwiseMax(1e-12 * arc.weight.maxCoeff());
    }
    const VectorXd along = -factor.solve(point.slope);
    const double rate = std::sqrt(arc.calc_product(along, along));
    if (share == 0 && point.slope.isZero(0)) {  // nothing to follow: the state stays
      share = 1;
      VectorXd rest = VectorXd::Zero(along.size());
      int num_last = 0;
      if (!arc.correct(rest, share, true, options.max_iterations, num_last)) fail();
      ++num_steps_;
      break;
    }
    if (!(rate > 0) || !std::isfinite(rate)) fail();
    if (full == 0) full = length = rate / options.num_increments;
    const bool goes_back = previous.size() > 0 && arc.calc_product(previous, along) < 0;
    const double change = (goes_back ? -1 : 1) * length / rate;
    VectorXd total = change * along;
    arc.advance(total, change);
    share += change;
    int num_iterations = 0;
    bool is_found = arc.correct(total, share, false, options.max_iterations, num_iterations);
    const double size = std::sqrt(arc.calc_product(total, total));
    is_found = is_found && size < 2 * length &&
               (previous.size() == 0 || arc.calc_product(total, previous) >
                                            kMinCosine * size * std::sqrt(arc.calc_product(previous, previous)));
    if (is_found && share >= 1) {
      VectorXd rest = VectorXd::Zero(total.size());
      if (arc.enforced.size() > 0) advance((1 - share) * arc.enforced);
      share = 1;
      int num_last = 0;
      is_found = arc.correct(rest, share, true, options.max_iterations, num_last) &&
                 std::sqrt(arc.calc_product(rest, rest)) < 2 * length;
    }
    if (!is_found) {
      state_ = before;
      share = share_before;
      length /= 2;
      if (length < full / (1 << kMaxHalvings)) fail();
      continue;
    }
    ++num_steps_;
    const double moved = share - share_before;
    if (moved * last_change < 0 && ++num_limits == 1) first_limit = share_before;
    last_change = moved;
    previous = total;
    if (num_iterations <= kMaxIterationsToGrow) length = std::min(2 * length, full);
    F_ = arc.F_start + share * arc.dF;
    d_ = start.d + share * dd;
  }
  // Without the round-off of the sums of steps, so that an equal load is no change.
  F_ = calc_dead_forces(to);
  d_ = to.d;
  load_ = to;
  const auto end = arc.evaluate(1);
  if (num_limits > 0)
    diagnostics.warning("fe.limit-point", {},
                        "the path to the load passes " + std::to_string(num_limits) +
                            " limit point(s), the first near " + format_share(first_limit) +
                            " % of the load, where the structure snaps through",
                        "see whether the state before it is the one you want: leave --arc-length out");
  if (!TangentFactor(end.K, is_symmetric_).is_stable())
    diagnostics.warning("fe.unstable-equilibrium", {},
                        "the static equilibrium is unstable: its tangent stiffness is not positive definite",
                        "look for buckling on the way, by SOL 105 or without --arc-length");
}

}  // namespace bough::fe
