#include "solver/linear/equilibrium.hpp"

#include <algorithm>
#include <limits>
#include <sstream>

#include "solver/linear/difference.hpp"

namespace bough::solver {
namespace {

constexpr int kMostIterations = 60;

class Newton {
 public:
  Newton(Plant& plant, OperatingPoint point, const SourceLocation& at)
      : plant_(plant), point_(std::move(point)), at_(at) {
    const int n = plant.num_freedoms();
    steps_ = VectorXd::Ones(size());
    for (int i = 0; i < n; ++i) {
      steps_[i] = plant.step(i);
      if (plant.is_mode(i)) point_.u[i] = 0;
      if (plant.is_mode(i) || point_.u[i] == 0) free_.push_back(i);
    }
    for (int i = n; i < size(); ++i) free_.push_back(i);
    residual_ = calc_residual(point_);
  }

  Equilibrium solve() {
    Equilibrium found;
    for (; found.num_iterations < kMostIterations; ++found.num_iterations) {
      linearize();
      const VectorXd step = solve_step(residual_);
      const double size = step.size() > 0 ? step.cwiseAbs().maxCoeff() : 0;
      if (size < 1e-9) {
        // The last step is free: the Jacobian is there.
        take(step);
        break;
      }
      if (!search(step)) break;
    }
    demand_rest(found.num_iterations);
    found.point = point_;
    found.residual = residual_.norm();
    name_indifferent(found);
    return found;
  }

 private:
  /// Rows and displacements: the freedoms, then the states of controllers and actuators.
  int size() const { return plant_.num_freedoms() + plant_.num_states(); }
  std::string name(int i) const {
    return i < plant_.num_freedoms() ? plant_.freedom_name(i) : plant_.state_name(i - plant_.num_freedoms());
  }
  OperatingPoint displace(const VectorXd& delta) const {
    OperatingPoint moved = point_;
    const int n = plant_.num_freedoms();
    moved.q = plant_.displace(point_.q, delta.head(n));
    for (int i = n; i < size(); ++i) moved.z[plant_.state_row(i - n)] += delta[i];
    return moved;
  }
  VectorXd calc_residual(const OperatingPoint& point) { return plant_.evaluate(point).head(size()); }

  /// Displacements are counted in steps of the plant, so that columns are alike; rows are scaled by their largest.
  void linearize() {
    const int n = size(), m = static_cast<int>(free_.size());
    jacobian_.setZero(n, m);
    for (int j = 0; j < m; ++j) {
      const int i = free_[static_cast<size_t>(j)];
      const auto f = [&](double h) { return calc_residual(displace(h * steps_[i] * VectorXd::Unit(n, i))); };
      const Difference column = differentiate(f, 0.5);
      jacobian_.col(j) = (column.value.array().abs() > column.error.array()).select(column.value, 0.0);
    }
    row_scale_ = m > 0 ? VectorXd(jacobian_.rowwise().lpNorm<Eigen::Infinity>()) : VectorXd::Zero(n);
    const VectorXd weight = row_scale_.unaryExpr([](double s) { return s > 0 ? 1 / s : 0; });
    factor_.setThreshold(1e-9);
    factor_.compute(weight.asDiagonal() * jacobian_);
    weight_ = weight;
  }

  VectorXd solve_step(const VectorXd& residual) const { return -factor_.solve(weight_.asDiagonal() * residual); }

  OperatingPoint move(const VectorXd& step, double by) const {
    VectorXd delta = VectorXd::Zero(size());
    for (size_t j = 0; j < free_.size(); ++j) {
      const int i = free_[j];
      delta[i] = by * step[static_cast<Eigen::Index>(j)] * steps_[i];
    }
    return displace(delta);
  }

  void take(const VectorXd& step) {
    const OperatingPoint moved = move(step, 1);
    const VectorXd residual = calc_residual(moved);
    if (!(residual.norm() <= residual_.norm())) return;
    point_ = moved;
    residual_ = residual;
  }

  /// Half the step until the next correction, by the same Jacobian, is smaller.
  bool search(const VectorXd& step) {
    // No more than a radian or the size of the bodies at once.
    double by = std::min(1.0, 10 / step.cwiseAbs().maxCoeff());
    for (; by > 1e-6; by /= 2) {
      try {
        const OperatingPoint moved = move(step, by);
        const VectorXd residual = calc_residual(moved);
        if (!residual.allFinite() || solve_step(residual).norm() > (1 - by / 4) * step.norm()) continue;
        point_ = moved;
        residual_ = residual;
        return true;
      } catch (const ComputationError&) {
        // Too far: the equations have no solution there.
      }
    }
    return false;
  }

  /// Each row of u̇ must vanish beside what a small displacement makes of it.
  void demand_rest(int num_iterations) const {
    const int n = size();
    const double floor = n > 0 ? 1e-9 * row_scale_.maxCoeff() : 0;
    int worst = -1;
    double largest = 1;
    for (int i = 0; i < n; ++i) {
      const double allowed = std::max({1e-7 * row_scale_[i], floor * 1e-3, 1e3 * std::numeric_limits<double>::min()});
      if (std::abs(residual_[i]) / allowed <= largest) continue;
      largest = std::abs(residual_[i]) / allowed;
      worst = i;
    }
    if (worst < 0) return;
    std::ostringstream what;
    what << "no state of rest or steady spin was found: after " << num_iterations << " iterations |u_dot| is "
         << residual_.norm() << ", most of all " << name(worst)
         << (worst < plant_.num_freedoms() ? ", which accelerates by " : ", which changes by ") << residual_[worst];
    throw ComputationError("equilibrium.not-converged", at_, what.str(),
                           row_scale_[worst] > 0
                               ? "start nearer to it, by position and eta"
                               : "nothing holds it: take away the load, or give it a spring or a hinge");
  }

  void name_indifferent(Equilibrium& found) const {
    const int n = plant_.num_freedoms();
    for (int i = 0; i < n; ++i) {
      if (!plant_.is_mode(i) && point_.u[i] != 0) found.spinning.push_back(plant_.freedom_name(i));
    }
    // A displacement without effect, to first order: its unit vector lies in the null space of the Jacobian.
    for (size_t j = 0; j < free_.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      const VectorXd effect = weight_.asDiagonal() * jacobian_.col(column);
      if (effect.size() == 0 || effect.cwiseAbs().maxCoeff() < 1e-9) found.indifferent.push_back(name(free_[j]));
    }
  }

  Plant& plant_;
  OperatingPoint point_;
  SourceLocation at_;
  VectorXd steps_, residual_, row_scale_, weight_;
  std::vector<int> free_;
  MatrixXd jacobian_;
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> factor_;
};

}  // namespace

Equilibrium find_equilibrium(Plant& plant, const OperatingPoint& start, const SourceLocation& at) {
  return Newton(plant, start, at).solve();
}

}  // namespace bough::solver
