#include "solver/system/system.hpp"

#include <algorithm>

#include "solver/system/impl.hpp"

void std::default_delete<bough::solver::SystemData>::operator()(bough::solver::SystemData* data) const { delete data; }

namespace bough::solver {

namespace {
size_t as_index(int b) { return static_cast<size_t>(b); }
const TreeBody& at(const System& s, int b) { return s.impl().tree.bodies[as_index(b)]; }
}  // namespace

System::System() : impl_(std::make_unique<Impl>()) {}
System::~System() = default;
System::System(System&&) noexcept = default;

int System::num_bodies() const { return static_cast<int>(impl_->tree.bodies.size()); }
int System::num_q() const { return impl_->tree.num_q; }
int System::num_u() const { return impl_->tree.num_u; }

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
bool System::is_sound(int b) const { return impl_->sound[as_index(b)]; }
int System::num_modes(int b) const { return at(*this, b).body.num_modes(); }
int System::q_offset(int b) const { return at(*this, b).q_offset; }
int System::u_offset(int b) const { return at(*this, b).u_offset; }
int System::num_hinge_q(int b) const { return at(*this, b).num_hinge_q(); }
int System::num_hinge_u(int b) const { return at(*this, b).num_hinge_u; }
int System::num_hinge_rates(int b) const { return at(*this, b).hinge->num_u(); }
int System::eta_offset(int b) const { return at(*this, b).eta_offset(); }
int System::eta_dot_offset(int b) const { return at(*this, b).eta_dot_offset(); }
int System::find_node(int b, int id) const { return at(*this, b).body.find_node(id); }
bool System::has_node_second_order(int b, int node) const {
  return at(*this, b).body.nodes()[as_index(node)].K2.size() > 0;
}
const std::vector<double>& System::breakpoints() const { return impl_->breakpoints; }
const std::vector<double>& System::landmarks() const { return impl_->landmarks; }

std::unique_ptr<SystemData> System::make_data() const {
  auto data = std::make_unique<SystemData>();
  data->tree = make_tree_data(impl_->tree);
  return data;
}

void System::calc_initial_state(Eigen::Ref<VectorXd> q, Eigen::Ref<VectorXd> u) const {
  BOUGH_DEMAND(q.size() == num_q() && u.size() == num_u());
  for (const TreeBody& tb : impl_->tree.bodies) {
    const int n = tb.body.num_modes(), nq = tb.num_hinge_q();
    q.segment(tb.q_offset, nq) = tb.initial_q;
    for (size_t i = 0; i < tb.motion.size(); ++i)
      q[tb.q_offset + static_cast<int>(i)] = tb.motion[i]->calc(impl_->start).f;
    u.segment(tb.u_offset, tb.num_hinge_u) = tb.initial_u.head(tb.num_hinge_u);
    q.segment(tb.eta_offset(), n) = tb.initial_eta;
    u.segment(tb.eta_dot_offset(), n) = tb.initial_eta_dot;
  }
}

void calc_q_dot(const System& system, SystemData&, double t, const Eigen::Ref<const VectorXd>& q,
                const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> q_dot) {
  BOUGH_DEMAND(q.size() == system.num_q() && u.size() == system.num_u() && q_dot.size() == q.size());
  for (const TreeBody& tb : system.impl().tree.bodies) {
    const int n = tb.body.num_modes();
    if (tb.is_prescribed()) {
      for (size_t i = 0; i < tb.motion.size(); ++i)
        q_dot[tb.q_offset + static_cast<int>(i)] = tb.motion[i]->calc(t).f_dot;
    } else {
      tb.hinge->calc_q_dot(q.data() + tb.q_offset, u.data() + tb.u_offset, q_dot.data() + tb.q_offset);
    }
    q_dot.segment(tb.eta_offset(), n) = u.segment(tb.eta_dot_offset(), n);
  }
}

void calc_kinematics(const System& system, SystemData& data, double t, const Eigen::Ref<const VectorXd>& q,
                     const Eigen::Ref<const VectorXd>& u) {
  calc_tree_kinematics(system.impl().tree, t, q, u, data.tree);
}

void add_forces(const System& system, SystemData& data, double t) {
  const System::Impl& impl = system.impl();
  data.tree.gravity = impl.gravity;
  for (const AppliedForce& force : impl.forces) add_applied_force(force, impl.tree, t, data.tree);
  add_hinge_forces(impl.tree, data.tree);
}

void add_node_wrench(const System& system, SystemData& data, int body, int node_index, const Vector3d& f_W,
                     const Vector3d& t_W) {
  BodyData& d = data.tree.bodies[as_index(body)];
  const Matrix3d R_BW = d.state.R_WB.transpose();
  add_wrench_in_body(at(system, body), node_index, data.tree.q, R_BW * f_W, R_BW * t_W, d);
}

void calc_accelerations(const System& system, SystemData& data, double, Eigen::Ref<VectorXd> u_dot) {
  calc_tree_accelerations(system.impl().tree, data.tree, u_dot);
}

void calc_accelerations_dense(const System& system, SystemData& data, double, Eigen::Ref<VectorXd> u_dot) {
  calc_dense_accelerations(system.impl().tree, data.tree, u_dot);
}

const BodyState& get_body_state(const SystemData& data, int body) { return data.tree.bodies[as_index(body)].state; }

void get_hinge(const System& system, const SystemData& data, int body, Eigen::Ref<VectorXd> q,
               Eigen::Ref<VectorXd> q_dot, Eigen::Ref<VectorXd> force) {
  const TreeBody& tb = at(system, body);
  const BodyData& d = data.tree.bodies[as_index(body)];
  const int nu = tb.hinge->num_u();
  BOUGH_DEMAND(q.size() == tb.num_hinge_q() && q_dot.size() == nu && force.size() == nu);
  tb.hinge->get_for_file(data.tree.q.data() + tb.q_offset, q.data());
  q_dot = d.hinge_rate.head(nu);
  force = d.hinge_force.head(nu);
}

}  // namespace bough::solver
