#include "solver/integrate/fixed_step.hpp"

#include <algorithm>
#include <cmath>

#include "base/diagnostic.hpp"
#include "solver/integrate/step_size.hpp"

namespace bough::solver {

FixedStepIntegrator::FixedStepIntegrator(Ode& ode, const StepperOptions& options, int order)
    : ode_(ode), h_max_(options.step), order_(order) {
  BOUGH_DEMAND(options.step > 0);
  for (VectorXd* v : {&y_, &last_y_, &between_}) v->setZero(ode.size());
}

void FixedStepIntegrator::reset(double t, const Eigen::Ref<const VectorXd>& y, double t_stop, double left) {
  t_ = last_ = target_ = t;
  y_ = y;
  set_stop(t_stop, left);
}

void FixedStepIntegrator::step(double t_target) {
  if (t_target != target_) {
    from_ = t_;
    target_ = t_target;
    // A step that divides the interval up to rounding does so.
    count_ = std::max<long>(1, static_cast<long>(std::ceil((t_target - t_) / h_max_ * (1 - 1e-9))));
    done_ = 0;
  }
  const double h = (target_ - from_) / static_cast<double>(count_);
  const double t_next = done_ + 1 == count_ ? target_ : from_ + h * static_cast<double>(done_ + 1);
  last_ = t_;
  ode_.begin_step();
  last_y_ = y_;
  calc_step(t_, h, t_next, y_);
  ++done_;
  t_ = t_next;
  statistics_.step = h;
  ++statistics_.num_steps;
}

void FixedStepIntegrator::calc_state(double t, Eigen::Ref<VectorXd> y) {
  if (detail::copy_end_state(t, {last_, last_y_, t_, y_}, y)) return;
  between_ = last_y_;
  calc_step(last_, t - last_, t, between_);
  y = between_;
}

Eigen::Vector4d FixedStepIntegrator::memory() const {
  return {from_, target_, static_cast<double>(count_), static_cast<double>(done_)};
}

void FixedStepIntegrator::set_memory(const Eigen::Vector4d& memory) {
  from_ = memory[0];
  target_ = memory[1];
  count_ = static_cast<long>(memory[2]);
  done_ = static_cast<long>(memory[3]);
  if (done_ >= count_) target_ = t_;  // it stood at the end of its interval
}

StepStatistics FixedStepIntegrator::statistics() const {
  StepStatistics s = statistics_;
  s.order = order_;
  s.num_evaluations = ode_.num_evaluations();
  return s;
}

void FixedStepIntegrator::check(int flag) {
  if (flag == 0) return;
  ode_.throw_pending();
  throw StepFailure{StepFailure::Kind::NonFinite, t_, "the derivative is not finite", ode_.bad_time()};
}

}  // namespace bough::solver
