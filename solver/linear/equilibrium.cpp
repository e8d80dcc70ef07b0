#include "solver/linear/equilibrium.hpp"

#include <algorithm>
#include <limits>
#include <sstream>

#include "solver/linear/gradient_flow.hpp"
#include "solver/linear/linearize.hpp"
#include "solver/linear/sampled.hpp"

namespace bough::solver {
namespace {

constexpr int kMaxIterations = 60;
/// Travel in steps of the plant within which the state found is the one that was meant, stable or not.
constexpr double kNear = 1;
/// Largest travel of a stable state that whole steps of Newton's method found from a start that does not diverge (there
/// its steps are those of the way downhill): a quarter of the size of a body.
constexpr double kDirect = 5;
/// Largest difference of two states that are the same.
constexpr double kSameState = 1e-9;

/// The largest of what dofs move by, in steps of the plant; the size of a state or of a signal says nothing.
double calc_way(const EquilibriumResidual& at, const VectorXd& steps) {
  double way = 0;
  for (size_t j = 0; j < at.free().size(); ++j)
    if (at.free()[j] < at.plant().num_dofs()) way = std::max(way, std::abs(steps[static_cast<Eigen::Index>(j)]));
  return way;
}

/// From the start.
double calc_way(const EquilibriumResidual& at) { return calc_way(at, at.travel()); }

class Newton {
 public:
  explicit Newton(EquilibriumResidual at) : at_(std::move(at)), start_(at_) {}

  void solve() {
    for (; num_iterations_ < kMaxIterations; ++num_iterations_) {
      linearize();
      if (num_iterations_ == 0) start_ = at_;
      const VectorXd step = solve_step(at_);
      const double size = step.size() > 0 ? step.cwiseAbs().maxCoeff() : 0;
      if (size < 1e-9) {
        // The last step is free: the Jacobian is there.
        take(step);
        return;
      }
      if (!search(step)) return;
    }
  }

  const EquilibriumResidual& at() const { return at_; }
  /// The start, linearized.
  const EquilibriumResidual& start() const { return start_; }
  /// Returns true if no step was damped.
  bool is_direct() const { return is_direct_; }
  int num_iterations() const { return num_iterations_; }

  /// The row with the largest residual relative to the effect of a small displacement; -1 if all vanish.
  int find_restless() const {
    const VectorXd& residual = at_.residual();
    const double floor = row_scale_.size() > 0 ? 1e-9 * row_scale_.maxCoeff() : 0;
    const VectorXd rounding = at_.calc_rounding();
    int worst = -1;
    double largest = 1;
    for (int i = 0; i < static_cast<int>(residual.size()); ++i) {
      const double allowed =
          std::max({1e-7 * row_scale_[i], floor * 1e-3, rounding[i], 1e3 * std::numeric_limits<double>::min()});
      if (std::abs(residual[i]) / allowed <= largest) continue;
      largest = std::abs(residual[i]) / allowed;
      worst = i;
    }
    return worst;
  }

  bool is_held(int row) const { return row_scale_[row] > 0; }

  /// A displacement without effect, to first order: its unit vector lies in the null space of the Jacobian.
  std::vector<std::string> name_neutral() const {
    std::vector<std::string> names;
    for (size_t j = 0; j < at_.free().size(); ++j) {
      if (at_.free()[j] >= at_.plant().num_dofs() || has_effect(j)) continue;
      // The integral of its rate may have one.
      const bool is_carried = has_kept_ && conserved_.col(static_cast<Eigen::Index>(j)).norm() > 1e-9;
      if (!is_carried) names.push_back(at_.name(at_.free()[j]));
    }
    return names;
  }

  /// States with an effect that no displacement changes: they are what they start from.
  std::vector<std::string> name_kept() const {
    std::vector<std::string> names;
    for (size_t j = 0; j < at_.free().size(); ++j) {
      const int i = at_.free()[j];
      const bool is_state = i >= at_.plant().num_dofs();
      if (is_state && has_kept_ && has_effect(j) && null_space_.row(static_cast<Eigen::Index>(j)).norm() < 1e-12)
        names.push_back(at_.name(i));
    }
    return names;
  }

 private:
  bool has_effect(size_t j) const {
    const VectorXd effect = weight_.asDiagonal() * at_.jacobian().col(static_cast<Eigen::Index>(j));
    return effect.size() > 0 && effect.cwiseAbs().maxCoeff() >= 1e-9;
  }

