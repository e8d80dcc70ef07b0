// ROS2 of Verwer, Spee, Blom and Hundsdorfer (SIAM J. Sci. Comput. 20 (1999) 1456): of order 2 whatever matrix A stands
// for the Jacobian, and L-stable where A is it, with γ = 1 - 1/√2:
//   (1 - γhA) k = f(t, y),   (1 - γhA) x = f(t + h, y + hk) - 2γhA k,   y⁺ = y + h/2 (k + x)
// (x is the paper's k2 + 2 k1.) A is what stiffens each body by itself: see HybridSystem::calc_stage. The rows
// of closed constraints are in both linear systems, so that A is projected onto them.
#include <cmath>

#include "solver/integrate/fixed_step.hpp"

namespace bough::solver {
namespace {

class Implicit final : public FixedStepIntegrator {
 public:
  Implicit(Ode& ode, const StepperOptions& options) : FixedStepIntegrator(ode, options, 2) {
    for (VectorXd* v : {&stage_, &k_, &x_}) v->setZero(ode.size());
  }

 private:
  void calc_step(double t, double h, double t_end, VectorXd& y) override {
    static const double gamma = 1 - std::sqrt(0.5);
    check(ode_.calc_stage(t, y.data(), gamma * h, true, k_.data()));
    stage_ = y + h * k_;
    check(ode_.calc_stage(t_end, stage_.data(), gamma * h, false, x_.data()));
    y += (h / 2) * (k_ + x_);
    if (ode_.has_projection()) check(ode_.project(t_end, y.data()));
  }

  VectorXd stage_, k_, x_;
};

}  // namespace

std::unique_ptr<Integrator> make_implicit_stepper(Ode& ode, const StepperOptions& options) {
  return std::make_unique<Implicit>(ode, options);
}

}  // namespace bough::solver
