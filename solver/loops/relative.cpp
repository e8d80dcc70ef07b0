#include "solver/loops/relative.hpp"

namespace bough::solver {

namespace {

struct End {  // a marker, in W
  const Marker& marker;
  const MarkerMotion& motion;
  const BodyState& body;
};

End get_end(const Tree& tree, const TreeData& data, int marker) {
  const Marker& m = tree.markers[static_cast<size_t>(marker)];
  return {m, data.markers[static_cast<size_t>(marker)], data[m.body].state};
}

struct Twist {  // linear and angular, in W
  Vector3d linear, angular;
};

Twist calc_velocity(const End& e) {
  return {e.body.R_WB * (e.body.v_B + e.body.w_B.cross(e.motion.r) + e.motion.v),
          e.body.R_WB * (e.body.w_B + e.motion.w)};
}

Twist calc_bias(const End& e) {
  const Vector3d& w = e.body.w_B;
  return {e.body.R_WB * (w.cross(w.cross(e.motion.r)) + 2 * w.cross(e.motion.v) + e.motion.gamma_v),
          e.body.R_WB * (w.cross(e.motion.w) + e.motion.gamma_w)};
}

Twist calc_response(const Tree& tree, const End& e, const Sweep& s) {
  if (e.marker.body < 0) return {s.ground.head<3>(), s.ground.tail<3>()};
  const auto A = s.A.col(e.marker.body);
  Vector3d linear = A.head<3>() + Vector3d(A.tail<3>()).cross(e.motion.r), angular = A.tail<3>();
  const int row = tree[e.marker.body].eta_dot_offset();
  for (int j = 0; j < e.motion.J.cols(); ++j) {
    linear += e.motion.J.col(j).head<3>() * s.u_dot[row + j];
    angular += e.motion.J.col(j).tail<3>() * s.u_dot[row + j];
  }
  return {e.body.R_WB * linear, e.body.R_WB * angular};
}

}  // namespace

void calc_relative_position(const Tree& tree, const TreeData& data, int parent_marker, int child_marker,
                            const ConstraintState& state, RelativeMotion& out) {
  const End parent = get_end(tree, data, parent_marker), child = get_end(tree, data, child_marker);
  out.R_WHp = parent.body.R_WB * parent.motion.R;
  const Matrix3d R_WM = child.body.R_WB * child.motion.R;
  out.o_W = R_WM * state.p;
  out.d_W = (child.body.calc_place(child.motion.r) - parent.body.calc_place(parent.motion.r)) + out.o_W;
  out.R = out.R_WHp.transpose() * R_WM * state.R;
  out.p = out.R_WHp.transpose() * out.d_W;
}

void calc_relative_velocity(const Tree& tree, const TreeData& data, int parent_marker, int child_marker,
                            RelativeMotion& out) {
  const End parent = get_end(tree, data, parent_marker), child = get_end(tree, data, child_marker);
  const Twist V_p = calc_velocity(parent), V_c = calc_velocity(child);
  const Vector3d &w_p = V_p.angular, &w_c = V_c.angular;
  const Vector3d v_rel = V_c.linear + w_c.cross(out.o_W) - V_p.linear - w_p.cross(out.d_W);
  const Matrix3d R_HpW = out.R_WHp.transpose();
  out.V << R_HpW * v_rel, R_HpW * (w_c - w_p);
  const Twist b_p = calc_bias(parent), b_c = calc_bias(child);
  const Vector3d a_c = b_c.linear + b_c.angular.cross(out.o_W) + w_c.cross(w_c.cross(out.o_W));
  const Vector3d a_p = b_p.linear + b_p.angular.cross(out.d_W) + w_p.cross(w_p.cross(out.d_W));
  out.bias << R_HpW * (a_c - a_p - 2 * w_p.cross(v_rel)), R_HpW * (b_c.angular - b_p.angular - w_p.cross(w_c));
}

Vector6d calc_relative_response(const Tree& tree, const TreeData& data, int parent_marker, int child_marker,
                                const RelativeMotion& motion, const Sweep& sweep) {
  const Twist p = calc_response(tree, get_end(tree, data, parent_marker), sweep);
  const Twist c = calc_response(tree, get_end(tree, data, child_marker), sweep);
  const Matrix3d R_HpW = motion.R_WHp.transpose();
  Vector6d A;
  A << R_HpW * (c.linear + c.angular.cross(motion.o_W) - p.linear - p.angular.cross(motion.d_W)),
      R_HpW * (c.angular - p.angular);
  return A;
}

MarkerWrenches calc_marker_wrenches(const Tree& tree, const TreeData& data, int parent_marker, int child_marker,
                                    const RelativeMotion& motion, const Vector6d& wrench) {
  const Vector3d f = motion.R_WHp * wrench.head<3>(), t = motion.R_WHp * wrench.tail<3>();
  const Matrix3d R_PW = get_end(tree, data, parent_marker).body.R_WB.transpose();
  const Matrix3d R_CW = get_end(tree, data, child_marker).body.R_WB.transpose();
  MarkerWrenches out;
  out.on_child << R_CW * f, R_CW * (t + motion.o_W.cross(f));
  out.on_parent << R_PW * -f, R_PW * -(t + motion.d_W.cross(f));
  return out;
}

}  // namespace bough::solver
