// Energies, power and momenta of the whole system, from M(η) of each body (docs/theory/multibody.md).
#include "solver/system/impl.hpp"

namespace bough::solver {

namespace {

// ∂T/∂[v; ω] (momentum about Bo, in B) and the kinetic energy of one body.
struct BodyMomentum {
  Vector6d p;
  double kinetic = 0;
};

BodyMomentum calc_body_momentum(const TreeBody& tb, const BodyData& d, const TreeData& data) {
  const int n = tb.body.num_modes();
  Vector6d V;
  V << d.state.v_B, d.state.w_B;
  BodyMomentum m;
  if (n == 0) {
    m.p = tb.body.M6() * V;
    m.kinetic = 0.5 * V.dot(m.p);
    return m;
  }
  const auto eta_dot = data.u.segment(tb.eta_dot_offset(), n);
  const MatrixXd& M = d.inertia.M;
  m.p = M.topLeftCorner<6, 6>() * V;
  for (int j = 0; j < n; ++j) m.p += M.block<6, 1>(0, 6 + j) * eta_dot[j];
  m.kinetic = 0.5 * V.dot(m.p);
  for (int j = 0; j < n; ++j) {
    m.kinetic += 0.5 * eta_dot[j] * (M.block<6, 1>(0, 6 + j).dot(V) + M.col(6 + j).tail(n).dot(eta_dot));
  }
  return m;
}

}  // namespace

Energies calc_energies(const System& system, const SystemData& data) {
  const Tree& tree = system.impl().tree;
  Energies e;
  for (size_t b = 0; b < tree.bodies.size(); ++b) {
    const TreeBody& tb = tree.bodies[b];
    const BodyData& d = data.tree.bodies[b];
    const int n = tb.body.num_modes();
    e.kinetic += calc_body_momentum(tb, d, data.tree).kinetic;
    const auto eta = data.tree.q.segment(tb.eta_offset(), n);
    for (int j = 0; j < n; ++j) e.strain += 0.5 * eta[j] * tb.body.K().col(j).dot(eta);
    e.strain += d.spring_energy;
    e.potential -= data.tree.gravity.dot(tb.body.mass() * d.state.p_WBo + d.state.R_WB * d.inertia.S);
  }
  return e;
}

Power calc_powers(const System& system, const SystemData& data) {
  const Tree& tree = system.impl().tree;
  double power = 0, dissipated = 0;
  for (size_t b = 0; b < tree.bodies.size(); ++b) {
    const TreeBody& tb = tree.bodies[b];
    const BodyData& d = data.tree.bodies[b];
    const int n = tb.body.num_modes();
    const auto eta_dot = data.tree.u.segment(tb.eta_dot_offset(), n);
    power += d.applied.head<3>().dot(d.state.v_B) + d.applied.segment<3>(3).dot(d.state.w_B);
    power += d.applied.tail(n).dot(eta_dot);
    for (int j = 0; j < n; ++j) dissipated += eta_dot[j] * tb.body.D().col(j).dot(eta_dot);
    const int nu = tb.hinge->num_u();
    if (tb.is_prescribed()) power += d.hinge_force.head(nu).dot(d.hinge_rate.head(nu));
    for (int i = 0; i < tb.damping.size(); ++i) dissipated += tb.damping[i] * d.hinge_rate[i] * d.hinge_rate[i];
  }
  return {power - dissipated, dissipated};
}

void calc_momentum(const System& system, const SystemData& data, Vector3d& linear, Vector3d& angular) {
  const Tree& tree = system.impl().tree;
  linear.setZero();
  angular.setZero();
  for (size_t b = 0; b < tree.bodies.size(); ++b) {
    const BodyData& d = data.tree.bodies[b];
    const BodyMomentum m = calc_body_momentum(tree.bodies[b], d, data.tree);
    const Vector3d p_W = d.state.R_WB * m.p.head<3>();
    linear += p_W;
    angular += d.state.R_WB * m.p.tail<3>() + d.state.p_WBo.cross(p_W);
  }
}

}  // namespace bough::solver
