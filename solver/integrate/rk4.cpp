#include "base/diagnostic.hpp"
#include "solver/integrate/fixed_step.hpp"

namespace bough::solver {
namespace {

class Rk4 final : public FixedStepIntegrator {
 public:
  Rk4(Ode& ode, const StepperOptions& options) : FixedStepIntegrator(ode, options, 4) {
    for (VectorXd* v : {&stage_, &k1_, &k2_, &k3_, &k4_}) v->setZero(ode.size());
  }

 private:
  void calc_step(double t, double h, double t_end, VectorXd& y) override {
    calc(t, y, k1_);
    stage_ = y + (h / 2) * k1_;
    calc(t + h / 2, stage_, k2_);
    stage_ = y + (h / 2) * k2_;
    calc(t + h / 2, stage_, k3_);
    stage_ = y + h * k3_;
    calc(t_end, stage_, k4_);
    y += (h / 6) * (k1_ + 2 * k2_ + 2 * k3_ + k4_);
    if (ode_.has_projection()) check(ode_.project(t_end, y.data()));
  }
  void calc(double t, const VectorXd& y, VectorXd& y_dot) { check(ode_.calc(t, y.data(), y_dot.data())); }

  VectorXd stage_, k1_, k2_, k3_, k4_;
};

}  // namespace

std::unique_ptr<Integrator> make_rk4_stepper(Ode& ode, const StepperOptions& options) {
  return std::make_unique<Rk4>(ode, options);
}

std::unique_ptr<Integrator> make_integrator(const std::string& integrator, Ode& ode, const StepperOptions& options) {
  if (integrator == "adams" || integrator == "bdf") return make_cvode_stepper(ode, options, integrator == "bdf");
  if (integrator == "rk") return make_erk_stepper(ode, options);
  if (integrator == "radau") return make_radau_stepper(ode, options);
  if (integrator == "implicit") return make_implicit_stepper(ode, options);
  BOUGH_DEMAND(integrator == "rk4");
  return make_rk4_stepper(ode, options);
}

}  // namespace bough::solver
