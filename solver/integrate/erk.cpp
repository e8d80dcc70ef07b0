#include <arkode/arkode_erkstep.h>

#include <algorithm>

#include "solver/integrate/sundials.hpp"

namespace bough::solver {
namespace {

class ErkStepper final : public Stepper {
 public:
  ErkStepper(Ode& ode, const StepperOptions& options)
      : ode_(ode),
        y_(ode.size(), context_),
        last_y_(ode.size(), context_),
        between_(ode.size(), context_),
        tolerance_(ode.size(), context_),
        options_(options) {
    BOUGH_DEMAND(options.absolute_tolerance.size() == ode.size());
    BOUGH_DEMAND(options.rk_order == 5 || options.rk_order == 8);
    tolerance_.values() = options.absolute_tolerance;
  }
  ~ErkStepper() override {
    ERKStepFree(&arkode_);
    if (inner_) ERKStepFree(&inner_);
  }

  void restart(double t, const Eigen::Ref<const VectorXd>& y, double t_stop, double latest) override {
    y_.values() = y;
    t_ = last_ = t;
    if (!arkode_) {
      arkode_ = create(t, y_);
    } else {
      before_ = statistics();  // ERKStepReInit sets the counters to zero
      BOUGH_DEMAND(ERKStepReInit(arkode_, detail::call_ode, t, y_) == ARK_SUCCESS);
    }
    set_stop(t_stop, latest);
  }

  void set_stop(double t_stop, double latest) override {
    ode_.set_latest(latest);
    double smallest = detail::kSmallestStep * (t_stop - t_);
    if (options_.step > 0) smallest = std::min(smallest, 1e-3 * options_.step);
    BOUGH_DEMAND(ERKStepSetMinStep(arkode_, smallest) == ARK_SUCCESS);
  }

  void step(double t_target) override {
    last_ = t_;
    ode_.begin_step();
    last_y_.values() = y_.values();
    // Steps end on the targets: the interpolant is of lower order than the method.
    BOUGH_DEMAND(ERKStepSetStopTime(arkode_, t_target) == ARK_SUCCESS);
    double t = t_;
    const int flag = ERKStepEvolve(arkode_, t_target, y_, &t, ARK_ONE_STEP);
    if (flag >= 0) {
      t_ = t;
      return;
    }
    // A failed step leaves the time of the stage it failed at.
    detail::throw_failure(ode_, t_, "ARKODE", ERKStepGetReturnFlagName(flag));
  }

  double time() const override { return t_; }
  double last_time() const override { return last_; }
  Eigen::Map<const VectorXd> state() const override {
    const auto y = y_.values();
    return {y.data(), y.size()};
  }
  void calc_state(double t, Eigen::Ref<VectorXd> y) override {
    if (t == t_) {
      y = y_.values();
      return;
    }
    BOUGH_DEMAND(t >= last_ && t < t_);
    between_.values() = last_y_.values();
    if (t > last_) step_between(t);
    y = between_.values();
  }
  StepStatistics statistics() const override {
    StepStatistics s = before_;
    if (!arkode_) return s;
    long steps = 0, rejected = 0;
    ERKStepGetNumSteps(arkode_, &steps);
    ERKStepGetNumErrTestFails(arkode_, &rejected);
    ERKStepGetLastStep(arkode_, &s.step);
    s.order = options_.rk_order;
    s.num_steps += steps;
    s.num_rejected += rejected;
    s.num_evaluations = ode_.num_evaluations();
    return s;
  }

 private:
  void* create(double t, const detail::Vector& y) {
    void* arkode = ERKStepCreate(detail::call_ode, t, y, context_);
    BOUGH_DEMAND(arkode != nullptr);
    const auto check = [](int flag) { BOUGH_DEMAND(flag == 0); };
    check(ERKStepSetUserData(arkode, &ode_));
    check(ERKStepSetErrHandlerFn(arkode, detail::ignore_message, nullptr));
    check(ERKStepSVtolerances(arkode, options_.relative_tolerance, tolerance_));
    check(ERKStepSetTableNum(arkode, options_.rk_order == 5 ? ARKODE_DORMAND_PRINCE_7_4_5 : ARKODE_FEHLBERG_13_7_8));
    check(ERKStepSetMaxErrTestFails(arkode, detail::kMostRejections));
    if (options_.step > 0) check(ERKStepSetMaxStep(arkode, options_.step));
    // At order 5 the last stage serves as the next first one, from before the projection: off by no more than the step.
    if (ode_.has_projection()) check(ERKStepSetPostprocessStepFn(arkode, detail::call_projection));
    return arkode;
  }

  /// The last step again, but to t only.
  void step_between(double t) {
    ode_.begin_step();
    if (!inner_) inner_ = create(last_, between_);
    BOUGH_DEMAND(ERKStepReInit(inner_, detail::call_ode, last_, between_) == ARK_SUCCESS);
    BOUGH_DEMAND(ERKStepSetInitStep(inner_, t - last_) == ARK_SUCCESS);
    BOUGH_DEMAND(ERKStepSetStopTime(inner_, t) == ARK_SUCCESS);
    double reached = last_;
    const int flag = ERKStepEvolve(inner_, t, between_, &reached, ARK_NORMAL);
    if (flag < 0) detail::throw_failure(ode_, last_, "ARKODE", ERKStepGetReturnFlagName(flag));
  }

  detail::Context context_;
  GuardedOde ode_;
  detail::Vector y_, last_y_, between_, tolerance_;
  StepperOptions options_;
  void *arkode_ = nullptr, *inner_ = nullptr;
  double t_ = 0, last_ = 0;
  StepStatistics before_;
};

}  // namespace

std::unique_ptr<Stepper> make_erk_stepper(Ode& ode, const StepperOptions& options) {
  return std::make_unique<ErkStepper>(ode, options);
}

}  // namespace bough::solver
