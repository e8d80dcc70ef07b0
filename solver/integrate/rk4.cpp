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
    for (VectorXd* v : {&y_, &last_y_, &between_, &stage_, &k1_, &k2_, &k3_, &k4_}) v->setZero(ode.size());
  }

  void restart(double t, const Eigen::Ref<const VectorXd>& y, double t_stop, double latest) override {
    t_ = last_ = target_ = t;
    y_ = y;
    set_stop(t_stop, latest);
  }
  void set_stop(double, double latest) override { ode_.set_latest(latest); }

  void step(double t_target) override {
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

  double time() const override { return t_; }
  double last_time() const override { return last_; }
  Eigen::Map<const VectorXd> state() const override { return {y_.data(), y_.size()}; }
  void calc_state(double t, Eigen::Ref<VectorXd> y) override {
    if (t == t_) {
      y = y_;
      return;
    }
    BOUGH_DEMAND(t >= last_ && t < t_);
    between_ = last_y_;
    calc_step(last_, t - last_, t, between_);
    y = between_;
  }
  Eigen::Vector4d memory() const override {
    return {from_, target_, static_cast<double>(count_), static_cast<double>(done_)};
  }
  void set_memory(const Eigen::Vector4d& memory) override {
    from_ = memory[0];
    target_ = memory[1];
    count_ = static_cast<long>(memory[2]);
    done_ = static_cast<long>(memory[3]);
    if (done_ >= count_) target_ = t_;  // it stood at the end of its interval
  }
  StepStatistics statistics() const override {
    StepStatistics s = statistics_;
    s.order = 4;
    s.num_evaluations = ode_.num_evaluations();
    return s;
  }

 private:
  /// y from t to t_end = t + h.
  void calc_step(double t, double h, double t_end, VectorXd& y) {
    calc(t, y, k1_);
    stage_ = y + (h / 2) * k1_;
    calc(t + h / 2, stage_, k2_);
    stage_ = y + (h / 2) * k2_;
    calc(t + h / 2, stage_, k3_);
    stage_ = y + h * k3_;
    calc(t_end, stage_, k4_);
    y += (h / 6) * (k1_ + 2 * k2_ + 2 * k3_ + k4_);
    if (ode_.has_projection() && ode_.project(t_end, y.data()) != 0) fail();
  }

  void calc(double t, const VectorXd& y, VectorXd& y_dot) {
    if (ode_.calc(t, y.data(), y_dot.data()) != 0) fail();
  }

  [[noreturn]] void fail() {
    ode_.throw_pending();
    throw StepFailure{StepFailure::Kind::NonFinite, t_, "the derivative is not finite", ode_.bad_time()};
  }

  GuardedOde ode_;
  double h_max_;
  double t_ = 0, last_ = 0, from_ = 0, target_ = 0;
  long count_ = 1, done_ = 0;
  VectorXd y_, last_y_, between_, stage_, k1_, k2_, k3_, k4_;
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
