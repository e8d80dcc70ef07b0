#include "solver/system/system.hpp"

#include <algorithm>
#include <sstream>

#include "solver/forces/flow.hpp"

namespace bough::solver {

namespace {
/// Round-off of a function of time that ends at zero, as a share of the initial mass.
constexpr double kTankNoise = 1e-9;

size_t as_index(int b) { return static_cast<size_t>(b); }
const TreeBody& at(const System& s, int b) { return s.tree.bodies[as_index(b)]; }
}  // namespace

int System::num_bodies() const { return static_cast<int>(tree.bodies.size()); }
int System::num_q() const { return tree.num_q; }
int System::num_u() const { return tree.num_u; }
int System::num_z() const { return signals.num_states + num_momentum_out(); }
int System::num_momentum_out() const { return tree.tanks.empty() && num_levels.empty() ? 0 : 6; }

int System::get_level(int k, int body) const {
  if (num_levels.empty()) return 0;
  for (int b = 0; b < body; ++b) k /= num_levels[as_index(b)];
  return k % num_levels[as_index(body)];
}

int System::find_variant(int k, int body, int level) const {
  int stride = 1;
  for (int b = 0; b < body; ++b) stride *= num_levels[as_index(b)];
  return k + stride * (level - get_level(k, body));
}

int System::find_body(const std::string& name) const {
  for (int b = 0; b < num_bodies(); ++b) {
    if (body_name(b) == name) return b;
  }
  return -1;
}

int System::find_hinge(const std::string& name) const {
  for (int b = 0; b < num_bodies(); ++b) {
    if (hinge_name(b) == name) return b;
  }
  return -1;
}

const std::string& System::body_name(int b) const { return at(*this, b).name; }
const std::string& System::hinge_name(int b) const { return at(*this, b).hinge_name; }
bool System::is_valid(int b) const { return body_is_valid[as_index(b)]; }
int System::num_modes(int b) const { return at(*this, b).body.num_modes(); }
int System::q_offset(int b) const { return at(*this, b).q_offset; }
int System::u_offset(int b) const { return at(*this, b).u_offset; }
int System::num_hinge_q(int b) const { return at(*this, b).num_hinge_q(); }
int System::num_hinge_u(int b) const { return at(*this, b).count(HingeMode::Free); }
int System::num_hinge_rates(int b) const { return at(*this, b).hinge->num_u(); }
int System::num_dofs() const {
  int num = 0;
  for (int b = 0; b < num_bodies(); ++b) num += num_hinge_u(b) + num_modes(b);
  return num;
}
int System::eta_offset(int b) const { return at(*this, b).eta_offset(); }
int System::eta_dot_offset(int b) const { return at(*this, b).eta_dot_offset(); }
int System::find_node(int b, int id) const { return at(*this, b).body.find_node(id); }
bool System::has_node_second_order(int b, int node) const {
  const Node& n = at(*this, b).body.nodes()[as_index(node)];
  return n.K2.size() > 0 || !n.higher.empty();
}

std::unique_ptr<SystemData> System::make_data() const {
  auto data = std::make_unique<SystemData>();
  data->tree = make_tree_data(tree);
  data->loops = make_loop_data(loops, tree);
  if (!initial_constraints.empty()) set_constraint_states(loops, tree, initial_constraints, data->loops);
  data->elements.resize(elements.size());
  data->friction = make_load_friction_data(load_frictions.size());
  data->tangent = VectorXd::Zero(tree.num_u);
  data->signals = signals.make_data();
  return data;
}

void System::calc_initial_state(Eigen::Ref<VectorXd> q, Eigen::Ref<VectorXd> u) const {
  BOUGH_DEMAND(q.size() == num_q() && u.size() == num_u());
  if (initial_q.size() > 0) {
    q = initial_q;
    u = initial_u;
    return;
  }
  for (const TreeBody& tb : tree.bodies) {
    const int n = tb.num_modes();
    q.segment(tb.q_offset, tb.num_hinge_q()) = tb.initial_q;
    u.segment(tb.u_offset, tb.num_hinge_u()) = tb.initial_u;
    q.segment(tb.eta_offset(), n) = tb.initial_eta;
    u.segment(tb.eta_dot_offset(), n) = tb.initial_eta_dot;
    for (int i = 0; i < tb.num_hinge_u(); ++i) {
      if (tb.mode[as_index(i)] == HingeMode::Locked) u[tb.u_offset + i] = 0;
      if (tb.mode[as_index(i)] != HingeMode::Prescribed) continue;
      const auto value = tb.motion[as_index(i)]->calc(start);
      q[tb.q_offset + i] = value.f;
      u[tb.u_offset + i] = value.f_dot;
    }
  }
}

State System::make_initial_state() const {
  State state;
  state.t = start;
  state.x = VectorXd::Zero(layout().size());
  calc_initial_state(get_q(layout(), state.x), get_u(layout(), state.x));
  const auto data = make_data();
  state.discrete = get_discrete(*data);
  get_z(layout(), state.x).head(signals.num_states) = data->signals.z;
  state.discrete.memory = data->signals.memory;
  return state;
}

void set_modes(const System& system, SystemData& data, const DiscreteState& discrete) {
  set_modes(system.tree, discrete.mode, data.tree);
  if (!discrete.constraints.empty()) set_constraint_states(system.loops, system.tree, discrete.constraints, data.loops);
  if (discrete.memory.size() > 0) data.signals.memory = discrete.memory;
  if (discrete.slide.size() > 0) data.tree.slide = discrete.slide;
}

bool has_modes(const SystemData& data, const DiscreteState& discrete) {
  const auto is_same = [](const ConstraintData& a, const ConstraintState& b) {
    return a.state.is_closed == b.is_closed && a.state.R == b.R && a.state.p == b.p && a.state.gap == b.gap;
  };
  return data.tree.mode == discrete.mode &&
         (discrete.constraints.empty() ||
          std::equal(data.loops.constraints.begin(), data.loops.constraints.end(), discrete.constraints.begin(),
                     discrete.constraints.end(), is_same));
}

DiscreteState get_discrete(const SystemData& data) {
  return {data.tree.mode, get_constraint_states(data.loops), data.signals.memory, -1, data.tree.slide};
}

void calc_q_dot(const System& system, SystemData& data, double t, const Eigen::Ref<const VectorXd>& q,
                const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> q_dot) {
  BOUGH_DEMAND(q.size() == system.num_q() && u.size() == system.num_u() && q_dot.size() == q.size());
  for (const TreeBody& tb : system.tree.bodies) {
    double rates[6];
    for (int i = 0; i < tb.num_hinge_u(); ++i) {
      const HingeMode mode = data.tree.mode[as_index(tb.u_offset + i)];
      rates[i] = mode == HingeMode::Free     ? u[tb.u_offset + i]
                 : mode == HingeMode::Locked ? 0
                                             : data.tree.functions[*tb.motion[as_index(i)]].calc(t).f_dot;
    }
    tb.hinge->calc_q_dot(q.data() + tb.q_offset, rates, q_dot.data() + tb.q_offset);
    q_dot.segment(tb.eta_offset(), tb.num_modes()) = u.segment(tb.eta_dot_offset(), tb.num_modes());
  }
}

void get_q_dot(const System& system, const SystemData& data, Eigen::Ref<VectorXd> q_dot) {
  const TreeData& d = data.tree;
  d.demand(Stage::Velocity);
  BOUGH_DEMAND(q_dot.size() == system.num_q());
  for (const TreeBody& tb : system.tree.bodies) {
    tb.hinge->calc_q_dot(d.q.data() + tb.q_offset, d.u.data() + tb.u_offset, q_dot.data() + tb.q_offset);
    for (int j = 0; j < tb.num_modes(); ++j) q_dot[tb.eta_offset() + j] = d.u[tb.eta_dot_offset() + j];
  }
}

namespace {
void set_tank_masses(const System& system, SystemData& data, double t) {
  for (size_t i = 0; i < system.tree.tanks.size(); ++i) {
    const Tank& tank = system.tree.tanks[i];
    double& mass = data.tree.tanks[i].mass;
    mass = tank.function ? data.tree.functions[*tank.function].calc(t).f : tank.initial;
    for (const int row : tank.used_rows) mass -= data.signals.z[row];
    // Thrusters stop at an event, which a trial step may pass.
    if (!tank.function || mass >= -kTankNoise * tank.initial) continue;
    std::ostringstream what;
    what << "tank '" << tank.name << "' is emptier than empty at t = " << t << ": its mass is " << mass;
    throw ComputationError("run.tank-empty", tank.at, what.str(), "end the function at a mass of at least 0");
  }
}
}  // namespace

void calc_kinematics(const System& system, SystemData& data, double t, const Eigen::Ref<const VectorXd>& q,
                     const Eigen::Ref<const VectorXd>& u) {
  set_tank_masses(system, data, t);
  calc_kinematics(system.tree, t, q, u, data.tree);
  std::fill(data.elements.begin(), data.elements.end(), ForceResult());
}

void set_z(SystemData& data, const Eigen::Ref<const VectorXd>& z) {
  const auto num_states = data.signals.z.size();
  BOUGH_DEMAND(z.size() == num_states || z.size() == num_states + 6);
  data.signals.z = z.head(num_states);
  if (z.size() > num_states) data.momentum_out = z.tail<6>();
}

void calc_z_dot(const System& system, SystemData& data, Eigen::Ref<VectorXd> z_dot) {
  data.tree.demand(Stage::Acceleration);
  system.signals.calc_after_acceleration(get_motion(system, data), data.signals);
  system.signals.calc_rates(get_motion(system, data), data.signals, z_dot.head(system.signals.num_states));
  if (system.num_momentum_out() > 0) z_dot.tail<6>() = data.tree.momentum_out;
}

void calc_signals(const System& system, SystemData& data) {
  data.tree.demand(Stage::Acceleration);
  system.signals.calc_all(get_motion(system, data), data.signals);
}

void add_forces(const System& system, SystemData& data, double t) {
  data.tree.demand(Stage::Velocity);
  data.tree.gravity = system.gravity.uniform;
  system.signals.calc_before_acceleration(get_motion(system, data), data.signals);
  for (const AppliedForce& force : system.forces) add_applied_force(force, system.tree, t, data.tree);
  add_hinge_forces(system.tree, data.tree);
  for (size_t i = 0; i < system.tree.tanks.size(); ++i)
    add_prescribed_flow(system.tree, static_cast<int>(i), data.tree);
  Loads loads(system.tree, data.tree);
  for (size_t i = 0; i < system.elements.size(); ++i)
    data.elements[i] = system.elements[i]->calc(system.tree, data.tree, &loads);
  system.signals.add_loads(get_motion(system, data), data.signals, data.tree);
}

void add_node_wrench(const System& system, SystemData& data, int body, int node_index, const Vector3d& f_W,
                     const Vector3d& t_W) {
  data.tree.demand(Stage::Velocity);
  const Matrix3d R_BW = data.tree[body].state.R_WB.transpose();
  add_wrench_in_body(at(system, body), node_index, R_BW * f_W, R_BW * t_W, data.tree);
}

void calc_accelerations(const System& system, SystemData& data, double, Eigen::Ref<VectorXd> u_dot) {
  const bool has_friction = !system.load_frictions.empty() && !data.friction.is_frozen;
  if (has_friction) remove_load_friction(data.tree);
  factor_and_solve(system.tree, data.tree, u_dot);
  close_loops(system.loops, system.tree, data.tree, data.loops, u_dot);
  if (has_friction) add_load_friction(system, data, u_dot);
}

void calc_accelerations_dense(const System& system, SystemData& data, double, Eigen::Ref<VectorXd> u_dot) {
  if (data.loops.blocks.empty()) return calc_dense_accelerations(system.tree, data.tree, u_dot);
  calc_dense_accelerations(system.loops, system.tree, data.tree, data.loops, u_dot);
}

void project(const System& system, SystemData& data, double t, Eigen::Ref<VectorXd> q, Eigen::Ref<VectorXd> u) {
  project(system.loops, system.tree, t, q, u, data.tree, data.loops);
}

void remove_normal(const System& system, SystemData& data, Eigen::Ref<VectorXd> dq, Eigen::Ref<VectorXd> du) {
  if (data.loops.blocks.empty()) return;
  if (has_rate_rows(system.loops, data.loops)) {
    // Projection moves q along the rates that are left free: what it does not undo stays in the error.
    remove_normal(system.loops, system.tree, data.tree, data.loops, du);
    return;
  }
  // q's in the tangent: N⁺ by columns of N, which are orthogonal to each other.
  VectorXd& tangent = data.tangent;
  for (const TreeBody& tb : system.tree.bodies) {
    const int nq = tb.num_hinge_q(), nu = tb.num_hinge_u(), n = tb.num_modes();
    tangent.segment(tb.eta_dot_offset(), n) = dq.segment(tb.eta_offset(), n);
    if (tb.hinge->has_independent_coordinates()) {
      tangent.segment(tb.u_offset, nu) = dq.segment(tb.q_offset, nq);
      continue;
    }
    for (int i = 0; i < nu; ++i) {
      double unit[6] = {}, column[7];
      unit[i] = 1;
      tb.hinge->calc_q_dot(data.tree.q.data() + tb.q_offset, unit, column);
      const Eigen::Map<const VectorXd> N(column, nq);
      tangent[tb.u_offset + i] = N.dot(dq.segment(tb.q_offset, nq)) / N.squaredNorm();
    }
  }
  remove_normal(system.loops, system.tree, data.tree, data.loops, tangent);
  for (const TreeBody& tb : system.tree.bodies) {
    const int n = tb.num_modes();
    double column[7];
    tb.hinge->calc_q_dot(data.tree.q.data() + tb.q_offset, tangent.data() + tb.u_offset, column);
    dq.segment(tb.q_offset, tb.num_hinge_q()) = Eigen::Map<const VectorXd>(column, tb.num_hinge_q());
    dq.segment(tb.eta_offset(), n) = tangent.segment(tb.eta_dot_offset(), n);
  }
  remove_normal(system.loops, system.tree, data.tree, data.loops, du);
}

int System::num_constraints() const { return loops.size(); }
int System::find_constraint(const std::string& name) const { return loops.find(name); }
const std::string& System::constraint_name(int c) const { return loops[c].name; }
bool System::is_coupler(int c) const { return !loops[c].closure; }

const BodyState& get_body_state(const SystemData& data, int body) { return data.tree.bodies[as_index(body)].state; }

HingeReaction get_hinge_reaction(const System& system, const SystemData& data, int body) {
  return calc_hinge_reaction(system.tree, data.tree, body);
}

}  // namespace bough::solver
