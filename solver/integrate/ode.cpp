#include "solver/integrate/ode.hpp"

#include <algorithm>

#include "base/diagnostic.hpp"

namespace bough::solver {

void Ode::calc_stage(double, const Eigen::Ref<const VectorXd>&, double, bool, Eigen::Ref<VectorXd>) {
  BOUGH_DEMAND(false);
}

template <class Action>
int GuardedOde::guard(double t, double* out, const Action& action) noexcept {
  const double time = std::min(t, left_limit_);
  try {
    Eigen::Map<VectorXd> result(out, ode_.size());
    action(time, result);
    if (result.allFinite()) return 0;
    non_finite_ = true;
    bad_time_ = time;
  } catch (...) {
    pending_ = std::current_exception();
  }
  return 1;
}

template <class Action>
int GuardedOde::evaluate(double t, double* out, const Action& action) noexcept {
  ++num_evaluations_;
  pending_ = nullptr;
  return guard(t, out, action);
}

int GuardedOde::project(double t, double* y) noexcept {
  return guard(t, y, [&](double time, Eigen::Map<VectorXd>& state) { ode_.project(time, state); });
}

int GuardedOde::project_error(double* error) noexcept {
  try {
    Eigen::Map<VectorXd> e(error, ode_.size());
    ode_.project_error(e);
    return e.allFinite() ? 0 : 1;
  } catch (...) {
    pending_ = std::current_exception();
  }
  return 1;
}

int GuardedOde::calc(double t, const double* y, double* y_dot) noexcept {
  return evaluate(t, y_dot, [&](double time, Eigen::Map<VectorXd>& result) {
    ode_.calc_derivative(time, Eigen::Map<const VectorXd>(y, ode_.size()), result);
  });
}

int GuardedOde::calc_stage(double t, const double* y, double gamma_h, bool is_first, double* k) noexcept {
  return evaluate(t, k, [&](double time, Eigen::Map<VectorXd>& result) {
    ode_.calc_stage(time, Eigen::Map<const VectorXd>(y, ode_.size()), gamma_h, is_first, result);
  });
}

}  // namespace bough::solver
