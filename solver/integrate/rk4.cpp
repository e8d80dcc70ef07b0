#include <algorithm>
#include <cmath>

#include "base/diagnostic.hpp"
#include "solver/integrate/stepper.hpp"

namespace bough::solver {
namespace {

class Rk4 final : public Stepper {
 public:
  Rk4(Ode& ode, const StepperOptions& options) : ode_(ode), h_max_(options.step) {
    BOUGH_DEMAND(options.step > 0);
    for (VectorXd* v : {&y_, &stage_, &k1_, &k2_, &k3_, &k4_}) v->setZero(ode.size());
  }

  void restart(double t, const Eigen::Ref<const VectorXd>& y, double, double latest) override {
    t_ = t;
    y_ = y;
    ode_.set_latest(latest);
    target_ = t;
  }

  void step(double t_target) override {
    if (t_target != target_) {
      from_ = t_;
      target_ = t_target;
      // A step that divides the interval up to rounding does so.
      count_ = std::max<long>(1, static_cast<long>(std::ceil((t_target - t_) / h_max_ * (1 - 1e-9))));
      done_ = 0;
    }
    const double h = (target_ - from_) / static_cast<double>(count_);
    ode_.clear();
    calc(t_, y_, k1_);
    stage_ = y_ + (h / 2) * k1_;
    calc(t_ + h / 2, stage_, k2_);
    stage_ = y_ + (h / 2) * k2_;
    calc(t_ + h / 2, stage_, k3_);
    stage_ = y_ + h * k3_;
    ++done_;
    const double t_next = done_ == count_ ? target_ : from_ + h * static_cast<double>(done_);
    calc(t_next, stage_, k4_);
    y_ += (h / 6) * (k1_ + 2 * k2_ + 2 * k3_ + k4_);
    t_ = t_next;
    statistics_.step = h;
    ++statistics_.num_steps;
  }

  double time() const override { return t_; }
  Eigen::Map<const VectorXd> state() const override { return {y_.data(), y_.size()}; }
  void calc_state(double t, Eigen::Ref<VectorXd> y) override {
    BOUGH_DEMAND(t == t_);
    y = y_;
  }
  StepStatistics statistics() const override {
    StepStatistics s = statistics_;
    s.order = 4;
    s.num_evaluations = ode_.num_evaluations();
    return s;
  }

 private:
  void calc(double t, const VectorXd& y, VectorXd& y_dot) {
    if (ode_.calc(t, y.data(), y_dot.data()) == 0) return;
    ode_.throw_pending();
    throw StepFailure{StepFailure::Kind::NonFinite, t_, "the derivative is not finite"};
  }

  GuardedOde ode_;
  double h_max_;
  double t_ = 0, from_ = 0, target_ = 0;
  long count_ = 1, done_ = 0;
  VectorXd y_, stage_, k1_, k2_, k3_, k4_;
  StepStatistics statistics_;
};

}  // namespace

std::unique_ptr<Stepper> make_rk4_stepper(Ode& ode, const StepperOptions& options) {
  return std::make_unique<Rk4>(ode, options);
}

std::unique_ptr<Stepper> make_stepper(const std::string& integrator, Ode& ode, const StepperOptions& options) {
  if (integrator == "adams" || integrator == "bdf") return make_cvode_stepper(ode, options, integrator == "bdf");
  if (integrator == "rk") return make_erk_stepper(ode, options);
  BOUGH_DEMAND(integrator == "rk4");
  return make_rk4_stepper(ode, options);
}

}  // namespace bough::solver
