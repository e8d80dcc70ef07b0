#include "solver/tree/tree.hpp"

namespace bough::solver {

namespace {

Matrix6Xd make_constant_H(const TreeBody& tb) {
  if (tb.on_parent.moves || tb.on_child.moves || !tb.hinge->is_constant_in_child()) return {};
  VectorXd q = VectorXd::Zero(tb.hinge->num_q());
  tb.hinge->set_neutral(q.data());
  HingeMotion motion;
  tb.hinge->calc_position(q.data(), motion);
  const Vector3d r = make_marker_motion(tb.body, tb.on_child).r;
  Matrix6Xd H(6, tb.hinge->num_u());
  for (int i = 0; i < tb.hinge->num_u(); ++i) {
    const Vector3d angular = tb.on_child.R_KM * motion.H.col(i).tail<3>();
    H.col(i) << tb.on_child.R_KM * motion.H.col(i).head<3>() + r.cross(angular), angular;
  }
  return H;
}

}  // namespace

int Tree::add_marker(const Marker& marker) {
  for (size_t m = 0; m < markers.size(); ++m) {
    if (markers[m].is_same(marker)) return static_cast<int>(m);
  }
  const int index = static_cast<int>(markers.size());
  markers.push_back(marker);
  if (marker.moves) moving.push_back(index);
  return index;
}

void Tree::finish() {
  num_q = num_u = num_v = 0;
  markers.assign(1, Marker());
  moving.clear();
  for (TreeBody& tb : bodies) tb.carries_on_modes = false;
  for (const TreeBody& tb : bodies) {
    if (tb.on_parent.moves) bodies[static_cast<size_t>(tb.parent)].carries_on_modes = true;
  }
  for (int b = 0; b < size(); ++b) {
    TreeBody& tb = bodies[static_cast<size_t>(b)];
    const int n = tb.num_modes();
    tb.on_parent.body = tb.parent;
    tb.on_child.body = b;
    tb.parent_marker = add_marker(tb.on_parent);
    tb.child_marker = add_marker(tb.on_child);
    tb.constant_H = make_constant_H(tb);
    tb.q_offset = num_q;
    tb.u_offset = num_u;
    tb.v_offset = num_v;
    num_q += tb.num_hinge_q() + n;
    num_u += tb.num_hinge_u() + n;
    num_v += 6 + n;
  }
}

}  // namespace bough::solver