  /// Rows are scaled by their largest entry.
  void linearize() {
    at_.linearize();
    const MatrixXd& jacobian = at_.jacobian();
    row_scale_ = jacobian.cols() > 0 ? VectorXd(jacobian.rowwise().lpNorm<Eigen::Infinity>())
                                     : VectorXd(VectorXd::Zero(jacobian.rows()));
    weight_ = row_scale_.unaryExpr([](double s) { return s > 0 ? 1 / s : 0; });
    if (jacobian.cols() == 0) return;  // every hinge has a given rate or motion
    MatrixXd conserved = at_.calc_conserved();
    for (Eigen::Index i = 0; i < conserved.rows(); ++i) conserved.row(i) /= conserved.row(i).norm();
    conserved_solver_.setThreshold(1e-9);
    has_kept_ = conserved.rows() > 0;
    null_space_ = MatrixXd::Identity(jacobian.cols(), jacobian.cols());
    if (has_kept_) {
      conserved_ = conserved;
      conserved_solver_.compute(conserved);
      // Columns of Q of Cᵀ P = Q R past its rank.
      Eigen::ColPivHouseholderQR<MatrixXd> qr(conserved.transpose());
      qr.setThreshold(1e-9);
      null_space_ = MatrixXd(qr.householderQ()).rightCols(jacobian.cols() - qr.rank());
    }
    factor_.setThreshold(1e-9);
    if (null_space_.cols() > 0) factor_.compute(weight_.asDiagonal() * jacobian * null_space_);
  }

  /// Newton step of least norm that restores what every motion conserves from the start (calc_conserved).
  VectorXd solve_step(const EquilibriumResidual& at) const {
    if (at_.free().empty()) return {};
    VectorXd residual = at.residual(), step = VectorXd::Zero(at.travel().size());
    if (has_kept_) {
      step = -conserved_solver_.solve(conserved_ * at.travel());
      residual += at_.jacobian() * step;
    }
    if (null_space_.cols() > 0) step -= null_space_ * factor_.solve(weight_.asDiagonal() * residual);
    return step;
  }

  void take(const VectorXd& step) {
    EquilibriumResidual moved = at_.move(step);
    const auto calc_norm = [this](const EquilibriumResidual& at) {
      return (weight_.array() * at.residual().array()).matrix().norm();
    };
    if (!(calc_norm(moved) <= calc_norm(at_))) return;
    at_ = std::move(moved);
  }

  /// Half the step until the next correction, by the same Jacobian, is smaller.
  bool search(const VectorXd& step) {
    // No more than a radian or the size of the bodies at once.
    double by = std::min(1.0, 10 / std::max(10.0, calc_way(at_, step)));
    for (; by > 1e-6; by /= 2) {
      try {
        EquilibriumResidual moved = at_.move(by * step);
        if (!moved.residual().allFinite() || solve_step(moved).norm() > (1 - by / 4) * step.norm()) continue;
        at_ = std::move(moved);
        is_direct_ = is_direct_ && by == 1;
        return true;
      } catch (const ComputationError&) {
        // Too far: the equations have no solution there.
      }
    }
    return false;
  }

