#include <arkode/arkode_erkstep.h>

#include "solver/integrate/sundials.hpp"

namespace bough::solver {
namespace {

class ErkStepper final : public Stepper {
 public:
  ErkStepper(Ode& ode, const StepperOptions& options)
      : ode_(ode), y_(ode.size(), context_), tolerance_(ode.size(), context_), options_(options) {
    BOUGH_DEMAND(options.absolute_tolerance.size() == ode.size());
    BOUGH_DEMAND(options.rk_order == 5 || options.rk_order == 8);
    tolerance_.values() = options.absolute_tolerance;
  }
  ~ErkStepper() override { ERKStepFree(&arkode_); }

  void restart(double t, const Eigen::Ref<const VectorXd>& y, double t_stop, double latest) override {
    y_.values() = y;
    t_ = t;
    ode_.set_latest(latest);
    if (!arkode_) {
      create(t);
    } else {
      before_ = statistics();  // ERKStepReInit sets the counters to zero
      BOUGH_DEMAND(ERKStepReInit(arkode_, detail::call_ode, t, y_) == ARK_SUCCESS);
    }
    BOUGH_DEMAND(ERKStepSetMinStep(arkode_, detail::kSmallestStep * (t_stop - t)) == ARK_SUCCESS);
  }

  void step(double t_target) override {
    ode_.clear();
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
  Eigen::Map<const VectorXd> state() const override {
    const auto y = y_.values();
    return {y.data(), y.size()};
  }
  void calc_state(double t, Eigen::Ref<VectorXd> y) override {
    BOUGH_DEMAND(t == t_);
    y = y_.values();
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
  void create(double t) {
    arkode_ = ERKStepCreate(detail::call_ode, t, y_, context_);
    BOUGH_DEMAND(arkode_ != nullptr);
    const auto check = [](int flag) { BOUGH_DEMAND(flag == 0); };
    check(ERKStepSetUserData(arkode_, &ode_));
    check(ERKStepSetErrHandlerFn(arkode_, detail::ignore_message, nullptr));
    check(ERKStepSVtolerances(arkode_, options_.relative_tolerance, tolerance_));
    check(ERKStepSetTableNum(arkode_, options_.rk_order == 5 ? ARKODE_DORMAND_PRINCE_7_4_5 : ARKODE_FEHLBERG_13_7_8));
    if (options_.step > 0) check(ERKStepSetMaxStep(arkode_, options_.step));
  }

  detail::Context context_;
  GuardedOde ode_;
  detail::Vector y_, tolerance_;
  StepperOptions options_;
  void* arkode_ = nullptr;
  double t_ = 0;
  StepStatistics before_;
};

}  // namespace

std::unique_ptr<Stepper> make_erk_stepper(Ode& ode, const StepperOptions& options) {
  return std::make_unique<ErkStepper>(ode, options);
}

}  // namespace bough::solver
