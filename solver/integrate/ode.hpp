#pragma once
/// \file An ordinary differential equation ẏ = f(t, y) and a guard that keeps exceptions out of C frames.
#include <exception>
#include <limits>
#include <utility>

#include <Eigen/Dense>

namespace bough::solver {

using Eigen::VectorXd;

class Ode {
 public:
  virtual ~Ode() = default;
  /// Number of rows of y.
  virtual int size() const = 0;
  /// y, y_dot: size(). May throw; may leave values that are not finite where y has left its domain.
  virtual void calc_derivative(double t, const Eigen::Ref<const VectorXd>& y, Eigen::Ref<VectorXd> y_dot) = 0;
  /// Returns true if each accepted step, and each interpolated state, must be projected.
  virtual bool has_projection() const { return false; }
  /// Brings y onto what the equations keep at zero. May throw.
  virtual void project(double, Eigen::Ref<VectorXd>) {}
  /// Projects a small difference of states as the last projection would. May throw.
  virtual void project_error(Eigen::Ref<VectorXd>) {}
  /// One stage of a linearly implicit step, with a matrix A of the class's choice in place of ∂f/∂y: solves
  /// (1 - γh A) k = f(t, y), or after that one, for the second stage, (1 - γh A) x = f(t, y) - 2γh A k.
  virtual void calc_stage(double /*t*/, const Eigen::Ref<const VectorXd>& /*y*/, double /*gamma_h*/, bool /*is_first*/,
                          Eigen::Ref<VectorXd> /*k*/);
};

/// The system as integrators call it. Times are clamped to the last moment before the next jump of a function of time,
/// so that a step that ends at the jump uses the values before it.
class GuardedOde {
 public:
  explicit GuardedOde(Ode& ode) : ode_(ode) {}

  /// Number of rows of y.
  int size() const { return ode_.size(); }
  /// Sets the last moment before the next jump; later times are evaluated there.
  void set_left_limit(double left) { left_limit_ = left; }
  /// 0: fine; 1: the derivative is not finite or the equations threw (kept for throw_pending).
  int calc(double t, const double* y, double* y_dot) noexcept;
  /// Returns true if each accepted step must be projected.
  bool has_projection() const { return ode_.has_projection(); }
  /// y, in and out. 0: fine; 1: it threw or is not finite.
  int project(double t, double* y) noexcept;
  /// Projects an error estimate onto the constraints, in place. 0: fine; 1: it threw or is not finite.
  int project_error(double* error) noexcept;
  /// k of a stage of an implicit method (Ode::calc_stage). 0: fine; 1: it threw or is not finite.
  int calc_stage(double t, const double* y, double gamma_h, bool is_first, double* k) noexcept;
  /// Forgets exceptions and non-finite derivatives of earlier steps.
  void begin_step() {
    pending_ = nullptr;
    non_finite_ = false;
  }
  /// Rethrows the exception of the last evaluation, if it threw. Exceptions of earlier trial steps are dropped.
  void throw_pending() {
    if (pending_) std::rethrow_exception(std::exchange(pending_, nullptr));
  }
  /// Returns true if a derivative since begin_step was not finite; the last of them at bad_time().
  bool was_non_finite() const { return non_finite_; }
  /// Time of the last derivative that was not finite.
  double bad_time() const { return bad_time_; }
  /// Number of evaluations so far.
  long num_evaluations() const { return num_evaluations_; }

 private:
  template <class Action>
  int guard(double t, double* result, const Action& action) noexcept;
  template <class Action>
  int evaluate(double t, double* result, const Action& action) noexcept;

  Ode& ode_;
  double left_limit_ = std::numeric_limits<double>::infinity();
  std::exception_ptr pending_;
  bool non_finite_ = false;
  double bad_time_ = 0;
  long num_evaluations_ = 0;
};

}  // namespace bough::solver
