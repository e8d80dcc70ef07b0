#include "solver/tree/data.hpp"

#include "solver/bodies/kernels.hpp"

namespace bough::solver {

namespace {

Sweep make_sweep(const Tree& tree) {
  Sweep s;
  s.beta = VectorXd::Zero(tree.num_v);
  s.tau = s.z = s.u_dot = VectorXd::Zero(tree.num_u);
  s.b = s.A = Matrix6Xd::Zero(6, tree.size());
  return s;
}

}  // namespace

TreeData make_tree_data(const Tree& tree) {
  TreeData data;
  data.functions = FunctionCopies(tree.functions);
  data.q = VectorXd::Zero(tree.num_q);
  data.u = data.given_u = data.given_udot = data.hinge_force = data.transmitted = data.slide = data.load_friction =
      data.friction_limit = VectorXd::Zero(tree.num_u);
  data.h = data.applied = VectorXd::Zero(tree.num_v);
  clear_added(tree, data);
  data.motion = make_sweep(tree);
  data.response = make_sweep(tree);
  const Body ground = Body::make_rigid(0, Vector3d::Zero(), Matrix3d::Zero());
  for (const Marker& m : tree.markers)
    data.markers.push_back(make_marker_motion(m.body < 0 ? ground : tree[m.body].body, m));
  std::vector<HingeMode> mode;
  for (const TreeBody& tb : tree.bodies) {
    const int n = tb.num_modes(), m = tb.parent < 0 ? 0 : tree[tb.parent].num_modes();
    mode.insert(mode.end(), tb.mode.begin(), tb.mode.end());
    mode.insert(mode.end(), static_cast<size_t>(n), HingeMode::Free);
    BodyData d;
    d.inertia = tb.body.make_inertia();
    d.X = d.PX = Matrix6Xd::Zero(6, tb.on_parent.moves ? 6 + m : 0);
    d.Jc = Matrix6Xd::Zero(6, tb.on_child.moves ? n : 0);
    data.bodies.push_back(std::move(d));
  }
  for (const Tank& tank : tree.tanks) data.tanks.push_back({tank.initial, tank.shape->calc(tank.initial)});
  set_modes(tree, mode, data);
  return data;
}

void set_modes(const Tree& tree, const std::vector<HingeMode>& mode, TreeData& data) {
  BOUGH_DEMAND(static_cast<int>(mode.size()) == tree.num_u);
  data.mode = mode;
  data.done = 0;
  data.given_u.setZero();
  data.given_udot.setZero();
  for (int b = 0; b < tree.size(); ++b) {
    const TreeBody& tb = tree[b];
    BodyData& d = data[b];
    d.num_free = 0;
    for (int i = 0; i < tb.num_hinge_u(); ++i) {
      if (mode[static_cast<size_t>(tb.u_offset + i)] == HingeMode::Free) d.free[d.num_free++] = i;
    }
    for (int i = 0; i < d.num_free && tb.constant_H.size() > 0; ++i) d.H.col(i) = tb.constant_H.col(d.free[i]);
    const int n = tb.num_modes(), nf = d.num_free + n;
    if (n == 0) continue;
    d.P_top = Matrix6Xd::Zero(6, tb.carries_on_modes ? n : 0);
    d.P_modal = MatrixXd::Zero(d.P_top.cols(), d.P_top.cols());
    d.D = MatrixXd::Identity(pad(nf + 6), nf);
    d.modal_size = VectorXd::Zero(n);
  }
}

void clear_added(const Tree& tree, TreeData& data) {
  data.added.setZero(tree.num_u);
  data.added_K = data.added_D = 0;
  for (const TreeBody& tb : tree.bodies) data.added.segment(tb.u_offset, tb.rotor.size()) = tb.rotor;
}

}  // namespace bough::solver