  EquilibriumResidual at_, start_;
  int num_iterations_ = 0;
  bool is_direct_ = true;
  VectorXd row_scale_, weight_;
  bool has_kept_ = false;
  MatrixXd conserved_, null_space_;  ///< k x m; m x (m - k), orthonormal
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> factor_, conserved_solver_;
};

Newton run_newton(const EquilibriumResidual& start) {
  Newton newton(start);
  newton.solve();
  return newton;
}

[[noreturn]] void fail(const Newton& newton, const SourceLocation& at) {
  const int worst = newton.find_restless();
  std::ostringstream what;
  what << "no state of rest or steady spin was found: after " << newton.num_iterations() << " iterations |u_dot| is "
       << newton.at().rates().norm() << ", most of all " << newton.at().name(worst)
       << (worst < newton.at().plant().num_dofs() ? ", which accelerates by " : ", which changes by ")
       << newton.at().rates()[worst];
  const auto& free = newton.at().free();
  const bool spins = std::find(free.begin(), free.end(), worst) == free.end();
  throw ComputationError(
      "equilibrium.not-converged", at, what.str(),
      spins ? "its rate is given in the system file, which its loads and dampers change: prescribe its motion, "
              "take them away, or give it the rate 0"
      : worst >= newton.at().plant().num_dofs()
          ? "a controller comes to rest only where what it measures can: an integral wants something that it can move"
      : newton.is_held(worst) ? "start nearer to it, by position and eta"
                              : "nothing holds it: take away the load, or give it a spring or a hinge");
}

[[noreturn]] void fail_beyond(const EquilibriumResidual& start, int diverged, const SourceLocation& at) {
  throw ComputationError("equilibrium.not-converged", at,
                         "no state of rest or steady spin was found: on the way downhill " + start.name(diverged) +
                             " deflects its body by more than twice the size of the bodies",
                         "lower the load, or cut the deck of the body into several bodies with bough split: its model "
                         "is one of small deflections");
}

/// Newton's method from the start, when that leads to a state nearby; else it or that from where the way downhill ends:
/// a stable one before one that is not, then the nearer. A way downhill out of the range of a body has no end.
Newton search(const EquilibriumResidual& start, const SourceLocation& at) {
  Newton first = run_newton(start);
  const bool is_found = first.find_restless() < 0;
  if (is_found && calc_way(first.at()) <= kNear) return first;
  if (is_found && first.is_direct() && calc_way(first.at()) <= kDirect && is_stable_rest(first.start()) &&
      is_stable_rest(first.at()))
    return first;
  GradientFlow flow = follow_gradient_flow(start);
  if (flow.diverged >= 0) {
    if (!is_found) fail_beyond(start, flow.diverged, at);
    return first;
  }
  Newton second = run_newton(flow.end);
  const bool is_other = second.find_restless() < 0;
  if (!is_found && !is_other) fail(second, at);
  if (!is_found || !is_other) return is_found ? first : second;
  const bool is_stable = is_stable_rest(first.at()), is_other_stable = is_stable_rest(second.at());
  if (is_stable != is_other_stable) return is_stable ? first : second;
  return calc_way(first.at()) <= calc_way(second.at()) ? first : second;
}

/// Poles that grow: of what does not only drift.
void find_unstable(Plant& plant, const SourceLocation& at, Equilibrium& found) {
  Diagnostics ignored_diagnostics;
  LinearizeOptions options;
  options.check = false;
  const records::LinearModel model = linearize(plant, found.point, options, at, ignored_diagnostics);
  // Outputs of sampled controllers are constant between samples: stability follows from the characteristic multipliers.
  records::Multipliers m;
  Uncertainty ignored;
  if (!plant.is_open()) m = calc_multipliers(plant, found.point, model.A, at, ignored_diagnostics, ignored);
  if (m.period > 0) {
    for (Eigen::Index k = 0; k < m.real.size(); ++k) {
      if (m.imag[k] < 0 || m.decay[k] * m.period <= 1e-6) continue;
      found.unstable.push_back({m.mode[static_cast<size_t>(k)], m.decay[k]});
    }
    return;
  }
  const records::Poles& poles = model.poles;
  const Eigen::ArrayXd size = (poles.real.array().square() + poles.imag.array().square()).sqrt();
  const double largest = size.size() > 0 ? size.maxCoeff() : 0;
  for (int k = 0; k < poles.size(); ++k) {
    if (poles.imag[k] < 0 || size[k] < 1e-7 * largest || poles.real[k] <= 1e-6 * size[k]) continue;
    found.unstable.push_back({poles.mode[static_cast<size_t>(k)], poles.real[k]});
  }
}

/// State of rest whose switches stay as they are in it: a search in the modes of `from`, then with those that its
/// result switches to.
Newton find_rest(Plant& plant, OperatingPoint from, const SourceLocation& at) {
  plant.iterate_switches(from);
  std::vector<VectorXd> modes;
  for (;;) {
    const OperatingPoint before = from;
    Newton newton = search(EquilibriumResidual(plant, from), at);
    from = newton.at().point();
    modes.push_back(from.memory);
    const std::string switched = plant.iterate_switches(from);
    if (switched.empty()) return newton;
    const bool is_known = std::find(modes.begin(), modes.end(), from.memory) != modes.end();
    // On the line itself both modes rest.
    if (is_known && (from.q - before.q).isZero(kSameState) && (from.z - before.z).isZero(kSameState)) return newton;
    if (is_known || std::ssize(modes) >= kMaxIterations)
      throw ComputationError("equilibrium.switching", at,
                             "no state of rest was found: " + switched +
                                 " switches in each state in which the system would rest without the switch",
                             "start nearer to a state of rest, or replace it by a continuous law: the system may have "
                             "a limit cycle in place of a state of rest");
  }
}

}  // namespace

Equilibrium find_equilibrium(Plant& plant, const OperatingPoint& start, const SourceLocation& at) {
  const Newton newton = find_rest(plant, start, at);
  Equilibrium found;
  found.point = newton.at().point();
  found.residual = newton.at().rates().norm();
  found.num_iterations = newton.num_iterations();
  found.neutral = newton.name_neutral();
  found.kept = newton.name_kept();
  for (int i = 0; i < plant.num_dofs(); ++i)
    if (!plant.is_mode(i) && found.point.u[i] != 0) found.spinning.push_back(plant.dof_name(i));
  find_unstable(plant, at, found);
  return found;
}

}  // namespace bough::solver
