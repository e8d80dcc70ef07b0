// Stages of a linearly implicit step (implicit.cpp) on the tree. With A = [0 N; -M⁻¹K -M⁻¹D] over [δ; u], δ in the
// tangent of q, q̇ = N δ̇, the stage (1 - γhA) [δ̇; u̇] = [r_δ; M⁻¹F] is
//   (M + γh D + γ²h² K) u̇ = F - γh K r_δ,   δ̇ = r_δ + γh u̇
// and the second one has r_δ = u - 2γh u̇₁ and F + 2γh (K δ̇₁ + D u̇₁).
#include "solver/simulate/hybrid_system.hpp"
#include "solver/system/derivative.hpp"

namespace bough::solver {

void HybridSystem::calc_tangent() {
  k_.setZero();
  c_.setZero();
  for (const TreeBody& tb : system_->tree.bodies) {
    k_.segment(tb.u_offset, tb.stiffness.size()) = tb.stiffness;
    c_.segment(tb.u_offset, tb.damping.size()) = tb.damping;
    if (tb.motion.empty()) continue;
    for (int row = tb.u_offset; row < tb.u_offset + tb.num_hinge_u(); ++row)
      if (data_->tree.mode[static_cast<size_t>(row)] == HingeMode::Prescribed) k_[row] = c_[row] = 0;
  }
  for (const auto& element : system_->elements) element->add_tangent(system_->tree, data_->tree, k_, c_);
}

void HybridSystem::add_stage_forces(double gh, bool is_first) {
  TreeData& d = data_->tree;
  delta_ = d.u;
  if (!is_first) delta_ -= 2 * gh * first_u_;
  for (const TreeBody& tb : system_->tree.bodies) {
    const int u = tb.u_offset, nh = tb.num_hinge_u(), eta = tb.eta_dot_offset(), n = tb.num_modes();
    auto hinge = extra_.segment(u, nh);
    hinge = -gh * k_.segment(u, nh).cwiseProduct(delta_.segment(u, nh));
    auto modal = extra_.segment(eta, n);
    modal.noalias() = -gh * (tb.body.K() * delta_.segment(eta, n));
    if (!is_first) {
      hinge += 2 * gh * k_.segment(u, nh).cwiseProduct(first_delta_.segment(u, nh));
      hinge += 2 * gh * c_.segment(u, nh).cwiseProduct(first_u_.segment(u, nh));
      modal.noalias() += 2 * gh * (tb.body.K() * first_delta_.segment(eta, n));
      modal.noalias() += 2 * gh * (tb.body.D() * first_u_.segment(eta, n));
    }
    d.hinge_force.segment(u, nh) += hinge;
    d.applied.segment(tb.v_offset + 6, n) += modal;
  }
}

void HybridSystem::calc_stage(double t, const Eigen::Ref<const VectorXd>& y, double gh, bool is_first,
                              Eigen::Ref<VectorXd> k) {
  const Tree& tree = system_->tree;
  TreeData& d = data_->tree;
  Power power;
  const bool has_friction = !system_->load_frictions.empty();
  const bool needs_derivative = has_motion_ || num_z_ > 0 || has_friction;
  if (needs_derivative) {  // what drives motions, ż and bearing loads follow from the true accelerations
    calc_derivative(t, y, k);
    power = calc_powers(*system_, *data_);
  }
  ++num_evaluations_;
  data_->friction.is_frozen = has_friction;
  const StateLayout layout = system_->layout();
  auto u_dot = get_u(layout, k);
  calc_motion(*system_, *data_, t, get_q(layout, y), get_u(layout, y), get_z(layout, y), u_dot, [&] {
    if (is_first) calc_tangent();
    add_stage_forces(gh, is_first);
    if (has_friction) apply_load_friction(*system_, *data_, data_->friction.load);
    d.added += gh * c_ + gh * gh * k_;
    d.added_D = gh;
    d.added_K = gh * gh;
  });
  data_->friction.is_frozen = false;
  for (const TreeBody& tb : tree.bodies)
    d.applied.segment(tb.v_offset + 6, tb.num_modes()) -= extra_.segment(tb.eta_dot_offset(), tb.num_modes());
  if (!needs_derivative) power = calc_powers(*system_, *data_);
  for (int row = 0; row < num_u_; ++row) {
    if (d.mode[static_cast<size_t>(row)] == HingeMode::Free)
      delta_[row] += gh * u_dot[row];
    else
      delta_[row] = d.u[row];
  }
  for (const TreeBody& tb : tree.bodies) {
    tb.hinge->calc_q_dot(d.q.data() + tb.q_offset, delta_.data() + tb.u_offset, k.data() + tb.q_offset);
    k.segment(tb.eta_offset(), tb.num_modes()) = delta_.segment(tb.eta_dot_offset(), tb.num_modes());
  }
  k[num_coordinates() + num_z_] = power.total;
  k[num_coordinates() + num_z_ + 1] = power.dissipated;
  if (is_first) {
    first_delta_ = delta_;
    first_u_ = u_dot;
  }
  clear_added(tree, d);
  d.done = 0;
}

}  // namespace bough::solver
