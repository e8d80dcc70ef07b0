#include "solver/integrate/ode.hpp"

#include <algorithm>

namespace bough::solver {

int GuardedOde::calc(double t, const double* y, double* y_dot) noexcept {
  ++num_evaluations_;
  pending_ = nullptr;
  const double time = std::min(t, latest_);
  try {
    Eigen::Map<VectorXd> result(y_dot, ode_.size());
    ode_.calc_derivative(time, Eigen::Map<const VectorXd>(y, ode_.size()), result);
    if (result.allFinite()) return 0;
    non_finite_ = true;
    bad_time_ = time;
  } catch (...) {
    pending_ = std::current_exception();
  }
  return 1;
}

int GuardedOde::project(double t, double* y) noexcept {
  try {
    Eigen::Map<VectorXd> state(y, ode_.size());
    ode_.project(std::min(t, latest_), state);
    if (state.allFinite()) return 0;
    non_finite_ = true;
    bad_time_ = t;
  } catch (...) {
    pending_ = std::current_exception();
  }
  return 1;
}

}  // namespace bough::solver
