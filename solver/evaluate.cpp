// The equations of motion, read aloud (docs/theory/multibody.md): from where the bodies are to how they accelerate.
#include "solver/system/system.hpp"

namespace bough::solver {

void evaluate(const System& system, const State& state, SystemData& data, Eigen::Ref<VectorXd> q_dot,
              Eigen::Ref<VectorXd> u_dot) {
  const Tree& tree = system.tree;
  const Loops& loops = system.loops;
  if (!state.discrete.mode.empty() && !has_modes(data, state.discrete)) set_modes(system, data, state.discrete);
  if (state.discrete.memory.size() > 0) data.signals.memory = state.discrete.memory;
  set_z(data, state.z);
  calc_position(tree, state.t, state.q, data.tree);  // markers, R_PB, r, X, H, Jc, M(η)
  calc_velocity(tree, state.u, data.tree);           // V = X V_P + H u - Jc η̇,   b, h
  add_forces(system, data, state.t);                 // signals, actuators, applied, springs, dampers, gravity
  calc_factor(tree, data.tree);   // 𝒫 = M + Σ Xᵀ𝒫⁺X,  ℋᵀ𝒫ℋ = LLᵀ      tip to base
  solve(tree, data.tree, u_dot);  // β, then [u̇; η̈] = L⁻ᵀ(z - G X A'_P)    base to tip
  close_loops(loops, tree, data.tree, data.loops, u_dot);  // (G M⁻¹ Gᵀ) λ = γ - G u̇,  u̇ += M⁻¹ Gᵀ λ
  get_q_dot(system, data, q_dot);                          // q̇ = N(q) u
}

}  // namespace bough::solver
