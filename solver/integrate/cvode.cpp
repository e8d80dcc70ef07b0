#include <cvode/cvode.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cstdlib>

#include "solver/integrate/step_size.hpp"
#include "solver/integrate/sundials.hpp"

namespace bough::solver {
namespace {

int call_correction(sunrealtype t, N_Vector y, N_Vector correction, sunrealtype, N_Vector, void* user) {
  N_VScale(1, y, correction);
  const int flag = static_cast<GuardedOde*>(user)->project(t, N_VGetArrayPointer(correction));
  N_VLinearSum(1, correction, -1, y, correction);
  return flag;
}

/// Weights with tolerances that may change between steps; those of CVODE may not.
struct WeighedOde : GuardedOde {
  using GuardedOde::GuardedOde;
  double relative = 0;
  VectorXd absolute;
};

int weigh(N_Vector y, N_Vector weights, void* user) {
  const auto& ode = *static_cast<const WeighedOde*>(static_cast<GuardedOde*>(user));
  const Eigen::Map<const VectorXd> value(N_VGetArrayPointer(y), N_VGetLength(y));
  Eigen::Map<VectorXd> weight(N_VGetArrayPointer(weights), N_VGetLength(weights));
  weight = ode.relative * value.cwiseAbs() + ode.absolute;
  if ((weight.array() <= 0).any()) return -1;
  weight = weight.cwiseInverse();
  return 0;
}

class CvodeStepper final : public Integrator {
 public:
  CvodeStepper(Ode& ode, const StepperOptions& options, bool stiff)
      : ode_(ode), y_(ode.size(), context_), interpolated_(ode.size(), context_), options_(options), stiff_(stiff) {
    BOUGH_DEMAND(options.absolute_tolerance.size() == ode.size());
    BOUGH_DEMAND(stiff || !ode.has_projection());  // CVODE projects with BDF only
    ode_.relative = options.relative_tolerance;
    ode_.absolute = options.absolute_tolerance;
  }
  ~CvodeStepper() override {
    CVodeFree(&cvode_);
    if (nonlinear_) SUNNonlinSolFree(nonlinear_);
    if (linear_) SUNLinSolFree(linear_);
    if (matrix_) SUNMatDestroy(matrix_);
  }

  void reset(double t, const Eigen::Ref<const VectorXd>& y, double t_stop, double left) override {
    y_.values() = y;
    t_ = last_ = t;
    if (!cvode_) {
      create(t);
    } else {
      before_ = statistics();  // CVodeReInit sets the counters to zero
      BOUGH_DEMAND(CVodeReInit(cvode_, t, y_) == CV_SUCCESS);
    }
    set_stop(t_stop, left);
  }

  void set_stop(double t_stop, double left) override {
    t_stop_ = t_stop;
    ode_.set_left_limit(left);
    BOUGH_DEMAND(CVodeSetStopTime(cvode_, t_stop) == CV_SUCCESS);
    // CVODE refuses a smallest step above the largest one.
    BOUGH_DEMAND(CVodeSetMinStep(cvode_, detail::calc_smallest_step(options_, t_stop - t_)) == CV_SUCCESS);
  }

  void step(double) override {
    // CVODE changes its order only when it changes its step. At the largest step it would keep its order, which is 1 if
    // the first step is the largest already. An alternating limit allows a higher order.
    if (options_.step > 0) CVodeSetMaxStep(cvode_, options_.step * (trembles_ ? 1 : 1 - 1e-6));
    trembles_ = !trembles_;
    last_ = t_;
    ode_.begin_step();
    const int flag = CVode(cvode_, t_stop_, y_, &t_, CV_ONE_STEP);
    if (flag >= 0) return;
    char* const name = CVodeGetReturnFlagName(flag);
    std::string what = std::string("CVODE returned ") + name;
    std::free(name);
    detail::throw_failure(ode_, t_, std::move(what), find_worst());
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
    BOUGH_DEMAND(CVodeGetDky(cvode_, t, 0, interpolated_) == CV_SUCCESS);
    y = interpolated_.values();
    if (ode_.has_projection() && ode_.project(t, y.data()) != 0) {
      ode_.throw_pending();
      throw StepFailure{StepFailure::Kind::NonFinite, t_, "the projection is not finite", t};
    }
  }
  void set_last_tolerances(int count, double tolerance) override { ode_.absolute.tail(count).setConstant(tolerance); }
  StepStatistics statistics() const override {
    StepStatistics s = before_;
    if (!cvode_) return s;
    long steps = 0, rejected = 0, failed = 0;
    CVodeGetNumSteps(cvode_, &steps);
    CVodeGetNumErrTestFails(cvode_, &rejected);
    CVodeGetNumNonlinSolvConvFails(cvode_, &failed);
    CVodeGetLastOrder(cvode_, &s.order);
    CVodeGetLastStep(cvode_, &s.step);
    s.num_steps += steps;
    s.num_rejected += rejected + failed;
    s.num_evaluations = ode_.num_evaluations();
    return s;
  }

 private:
  // The state whose estimated error is most in its tolerance.
  int find_worst() {
    detail::Vector weights(ode_.size(), context_);
    if (CVodeGetEstLocalErrors(cvode_, interpolated_) != CV_SUCCESS) return -1;
    if (CVodeGetErrWeights(cvode_, weights) != CV_SUCCESS) return -1;
    int row = -1;
    const VectorXd error = interpolated_.values().cwiseProduct(weights.values()).cwiseAbs();
    if (error.size() == 0 || !error.allFinite() || error.maxCoeff(&row) <= 0) return -1;
    return row;
  }

  void create(double t) {
    cvode_ = CVodeCreate(stiff_ ? CV_BDF : CV_ADAMS, context_);
    BOUGH_DEMAND(cvode_ != nullptr);
    const auto check = [](int flag) { BOUGH_DEMAND(flag == 0); };
    check(CVodeInit(cvode_, detail::call_ode, t, y_));
    check(CVodeSetUserData(cvode_, static_cast<GuardedOde*>(&ode_)));
    check(detail::silence_messages(cvode_));
    check(CVodeWFtolerances(cvode_, weigh));
    check(CVodeSetMaxErrTestFails(cvode_, detail::kMaxRejections));
    if (options_.step > 0) check(CVodeSetMaxStep(cvode_, options_.step));
    if (stiff_) {
      matrix_ = SUNDenseMatrix(ode_.size(), ode_.size(), context_);
      linear_ = SUNLinSol_Dense(y_, matrix_, context_);
      check(CVodeSetLinearSolver(cvode_, linear_, matrix_));
      if (ode_.has_projection()) {
        check(CVodeSetProjFn(cvode_, call_correction));
        check(CVodeSetProjErrEst(cvode_, SUNFALSE));
      }
    } else {
      nonlinear_ = SUNNonlinSol_FixedPoint(y_, 0, context_);
      check(CVodeSetNonlinearSolver(cvode_, nonlinear_));
    }
  }

  detail::Context context_;
  WeighedOde ode_;
  detail::Vector y_, interpolated_;
  StepperOptions options_;
  bool stiff_;
  void* cvode_ = nullptr;
  SUNNonlinearSolver nonlinear_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  double t_ = 0, last_ = 0, t_stop_ = 0;
  bool trembles_ = false;
  StepStatistics before_;
};

}  // namespace

std::unique_ptr<Integrator> make_cvode_stepper(Ode& ode, const StepperOptions& options, bool stiff) {
  return std::make_unique<CvodeStepper>(ode, options, stiff);
}

}  // namespace bough::solver
