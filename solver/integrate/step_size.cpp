#include "solver/integrate/step_size.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/diagnostic.hpp"

namespace bough::solver::detail {

double calc_error_weight(const StepperOptions& options, const VectorXd& y, Eigen::Index i) {
  return std::max(options.relative_tolerance * std::abs(y[i]) + options.absolute_tolerance[i], 1e-300);
}

double calc_error_norm(const StepperOptions& options, const VectorXd& y, const VectorXd& v) {
  double sum = 0;
  for (Eigen::Index i = 0; i < v.size(); ++i) sum += std::pow(v[i] / calc_error_weight(options, y, i), 2);
  return std::sqrt(sum / static_cast<double>(std::max<Eigen::Index>(1, v.size())));
}

double calc_smallest_step(const StepperOptions& options, double left) {
  const double smallest = 1e-13 * left;
  return options.step > 0 ? std::min(smallest, 1e-3 * options.step) : smallest;
}

double guess_first_step(GuardedOde& ode, const StepperOptions& options, int order, double t, const VectorXd& y,
                        const Eigen::Ref<const VectorXd>& y_dot, double min_step, double max_step, VectorXd& stage,
                        VectorXd& stage_dot) {
  max_step = std::max(min_step, max_step);
  stage = y_dot;
  const double d0 = calc_error_norm(options, y, y), d1 = calc_error_norm(options, y, stage);
  const double h = std::clamp(d0 < 1e-5 || d1 < 1e-5 ? 1e-6 : 0.01 * d0 / d1, min_step, max_step);
  stage = y + h * y_dot;
  if (ode.calc(t + h, stage.data(), stage_dot.data()) != 0) return h;
  stage_dot -= y_dot;
  const double d2 = calc_error_norm(options, y, stage_dot) / h, largest = std::max(d1, d2);
  const double other = largest <= 1e-15 ? std::max(1e-6, 1e-3 * h) : std::pow(0.01 / largest, 1.0 / order);
  return std::max(min_step, std::min(100 * h, other));
}

bool copy_end_state(double t, const LastStep& step, Eigen::Ref<VectorXd> y) {
  if (t == step.to) {
    y = step.y_to;
    return true;
  }
  BOUGH_DEMAND(t >= step.from && t < step.to);
  if (t == step.from) y = step.y_from;
  return t == step.from;
}

std::string describe_rejection(double step, double error) {
  char text[96];
  std::snprintf(text, sizeof text, "steps of %.3g err by %.3g tolerances", step, error);
  return text;
}

void throw_failure(GuardedOde& ode, double t, std::string detail, int row) {
  ode.throw_pending();
  throw StepFailure{ode.was_non_finite() ? StepFailure::Kind::NonFinite : StepFailure::Kind::Stalled, t,
                    std::move(detail), ode.bad_time(), row};
}

}  // namespace bough::solver::detail
