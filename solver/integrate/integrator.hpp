#pragma once
/// \file Steppers: one interface over the integrators of [simulation] (docs/theory/integrators.md).
#include <memory>
#include <string>

#include "solver/integrate/ode.hpp"

namespace bough::solver {

struct StepperOptions {
  double relative_tolerance = 1e-8;
  VectorXd absolute_tolerance;  ///< size(); ignored by rk4 and implicit
  double step = 0;              ///< rk4, implicit: the step; others: the largest step when > 0
  int rk_order = 8;             ///< of the adaptive Runge-Kutta pair: 5 or 8
};

struct StepStatistics {
  double step = 0;  ///< the last one
  int order = 0;    ///< of the last one
  long num_steps = 0, num_rejected = 0, num_evaluations = 0;
};

/// A step could not be taken.
struct StepFailure {
  enum class Kind { NonFinite, Stalled };
  Kind kind = Kind::Stalled;
  double time = 0;
  std::string detail;
  double tried = 0;  ///< NonFinite: time of the evaluation
  int row = -1;      ///< Stalled: of the state that errs most in its tolerance; -1: not known
};

class Integrator {
 public:
  virtual ~Integrator() = default;
  /// Starts afresh from (t, y): the history is dropped. No step passes t_stop, and no derivative is asked for at a time
  /// past `latest` (<= t_stop). y: size().
  virtual void reset(double t, const Eigen::Ref<const VectorXd>& y, double t_stop, double left) = 0;
  /// Goes on with its history to a later t_stop.
  virtual void set_stop(double t_stop, double left) = 0;
  /// One step from time(). Multistep methods may pass t_target (not t_stop); the others end on it when it is in reach.
  /// Throws StepFailure, or what the equations threw; the state is then that before the step.
  virtual void step(double t_target) = 0;
  /// Time [T] of the state.
  virtual double time() const = 0;
  /// Where the last step began; time() before the first.
  virtual double last_time() const = 0;
  /// At time().
  virtual Eigen::Map<const VectorXd> state() const = 0;
  /// At t within the last step, as exactly as the method steps: by its interpolant, or (rk, rk4) by a step to t.
  virtual void calc_state(double t, Eigen::Ref<VectorXd> y) = 0;
  /// Steps, evaluations and failures since the start.
  virtual StepStatistics statistics() const = 0;
  /// Returns true if a step depends on those before it: a jump of anything but the state then needs a restart.
  virtual bool has_history() const { return true; }
  /// The absolute tolerance of the last `count` states from the next step on. Nothing if the step is fixed.
  virtual void set_last_tolerances(int /*count*/, double /*tolerance*/) {}
  /// Where in its own division of time it is, for a checkpoint; set after restart. Empty where steps depend on nothing
  /// but the history.
  virtual Eigen::Vector4d memory() const { return Eigen::Vector4d::Zero(); }
  virtual void set_memory(const Eigen::Vector4d&) {}
};

/// integrator: "adams", "bdf", "rk", "radau", "rk4", "implicit". BOUGH_DEMAND on another name. The Ode must outlive the
/// stepper.
std::unique_ptr<Integrator> make_integrator(const std::string& integrator, Ode& ode, const StepperOptions& options);

/// SUNDIALS CVODE: variable order and step; Adams-Moulton (to order 12) by fixed-point iteration, or BDF (to order 5)
/// by Newton with a dense difference-quotient Jacobian (Hindmarsh et al., ACM TOMS 31 (2005) 363).
std::unique_ptr<Integrator> make_cvode_stepper(Ode& ode, const StepperOptions& options, bool stiff);
/// Explicit embedded pair: Dormand and Prince's 5(4) or 8(7); the error is judged after the projection.
std::unique_ptr<Integrator> make_erk_stepper(Ode& ode, const StepperOptions& options);
/// Radau IIA of order 9, implicit, L-stable, of variable step: fast modes do not limit its steps once they have died
/// out. States within a step are of its collocation polynomial.
std::unique_ptr<Integrator> make_radau_stepper(Ode& ode, const StepperOptions& options);
/// The classical Runge-Kutta method of order 4, at fixed step (fixed_step.hpp).
std::unique_ptr<Integrator> make_rk4_stepper(Ode& ode, const StepperOptions& options);
/// Linearly implicit of order 2 (ROS2), at fixed step: what Ode::calc_stage takes for stiff does not limit the step.
std::unique_ptr<Integrator> make_implicit_stepper(Ode& ode, const StepperOptions& options);

}  // namespace bough::solver
