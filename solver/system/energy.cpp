// Energies, power and momenta of the whole system, from M(η) of each body (docs/theory/multibody.md).
#include "solver/forces/hinge_law.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {

namespace {

// ∂T/∂[v; ω] (momentum about Bo, in B) and the kinetic energy of one body.
struct BodyMomentum {
  Vector6d p;
  double kinetic = 0;
};

BodyMomentum calc_own_momentum(const TreeBody& tb, const BodyData& d, const TreeData& data) {
  const int n = tb.body.num_modes();
  Vector6d V;
  V << d.state.v_B, d.state.w_B;
  BodyMomentum m;
  if (n == 0) {
    m.p = d.inertia.M6 * V;
    m.kinetic = 0.5 * V.dot(m.p);
    return m;
  }
  const auto eta_dot = data.u.segment(tb.eta_dot_offset(), n);
  const BodyInertia& x = d.inertia;
  const Vector6d moved = x.M_top * eta_dot;
  m.p = x.M6 * V + moved;
  m.kinetic = 0.5 * V.dot(m.p) + 0.5 * V.dot(moved);
  for (int j = 0; j < n; ++j) {
    const auto below = x.M_modal.col(j).segment(j + 1, n - 1 - j);
    m.kinetic += eta_dot[j] * (0.5 * x.M_modal(j, j) * eta_dot[j] + below.dot(eta_dot.tail(n - 1 - j)));
  }
  return m;
}

// d/dt of kinetic and potential energy by the mass that leaves, at fixed positions and rates.
double calc_outflow_power(const System& system, const SystemData& data) {
  double power = 0;
  for (size_t i = 0; i < system.tree.tanks.size(); ++i) {
    const int b = system.tree.tanks[i].body;
    const TankData& tank = data.tree.tanks[i];
    if (tank.flow == 0) continue;
    const BodyState& s = data.tree[b].state;
    const TankContent& c = tank.content;
    const double kinetic = 0.5 * s.v_B.squaredNorm() + s.v_B.dot(s.w_B.cross(c.S_m)) + 0.5 * s.w_B.dot(c.J_m * s.w_B);
    double potential = -system.gravity.uniform.dot(s.p_WBo + s.R_WB * c.S_m);
    for (const CentralGravity* source : system.gravity.central)
      if (source->attracts(b)) potential += source->calc_potential_rate(data.tree[b], c);
    power -= tank.flow * (kinetic + potential);
  }
  return power;
}

}  // namespace

Energies calc_energies(const System& system, const SystemData& data) {
  const Tree& tree = system.tree;
  data.tree.demand(Stage::Velocity);
  Energies e;
  for (int b = 0; b < tree.size(); ++b) {
    const TreeBody& tb = tree[b];
    const BodyData& d = data.tree[b];
    e.kinetic += calc_own_momentum(tb, d, data.tree).kinetic;
    e.strain += calc_strain_energy(system, data, b);
    for (int i = 0; i < tb.rotor.size(); ++i)
      e.kinetic += 0.5 * tb.rotor[i] * data.tree.u[tb.u_offset + i] * data.tree.u[tb.u_offset + i];
    double force[6];
    if (tb.stiffness.size() > 0)
      e.strain +=
          tb.hinge->calc_spring(data.tree.q.data() + tb.q_offset, tb.null_position.data(), tb.stiffness.data(), force);
    e.potential -= system.gravity.uniform.dot(d.inertia.mass * d.state.p_WBo + d.state.R_WB * d.inertia.S);
  }
  for (const auto& element : system.elements) {
    const ForceResult result = element->calc(tree, data.tree, nullptr);
    e.strain += result.strain;
    e.potential += result.potential;
  }
  e.kinetic += system.signals.calc_energy(get_motion(system, data), data.signals);
  return e;
}

double calc_strain_energy(const System& system, const SystemData& data, int body) {
  const TreeBody& tb = system.tree[body];
  const auto eta = data.tree.q.segment(tb.eta_offset(), tb.num_modes());
  return tb.body.calc_strain_energy(eta);
}

