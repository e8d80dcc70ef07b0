#pragma once
/// \file Norm of the local error, first step, end states and failures of steps.
#include <string>

#include "solver/integrate/integrator.hpp"

namespace bough::solver::detail {

/// Weight of row i of y in the norm of the error: relative_tolerance |y_i| + absolute_tolerance_i, at least 1e-300.
double calc_error_weight(const StepperOptions& options, const VectorXd& y, Eigen::Index i);

/// Root mean square of v_i over the weights at y, in tolerances. v: size of y.
double calc_error_norm(const StepperOptions& options, const VectorXd& y, const VectorXd& v);

/// Length [T] of the first step of a method of order q, by the size of the first and second derivatives.
/// Source: Hairer, Nørsett and Wanner, "Solving Ordinary Differential Equations I", II.4.
/// \param y_dot  derivative at (t, y).
/// \param min_step, max_step  [T] bounds of the result.
/// \param[out] stage, stage_dot  scratch, of the size of y.
/// \note One evaluation.
double guess_first_step(GuardedOde& ode, const StepperOptions& options, int order, double t, const VectorXd& y,
                        const Eigen::Ref<const VectorXd>& y_dot, double min_step, double max_step, VectorXd& stage,
                        VectorXd& stage_dot);

/// Ends of the last step of a method, times [T] and states.
struct LastStep {
  double from;
  const VectorXd& y_from;
  double to;
  const VectorXd& y_to;
};
/// Copies the state at an end of the last step to y. \return false between the ends, where y is untouched.
/// \pre from <= t <= to.
bool copy_end_state(double t, const LastStep& step, Eigen::Ref<VectorXd> y);

/// Smallest step [T] before a stop that is `left` away: a share of the way, or of the largest step. Without a bound
/// methods creep up to a singularity in steps that no longer change t.
double calc_smallest_step(const StepperOptions& options, double left);

/// "steps of 1e-09 err by 3.2 tolerances", for a StepFailure.
std::string describe_rejection(double step, double error);

/// Throws the pending exception of the equations after a failed step, or else a StepFailure.
/// \param t    [T] start of the step.
/// \param row  StepFailure::row.
[[noreturn]] void throw_failure(GuardedOde& ode, double t, std::string detail, int row);

}  // namespace bough::solver::detail
