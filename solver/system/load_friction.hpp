#pragma once
/// \file Friction by bearing load: reactions depend on accelerations, these on friction, and friction on reactions.
#include <vector>

#include "solver/forces/load_friction.hpp"
#include "solver/loops/loops.hpp"

namespace bough::solver {

struct System;
struct SystemData;

/// Results and scratch of n frictions, m of them sliding.
struct LoadFrictionData {
  bool is_frozen = false;                ///< loads stay: accelerations of an implicit stage are none of the system
  VectorXd load;                         ///< n: bearing load L of the last evaluation
  VectorXd coefficient;                  ///< n: signed, zero where nothing slides
  VectorXd residual, step;               ///< n
  std::vector<Vector3d> axis;            ///< n
  std::vector<HingeReaction> reactions;  ///< n: without friction
  MatrixXd response;                     ///< 6n x n: reactions by a unit load of each sliding coordinate
  MatrixXd slope, matrix;                ///< n x n: ∂L_i/∂L_j; 1 - s ∂L_i/∂L_j
  Eigen::PartialPivLU<MatrixXd> factor;
};

/// Storage for n frictions. Allocates.
LoadFrictionData make_load_friction_data(std::size_t n);

/// Subtracts from TreeData::hinge_force what add_load_friction() added.
inline void remove_load_friction(TreeData& data) {
  data.hinge_force -= data.load_friction;
  data.load_friction.setZero();
}

/// Sets friction along the sliding coordinates to the loads in `data.friction`, in place of what was there.
void apply_load_friction(const System& system, SystemData& data, const VectorXd& load);

/// Solves L = L(reactions(L)) at the state of the last accelerations, and leaves accelerations, reactions and
/// TreeData::hinge_force with friction μ L along each sliding coordinate.
///
/// Reactions are affine in the loads: n responses of the factored tree, then Newton's method on n numbers, checked and
/// corrected by the accelerations themselves. No allocation.
///
/// \pre  the tree was solved, and loops closed, after remove_load_friction()
/// \throws ComputationError "solver.friction-jams" if the loads grow by as much as the friction that they make
///     (1 - s ∂L/∂L singular for an s in 0 .. 1), or Newton's method does not converge
void add_load_friction(const System& system, SystemData& data, Eigen::Ref<VectorXd> u_dot);

}  // namespace bough::solver