Power calc_powers(const System& system, const SystemData& data) {
  const Tree& tree = system.tree;
  data.tree.demand(Stage::Acceleration);
  const VectorXd &u = data.tree.u, &applied = data.tree.applied;
  double power = 0, dissipated = 0;
  for (int b = 0; b < tree.size(); ++b) {
    const TreeBody& tb = tree[b];
    const BodyState& state = data.tree[b].state;
    power += applied.segment<3>(tb.v_offset).dot(state.v_B) + applied.segment<3>(tb.v_offset + 3).dot(state.w_B);
    for (int j = 0; j < tb.num_modes(); ++j) {
      const auto eta_dot = u.segment(tb.eta_dot_offset(), tb.num_modes());
      power += eta_dot[j] * applied[tb.v_offset + 6 + j];
      dissipated += eta_dot[j] * tb.body.D().col(j).dot(eta_dot);
    }
    if (tb.motion.empty() && tb.damping.size() == 0) continue;
    // A prescribed motion does the work that strains the springs along it.
    double spring[6] = {};
    if (!tb.motion.empty() && tb.stiffness.size() > 0)
      tb.hinge->calc_spring(data.tree.q.data() + tb.q_offset, tb.null_position.data(), tb.stiffness.data(), spring);
    for (int i = 0; i < tb.num_hinge_u(); ++i) {
      const int row = tb.u_offset + i;
      if (data.tree.mode[static_cast<size_t>(row)] == HingeMode::Prescribed)
        power += (data.tree.transmitted[row] - spring[i]) * u[row];
      else if (tb.damping.size() > 0)
        dissipated += tb.damping[i] * u[row] * u[row];
    }
  }
  // Elements along hinges are not in `applied`.
  double lost = dissipated;
  for (size_t i = 0; i < data.elements.size(); ++i) {
    const ForceResult& result = data.elements[i];
    dissipated += result.dissipated;
    if (!system.elements[i]->is_along_hinge()) {
      power -= result.power;
      continue;
    }
    lost += result.dissipated;
    if (static_cast<const HingeLaw&>(*system.elements[i]).is_prescribed(data.tree)) power -= result.power;
  }
  if (!system.load_frictions.empty()) {
    const double by_load = -data.tree.load_friction.dot(u);
    dissipated += by_load;
    lost += by_load;
  }
  power += system.signals.calc_power(get_motion(system, data), data.signals);
  power += calc_outflow_power(system, data);
  return {power - lost, dissipated};
}

void calc_body_momentum(const System& system, const SystemData& data, int body, Vector3d& linear, Vector3d& angular) {
  data.tree.demand(Stage::Velocity);
  const BodyData& d = data.tree[body];
  const BodyMomentum m = calc_own_momentum(system.tree[body], d, data.tree);
  linear = d.state.R_WB * m.p.head<3>();
  angular = d.state.R_WB * m.p.tail<3>() + d.state.p_WBo.cross(linear);
}

void calc_momentum(const System& system, const SystemData& data, Vector3d& linear, Vector3d& angular) {
  linear.setZero();
  angular.setZero();
  for (int b = 0; b < system.num_bodies(); ++b) {
    Vector3d p, l;
    calc_body_momentum(system, data, b, p, l);
    linear += p;
    angular += l;
  }
  angular += system.signals.calc_momentum(get_motion(system, data), data.signals);
}

SystemMass calc_system_mass(const System& system, const SystemData& data) {
  const Tree& tree = system.tree;
  data.tree.demand(Stage::Position);
  SystemMass total;
  Vector3d moment = Vector3d::Zero();
  for (int b = 0; b < tree.size(); ++b) {
    total.mass += data.tree[b].inertia.mass;
    moment += data.tree[b].inertia.mass * data.tree[b].state.p_WBo + data.tree[b].state.R_WB * data.tree[b].inertia.S;
  }
  if (!(total.mass > 0)) return total;
  total.cg_W = moment / total.mass;
  for (int b = 0; b < tree.size(); ++b) {
    const BodyData& d = data.tree[b];
    const Matrix3d J = d.inertia.M6.bottomRightCorner<3, 3>();
    // ∫ρ -(r + x)~(r + x)~ with r from cg to Bo, x from Bo.
    const Matrix3d r = skew(Vector3d(d.state.p_WBo - total.cg_W)), S = skew(Vector3d(d.state.R_WB * d.inertia.S));
    total.inertia_W += d.state.R_WB * J * d.state.R_WB.transpose() - r * S - S * r - d.inertia.mass * r * r;
  }
  return total;
}

}  // namespace bough::solver
