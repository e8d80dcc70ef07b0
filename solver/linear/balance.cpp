#include "solver/linear/balance.hpp"

#include "solver/linear/difference.hpp"

namespace bough::solver {

Balance::Balance(Plant& plant, const OperatingPoint& start) : plant_(&plant), point_(start) {
  for (int i = 0; i < plant.num_freedoms(); ++i) {
    if (plant.is_mode(i)) point_.u[i] = 0;
    if (plant.is_mode(i) || point_.u[i] == 0) free_.push_back(i);
  }
  for (int i = plant.num_freedoms(); i < size(); ++i) free_.push_back(i);
  travel_.setZero(static_cast<Eigen::Index>(free_.size()));
  residual_ = calc_residual();
}

void Balance::linearize() {
  const int m = static_cast<int>(free_.size());
  jacobian_.setZero(size(), m);
  for (int j = 0; j < m; ++j) {
    const auto f = [&](double h) -> VectorXd { return move(h * VectorXd::Unit(m, j)).residual_; };
    const Difference column = differentiate(f, 0.5);
    jacobian_.col(j) = (column.value.array().abs() > column.error.array()).select(column.value, 0.0);
  }
}

std::string Balance::name(int row) const {
  const int n = plant_->num_freedoms();
  return row < n ? plant_->freedom_name(row) : plant_->state_name(row - n);
}

Balance Balance::move(const VectorXd& steps) const {
  const int n = plant_->num_freedoms();
  VectorXd delta = VectorXd::Zero(size());
  for (size_t j = 0; j < free_.size(); ++j)
    delta[free_[j]] = steps[static_cast<Eigen::Index>(j)] * step(static_cast<int>(j));
  Balance moved = *this;
  moved.point_.q = plant_->displace(point_.q, delta.head(n));
  for (int i = n; i < size(); ++i) moved.point_.z[plant_->state_row(i - n)] += delta[i];
  moved.travel_ += steps;
  moved.residual_ = moved.calc_residual();
  return moved;
}

}  // namespace bough::solver
