#include "solver/linear/equilibrium_residual.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/linear/sampled_system.hpp"

namespace bough::solver {
namespace {

/// Forces that change by less than this part of the largest change do not depend on a coordinate.
constexpr double kIndependent = 1e-6;

/// Rolling: sets the rates of coordinates on which forces depend, as a lean, to zero; others, as the angle of a wheel,
/// may turn in a steady motion. The assembly of rates gives all of them values.
void stop_positions(Plant& plant, OperatingPoint& point) {
  const int n = plant.num_dofs();
  plant.evaluate(point);
  const VectorXd here = plant.calc_imbalance();
  VectorXd change(n);
  for (int i = 0; i < n; ++i) {
    try {
      OperatingPoint moved = point;
      moved.q = plant.displace(point.q, 0.5 * plant.step(i) * VectorXd::Unit(n, i));
      plant.evaluate(moved);
      change[i] = (plant.calc_imbalance() - here).lpNorm<Eigen::Infinity>();
    } catch (const ComputationError&) {
      change[i] = std::numeric_limits<double>::infinity();  // it does not go as far
    }
  }
  double largest = 0;
  for (const double one : change)
    if (std::isfinite(one)) largest = std::max(largest, one);
  for (int i = 0; i < n; ++i)
    if (change[i] > kIndependent * largest) point.u[i] = 0;
}

}  // namespace

EquilibriumResidual::EquilibriumResidual(Plant& plant, const OperatingPoint& start)
    : plant_(&plant), point_(start), used_up_(plant.find_used_up()) {
  if (plant.num_paths() > 0) stop_positions(plant, point_);
  for (int i = 0; i < plant.num_dofs(); ++i) {
    if (plant.is_mode(i)) point_.u[i] = 0;
    if (plant.is_mode(i) || point_.u[i] == 0) free_.push_back(i);
  }
  for (int i = plant.num_dofs(); i < size(); ++i) free_.push_back(i);
  // The first sample, as a run takes it.
  if (!plant.steady_rows().empty()) {
    point_.memory = plant.sample_all(point_);
    plant.fill_queues(point_.memory);
  }
  travel_.setZero(static_cast<Eigen::Index>(free_.size()));
  evaluate();
}

VectorXd EquilibriumResidual::calc_rounding() const {
  VectorXd rounding = VectorXd::Zero(size());
  const int n = plant_->num_dofs();
  const VectorXd of_rates = plant_->calc_spin_rounding(point_);
  if (!of_rates.isZero(0)) rounding.head(n) = plant_->calc_mass(point_).cwiseAbs() * of_rates;
  return rounding;
}

void EquilibriumResidual::linearize() {
  const int m = static_cast<int>(free_.size());
  const int n = size(), num_dofs = plant_->num_dofs();
  jacobian_.setZero(n, m);
  rate_jacobian_.setZero(n, m);
  for (int j = 0; j < m; ++j) {
    const auto f = [&](double h) -> VectorXd {
      const EquilibriumResidual moved = move(h * VectorXd::Unit(m, j));
      VectorXd both(n + num_dofs);
      both << moved.residual_, moved.rates_.head(num_dofs);
      return both;
    };
    const int i = free_[static_cast<size_t>(j)];
    const double first = i < num_dofs ? choose_displacement(*plant_, i) / step(j) : 1;
    const VectorXd slope = plant_->differentiate(f, 0.5 * first).calc_clean();
    jacobian_.col(j) = rate_jacobian_.col(j) = slope.head(n);
    rate_jacobian_.col(j).head(num_dofs) = slope.tail(num_dofs);
  }
}

void EquilibriumResidual::evaluate() {
  const int n = plant_->num_dofs();
  const VectorXd rates = plant_->evaluate(point_);
  rates_.resize(size());
  rates_.head(n) = plant_->calc_unsteadiness(rates);
  rates_.segment(n, plant_->num_signal_states()) = rates.segment(n, plant_->num_signal_states());
  for (const int i : used_up_) rates_[n + i] = 0;
  residual_ = rates_;
  residual_.head(n) = plant_->calc_imbalance();
  rates_.tail(size() - n - plant_->num_signal_states()) = plant_->calc_sample_rates(point_);
  residual_.tail(size() - n) = rates_.tail(size() - n);
}

MatrixXd EquilibriumResidual::calc_conserved() const {
  const int n = plant_->num_dofs(), rows = size() - n;
  const auto m = static_cast<Eigen::Index>(free_.size());
  if (rows == 0) return MatrixXd::Zero(0, m);
  // b with b · ∂ż = 0: left null space, each row by its largest entry.
  MatrixXd rates = jacobian_.bottomRows(rows);
  VectorXd scale = m > 0 ? VectorXd(rates.rowwise().lpNorm<Eigen::Infinity>()) : VectorXd(VectorXd::Zero(rows));
  scale = scale.unaryExpr([](double s) { return s > 0 ? 1 / s : 1; });
  Eigen::FullPivLU<MatrixXd> factor((scale.asDiagonal() * rates).transpose());
  factor.setThreshold(1e-9);
  const MatrixXd b =
      m > 0 ? MatrixXd(factor.kernel().transpose() * scale.asDiagonal()) : MatrixXd(MatrixXd::Identity(rows, rows));
  if (b.isZero(0)) return MatrixXd::Zero(0, m);  // kernel: one column of zeros
  // b · (z - z₀) = (b · ∂ż/∂u) (δ - δ₀), since δ̇ = δu.
  MatrixXd conserved(b.rows(), m);
  for (Eigen::Index j = 0; j < m; ++j) {
    const int i = free_[static_cast<size_t>(j)];
    if (i >= n) {
      conserved.col(j) = b.col(i - n);
      continue;
    }
    const auto f = [&](double h) -> VectorXd {
      EquilibriumResidual moved = *this;
      moved.point_.u[i] += h;
      moved.evaluate();
      return moved.rates_.tail(rows);
    };
    const VectorXd by_rate = plant_->differentiate(f, step(static_cast<int>(j))).calc_clean();
    conserved.col(j) = -step(static_cast<int>(j)) * (b * by_rate);
  }
  return conserved;
}

std::string EquilibriumResidual::name(int row) const {
  const int n = plant_->num_dofs(), nz = plant_->num_signal_states();
  return row < n        ? plant_->dof_name(row)
         : row < n + nz ? plant_->state_name(row - n)
                        : plant_->steady_name(row - n - nz);
}

EquilibriumResidual EquilibriumResidual::move(const VectorXd& steps) const {
  const int n = plant_->num_dofs(), nz = plant_->num_signal_states();
  VectorXd delta = VectorXd::Zero(size());
  for (size_t j = 0; j < free_.size(); ++j)
    delta[free_[j]] = steps[static_cast<Eigen::Index>(j)] * step(static_cast<int>(j));
  EquilibriumResidual moved = *this;
  moved.point_.q = plant_->displace(point_.q, delta.head(n));
  for (int i = n; i < n + nz; ++i) moved.point_.z[plant_->state_row(i - n)] += delta[i];
  if (size() > n + nz) {
    moved.point_.memory(plant_->steady_rows()) += delta.tail(size() - n - nz);
    plant_->fill_queues(moved.point_.memory);
  }
  moved.travel_ += steps;
  moved.evaluate();
  return moved;
}

}  // namespace bough::solver
