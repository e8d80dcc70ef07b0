#pragma once
/// \file Motions of the supports over time, from displacements, velocities or accelerations at the steps.
#include "modal/response/excitation.hpp"
#include "modal/response/frequency_list.hpp"

namespace bough::modal::response {

/// Values at each step: just before it and just after.
struct Sides {
  MatrixXd before, after;  ///< rows x nt
};

struct SupportMotion {
  Sides d, d_dot, d_ddot;  ///< k x nt, rows as the columns of Excitation::D
};
/// TYPE ACCE is a line over each step; velocities and displacements are splines (sampled_curve.hpp). Before the first
/// step all is at rest: the motion of the supports then is a jump.
SupportMotion sample_support_motion(const Excitation& excitation, const TimeGrid& grid);

/// The forces p (m x nt) at the steps.
Sides sample_forces(const Excitation& excitation, const TimeGrid& grid);
/// The forces p (m) between two steps.
VectorXd sample_forces_within(const Excitation& excitation, double t);

/// Length of the step that ends at i, or that starts there; beyond the ends of the grid that next to it.
double calc_step_before(const TimeGrid& grid, Eigen::Index i);
double calc_step_after(const TimeGrid& grid, Eigen::Index i);

}  // namespace bough::modal::response
