#pragma once
/// \file Base of the fixed-step methods. Each interval to the next target is divided into equal steps no longer than
/// options.step, so that results depend on the targets only, and with memory() not on where a run was interrupted.
#include "solver/integrate/integrator.hpp"

namespace bough::solver {

class FixedStepIntegrator : public Integrator {
 public:
  /// \param order  of the method. \pre options.step > 0. `ode` must outlive this. Allocates.
  FixedStepIntegrator(Ode& ode, const StepperOptions& options, int order);

  void reset(double t, const Eigen::Ref<const VectorXd>& y, double t_stop, double left) override;
  void set_stop(double, double left) override { ode_.set_left_limit(left); }
  void step(double t_target) override;
  double time() const override { return t_; }
  double last_time() const override { return last_; }
  Eigen::Map<const VectorXd> state() const override { return {y_.data(), y_.size()}; }
  void calc_state(double t, Eigen::Ref<VectorXd> y) override;
  Eigen::Vector4d memory() const override;
  void set_memory(const Eigen::Vector4d& memory) override;
  bool has_history() const override { return false; }
  StepStatistics statistics() const override;

 protected:
  /// y from t to t_end = t + h.
  virtual void calc_step(double t, double h, double t_end, VectorXd& y) = 0;
  /// If `flag` of an evaluation is not zero, rethrows its exception, or throws StepFailure.
  void check(int flag);

  GuardedOde ode_;

 private:
  double h_max_;
  int order_;
  double t_ = 0, last_ = 0, from_ = 0, target_ = 0;
  long count_ = 1, done_ = 0;
  VectorXd y_, last_y_, between_;
  StepStatistics statistics_;
};

}  // namespace bough::solver
