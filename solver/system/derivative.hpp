#pragma once
/// \file From a state to its derivative: the one sequence for runs, linear models and checks.
#include "solver/system/system.hpp"

namespace bough::solver {

/// u̇ at (t, q, u, z) under the modes and the memory of `data`. `push()` adds loads or inertia to `data` after all
/// forces and before the factor. Allocates nothing itself.
///
/// \param q, u, z  num_q, num_u, num_z
template <class NodeActuator>
void calc_motion(const System& system, SystemData& data, double t, const Eigen::Ref<const VectorXd>& q,
                 const Eigen::Ref<const VectorXd>& u, const Eigen::Ref<const VectorXd>& z, Eigen::Ref<VectorXd> u_dot,
                 NodeActuator&& push) {
  set_z(data, z);                          // masses of tanks
  calc_kinematics(system, data, t, q, u);  // markers, R_PB, r, X, H, Jc, M(η); V = X V_P + H u - Jc η̇,   b, h
  add_forces(system, data, t);             // signals, actuators, applied, springs, dampers, gravity
  push();
  // 𝒫 = M + Σ Xᵀ𝒫⁺X, tip to base; [u̇; η̈] = L⁻ᵀ(z - G X A'_P), base to tip; (G M⁻¹ Gᵀ) λ = γ - G u̇,  u̇ += M⁻¹ Gᵀ λ
  calc_accelerations(system, data, t, u_dot);
}

/// ẋ of x = [q; u; z; work; dissipated] (StateLayout). No allocation.
void calc_derivative(const System& system, SystemData& data, double t, const Eigen::Ref<const VectorXd>& x,
                     Eigen::Ref<VectorXd> x_dot);

}  // namespace bough::solver
