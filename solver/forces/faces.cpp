#include "solver/forces/faces.hpp"

#include <algorithm>
#include <cmath>

namespace bough::solver {

std::vector<ForceChannel> FaceElement::channels() const {
  return {{"force", 3, "sum over the faces, in the inertial frame", "F"},
          {"area", 1, "projected area of the faces that are hit", "L^2"}};
}

FaceMotion FaceElement::calc_face(const Tree& tree, const TreeData& data, const MeshFaces::Face& face) const {
  const TreeBody& tb = tree[mesh_.body];
  const BodyState& s = data[mesh_.body].state;
  const auto eta = data.q.segment(tb.eta_offset(), tb.num_modes());
  const auto eta_dot = data.u.segment(tb.eta_dot_offset(), tb.num_modes());
  std::array<Vector3d, 4> r;
  Vector3d middle = Vector3d::Zero(), rate = Vector3d::Zero();
  for (int i = 0; i < face.count; ++i) {
    const int grid = face.corner[static_cast<size_t>(i)];
    const auto shape = mesh_.shapes.middleRows<3>(3 * grid);
    Vector3d& own = r[static_cast<size_t>(i)];
    own = mesh_.p.col(grid);
    for (Eigen::Index j = 0; j < eta.size(); ++j) {
      own += eta[j] * shape.col(j);
      rate += eta_dot[j] * shape.col(j);
    }
    middle += own;
  }
  middle /= face.count;
  rate /= face.count;
  const Vector3d area = face.count == 3 ? (r[1] - r[0]).cross(r[2] - r[0]) : (r[2] - r[0]).cross(r[3] - r[1]);
  FaceMotion motion;
  motion.place = s.calc_place(middle);
  motion.v = s.R_WB * (s.v_B + s.w_B.cross(middle) + rate);
  motion.area = 0.5 * (s.R_WB * area);
  motion.count = face.count;
  for (int i = 0; i < face.count; ++i) motion.corners.col(i) = s.R_WB * (r[static_cast<size_t>(i)] - middle);
  return motion;
}

template <class CalcForce>
ForceResult FaceElement::calc_sum(const Tree& tree, const TreeData& data, Loads* loads,
                                  const CalcForce& calc_force) const {
  const BodyState& s = data[mesh_.body].state;
  const int n = tree[mesh_.body].num_modes();
  ForceResult result;
  Vector3d sum = Vector3d::Zero(), moment = Vector3d::Zero();
  double seen = 0;
  for (const auto& face : mesh_.faces) {
    const FaceMotion motion = calc_face(tree, data, face);
    const Vector3d f_W = calc_force(motion, seen);
    const Vector3d f = s.R_WB.transpose() * f_W;
    sum += f_W;
    moment += (s.R_WB.transpose() * (motion.place.p_R - s.p_RBo)).cross(f);
    if (loads == nullptr) continue;
    for (int i = 0; i < face.count; ++i) {
      const auto shape = mesh_.shapes.middleRows<3>(3 * face.corner[static_cast<size_t>(i)]);
      for (int j = 0; j < n; ++j) loads->add_to_mode(mesh_.body, j, f.dot(shape.col(j)) / face.count);
    }
  }
  if (loads != nullptr) loads->add_to_body(mesh_.body, s.R_WB.transpose() * sum, moment);
  for (int i = 0; i < 3; ++i) result.values[static_cast<size_t>(i)] = sum[i];
  result.values[3] = seen;
  return result;
}

ForceResult DragOnFaces::calc(const Tree& tree, const TreeData& data, Loads* loads) const {
  return calc_sum(tree, data, loads, [&](const FaceMotion& face, double& seen) -> Vector3d {
    Vector3d v = face.v;
    const double share = law_.calc_air(face.place.p_W, v);
    const double speed = v.norm(), along = face.area.dot(v);
    if (speed == 0 || (is_one_sided_ && along < 0)) return Vector3d::Zero();
    seen += std::abs(along) / speed;
    return -share * law_.half_density_area * std::abs(along) * v;
  });
}

ValidityWarning DragOnFaces::check_validity(const Tree&, const TreeData& data) const {
  return law_.check_height(name(), data[mesh().body].state.p_WBo);
}

ForceResult SunOnFaces::calc(const Tree& tree, const TreeData& data, Loads* loads) const {
  const Vector3d& p = data[mesh().body].state.p_WBo;
  demand_outside(panel_.shadow, p, name(), data.t);
  const double light = calc_sunlight(panel_.shadow, p, panel_.sun_W);
  ForceResult result = calc_sum(tree, data, loads, [&](const FaceMotion& face, double& seen) -> Vector3d {
    const double area = face.area.norm();
    if (area == 0) return Vector3d::Zero();
    const double facing = face.area.dot(panel_.sun_W);
    const double projected = panel_.is_one_sided ? std::max(0.0, facing) : std::abs(facing);
    if (projected == 0) return Vector3d::Zero();
    double share = 1;
    if (!panel_.shading.is_empty())
      share = panel_.shading.calc_lit_share(data, face.place, face.corners.leftCols(face.count), face.area);
    seen += share * projected;
    return calc_panel_force(panel_, face.area / area, area * light * share);
  });
  result.values[4] = light;
  return result;
}

void SunOnFaces::calc_kinks(const Tree&, const TreeData& data, double* g) const {
  if (panel_.shadow.radius > 0)
    Eigen::Map<Eigen::Vector2d>{g} = calc_contacts(panel_.shadow, data[mesh().body].state.p_WBo, panel_.sun_W);
}

std::vector<ForceChannel> SunOnFaces::channels() const {
  auto channels = FaceElement::channels();
  channels.push_back({"sunlight", 1, "visible share of the sun", "1"});
  return channels;
}

}  // namespace bough::solver
