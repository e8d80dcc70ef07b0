#include "solver/tree/tree.hpp"

namespace bough::solver {

namespace {

// A hinge frame F fixed in a node K of body B: pose, velocity and bias acceleration against the frame of B.
struct FrameInBody {
  Vector3d r;  ///< p_BoF
  Matrix3d R;  ///< R_BF
  Vector3d v = Vector3d::Zero(), w = Vector3d::Zero();
  Vector3d gamma_t = Vector3d::Zero(), gamma_r = Vector3d::Zero();
};

FrameInBody calc_frame(const Body& body, const Attachment& at, const ConstVectorRef& eta, const ConstVectorRef& eta_dot,
                       Eigen::Ref<Matrix6Xd> J) {
  const Node& node = body.nodes()[static_cast<size_t>(at.node)];
  FrameInBody f;
  if (!at.moves) {
    f.r = node.p + at.p_KH;
    f.R = at.R_KH;
    return f;
  }
  NodeInBody k;
  calc_node_in_body(node, eta, eta_dot, k);
  calc_node_jacobian(node, eta, k.T, J);
  const Vector3d o = k.R_BK * at.p_KH;
  for (int j = 0; j < J.cols(); ++j) J.col(j).head<3>() -= o.cross(Vector3d(J.col(j).tail<3>()));
  f.r = k.r + o;
  f.R = k.R_BK * at.R_KH;
  f.w = k.w;
  f.v = k.v + k.w.cross(o);
  f.gamma_r = k.gamma_r;
  f.gamma_t = k.gamma_t + k.gamma_r.cross(o) + k.w.cross(k.w.cross(o));
  return f;
}

// Acceleration of F at zero a, α, η̈ of its body, which turns at w.
void add_frame_bias(const FrameInBody& f, const Vector3d& w, Vector3d& linear, Vector3d& angular) {
  linear += w.cross(w.cross(f.r)) + 2 * w.cross(f.v) + f.gamma_t;
  angular += w.cross(f.w) + f.gamma_r;
}

void set_hinge_motion(const TreeBody& tb, double t, TreeData& data, BodyData& d) {
  const int num = tb.hinge->num_u();
  if (tb.is_prescribed()) {
    for (int i = 0; i < num; ++i) {
      const auto value = tb.motion[static_cast<size_t>(i)]->calc(t);
      data.q[tb.q_offset + i] = value.f;
      d.hinge_rate[i] = value.f_dot;
      d.hinge_acceleration[i] = value.f_ddot;
    }
  } else {
    for (int i = 0; i < num; ++i) d.hinge_rate[i] = data.u[tb.u_offset + i];
  }
  tb.hinge->calc_motion(data.q.data() + tb.q_offset, d.hinge_rate.data(), d.hinge);
}

void calc_body(const Tree& tree, int b, TreeData& data) {
  const TreeBody& tb = tree.bodies[static_cast<size_t>(b)];
  BodyData& d = data.bodies[static_cast<size_t>(b)];
  const BodyData& P = data.parent_of(tb);
  const int n = tb.body.num_modes(), nu = tb.hinge->num_u();
  set_hinge_motion(tb, data.t, data, d);
  Vector3d v_rel = Vector3d::Zero(), w_rel = Vector3d::Zero();
  Vector3d a_rel = d.hinge.bias.head<3>(), alpha_rel = d.hinge.bias.tail<3>();
  for (int i = 0; i < nu; ++i) {
    v_rel += d.hinge.H.col(i).head<3>() * d.hinge_rate[i];
    w_rel += d.hinge.H.col(i).tail<3>() * d.hinge_rate[i];
    if (tb.is_prescribed()) {
      a_rel += d.hinge.H.col(i).head<3>() * d.hinge_acceleration[i];
      alpha_rel += d.hinge.H.col(i).tail<3>() * d.hinge_acceleration[i];
    }
  }

  // The parent's end, in P.
  FrameInBody fp;
  int m = 0;
  const Vector3d& w_P = P.state.w_B;
  if (tb.parent >= 0) {
    const TreeBody& parent = tree.bodies[static_cast<size_t>(tb.parent)];
    m = parent.body.num_modes();
    fp = calc_frame(parent.body, tb.on_parent, data.q.segment(parent.eta_offset(), m),
                    data.u.segment(parent.eta_dot_offset(), m), d.X.rightCols(tb.on_parent.moves ? m : 0));
  } else {
    fp.r = tb.on_parent.p_KH;
    fp.R = tb.on_parent.R_KH;
  }
  // The child's end, in B.
  const auto eta = data.q.segment(tb.eta_offset(), n);
  const auto eta_dot = data.u.segment(tb.eta_dot_offset(), n);
  const FrameInBody fc = calc_frame(tb.body, tb.on_child, eta, eta_dot, d.Jc);

  const Vector3d d_P = fp.R * d.hinge.p_HpHc;  // Hp to Hc
  d.R_PB = fp.R * d.hinge.R_HpHc * fc.R.transpose();
  const Matrix3d R_BP = d.R_PB.transpose();
  const Matrix3d R_BHp = R_BP * fp.R;
  d.r_PoBo = fp.r + d_P - d.R_PB * fc.r;
  d.state.R_WB = P.state.R_WB * d.R_PB;
  d.state.p_WBo = P.state.p_WBo + P.state.R_WB * d.r_PoBo;

  for (int i = 0; i < nu; ++i) {
    const Vector3d angular = R_BHp * d.hinge.H.col(i).tail<3>();
    d.H.col(i).head<3>() = R_BHp * d.hinge.H.col(i).head<3>() + fc.r.cross(angular);
    d.H.col(i).tail<3>() = angular;
  }
  if (tb.on_child.moves) {  // S(r_c)⁻¹ J
    for (int j = 0; j < n; ++j) d.Jc.col(j).head<3>() += fc.r.cross(Vector3d(d.Jc.col(j).tail<3>()));
  }
  if (tb.on_parent.moves) {
    const Vector3d e = d.r_PoBo - fp.r;
    d.X.topLeftCorner<3, 3>() = R_BP;
    d.X.block<3, 3>(0, 3) = -R_BP * skew(d.r_PoBo);
    d.X.block<3, 3>(3, 3) = R_BP;
    for (int j = 6; j < 6 + m; ++j) {
      const Vector3d angular = d.X.col(j).tail<3>();
      const Vector3d linear = d.X.col(j).head<3>() - e.cross(angular);
      d.X.col(j).head<3>() = R_BP * linear;
      d.X.col(j).tail<3>() = R_BP * angular;
    }
  }

  // Velocities: through Hp and Hc, so that each Jacobian is used once only.
  const Vector3d w_Hp = w_P + fp.w;
  const Vector3d v_rel_P = fp.R * v_rel, w_rel_P = fp.R * w_rel;
  const Vector3d v_Hc = P.state.v_B + w_P.cross(fp.r) + fp.v + w_Hp.cross(d_P) + v_rel_P;
  d.state.w_B = R_BP * (w_Hp + w_rel_P) - fc.w;
  d.state.v_B = R_BP * v_Hc - fc.v - d.state.w_B.cross(fc.r);

  // Bias acceleration of Hc in P, then of Bo in B.
  Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();
  add_frame_bias(fp, w_P, linear, angular);
  linear += angular.cross(d_P) + w_Hp.cross(w_Hp.cross(d_P)) + 2 * w_Hp.cross(v_rel_P) + fp.R * a_rel;
  angular += w_Hp.cross(w_rel_P) + fp.R * alpha_rel;
  Vector3d linear_c = Vector3d::Zero(), angular_c = Vector3d::Zero();
  add_frame_bias(fc, d.state.w_B, linear_c, angular_c);
  d.b.tail<3>() = R_BP * angular - angular_c;
  d.b.head<3>() = R_BP * linear - linear_c + fc.r.cross(Vector3d(d.b.tail<3>()));

  tb.body.calc_inertia(d.state.w_B, eta, eta_dot, d.inertia);
  d.applied.setZero();
  d.hinge_force.setZero();
  d.spring_energy = 0;
}

}  // namespace

TreeData make_tree_data(const Tree& tree) {
  TreeData data;
  data.q = VectorXd::Zero(tree.num_q);
  data.u = VectorXd::Zero(tree.num_u);
  for (const TreeBody& tb : tree.bodies) {
    const int n = tb.body.num_modes(), nf = tb.num_hinge_u + n;
    const int m = tb.parent < 0 ? 0 : tree.bodies[static_cast<size_t>(tb.parent)].body.num_modes();
    BodyData d;
    d.inertia = tb.body.make_inertia();
    d.X = Matrix6Xd::Zero(6, tb.on_parent.moves ? 6 + m : 0);
    d.PX = d.X;
    d.Jc = Matrix6Xd::Zero(6, tb.on_child.moves ? n : 0);
    d.applied = d.beta = VectorXd::Zero(6 + n);
    d.P6.setZero();
    d.G6.setZero();
    d.z = VectorXd::Zero(nf);
    d.eta_ddot = VectorXd::Zero(n);
    if (n > 0) {
      d.P = MatrixXd::Zero(6 + n, 6 + n);
      d.W = MatrixXd::Zero(6 + n, nf);
      d.D = MatrixXd::Identity(nf, nf);
      d.Gz = MatrixXd::Zero(nf, 7);
    }
    data.bodies.push_back(std::move(d));
  }
  return data;
}

void calc_tree_kinematics(const Tree& tree, double t, const ConstVectorRef& q, const ConstVectorRef& u,
                          TreeData& data) {
  BOUGH_DEMAND(q.size() == tree.num_q && u.size() == tree.num_u);
  data.q = q;
  data.u = u;
  data.t = t;
  data.gravity.setZero();
  for (int b = 0; b < static_cast<int>(tree.bodies.size()); ++b) calc_body(tree, b, data);
}

}  // namespace bough::solver
