#include "solver/forces/element.hpp"

#include "solver/forces/applied.hpp"

namespace bough::solver {

MarkerInWorld calc_marker_in_world(const TreeData& data, const Tree& tree, int marker) {
  const MarkerMotion& m = data.markers[static_cast<size_t>(marker)];
  const BodyState& s = data[tree.markers[static_cast<size_t>(marker)].body].state;
  const Place place = s.calc_place(m.r);
  return {place.p_W, s.R_WB * (s.v_B + s.w_B.cross(m.r) + m.v), s.R_WB * (s.w_B + m.w), s.R_WB * m.R, place};
}

void Loads::add_wrench(int marker, const Vector3d& f_W, const Vector3d& t_W) {
  const Matrix3d R_BW = data_[tree_.markers[static_cast<size_t>(marker)].body].state.R_WB.transpose();
  add_marker_wrench(tree_, marker, R_BW * f_W, R_BW * t_W, data_);
}

void Loads::add_to_body(int body, const Vector3d& f_B, const Vector3d& t_B) {
  const int v = tree_[body].v_offset;
  data_.applied.segment<3>(v) += f_B;
  data_.applied.segment<3>(v + 3) += t_B;
}

}  // namespace bough::solver
