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
  virtual int size() const = 0;
  /// y, y_dot: size(). May throw; may leave values that are not finite where y has left its domain.
  virtual void calc_derivative(double t, const Eigen::Ref<const VectorXd>& y, Eigen::Ref<VectorXd> y_dot) = 0;
  /// Returns true if each accepted step, and each interpolated state, must be projected.
  virtual bool has_projection() const { return false; }
  /// Brings y onto what the equations keep at zero. May throw.
  virtual void project(double, Eigen::Ref<VectorXd>) {}
  /// Takes off a small difference of states what the last projection would take off it. May throw.
  virtual void project_error(Eigen::Ref<VectorXd>) {}
  /// One stage of a linearly implicit step, with a matrix A of its own choice in place of ∂f/∂y: solves
  /// (1 - γh A) k = f(t, y), or after that one, for the second stage, (1 - γh A) x = f(t, y) - 2γh A k.
  virtual void calc_stage(double /*t*/, const Eigen::Ref<const VectorXd>& /*y*/, double /*gamma_h*/, bool /*is_first*/,
                          Eigen::Ref<VectorXd> /*k*/);
};

/// The system as integrators call it. Times are clamped to the last moment before the next jump of a function of time,
/// so that a step that ends at the jump uses the values before it.
class GuardedOde {
 public:
  explicit GuardedOde(Ode& ode) : ode_(ode) {}

  int size() const { return ode_.size(); }
  void set_latest(double left) { latest_ = left; }
  /// 0: fine; 1: the derivative is not finite or the equations threw (kept for throw_pending).
  int calc(double t, const double* y, double* y_dot) noexcept;
  bool has_projection() const { return ode_.has_projection(); }
  /// y, in and out. 0: fine; 1: it threw or is not finite.
  int project(double t, double* y) noexcept;
  int project_error(double* error) noexcept;
  int calc_stage(double t, const double* y, double gamma_h, bool is_first, double* k) noexcept;
  void begin_step() {
    pending_ = nullptr;
    non_finite_ = false;
  }
  /// Rethrows what the equations threw in their last evaluation, if anything: what a trial step threw before one that
  /// could be evaluated is no cause of anything.
  void throw_pending() {
    if (pending_) std::rethrow_exception(std::exchange(pending_, nullptr));
  }
  /// Since begin_step, last at bad_time().
  bool was_non_finite() const { return non_finite_; }
  double bad_time() const { return bad_time_; }
  long num_evaluations() const { return num_evaluations_; }

 private:
  template <class Action>
  int guard(double t, double* result, const Action& action) noexcept;

  Ode& ode_;
  double latest_ = std::numeric_limits<double>::infinity();
  std::exception_ptr pending_;
  bool non_finite_ = false;
  double bad_time_ = 0;
  long num_evaluations_ = 0;
};

}  // namespace bough::solver
