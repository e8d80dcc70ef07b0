#include "solver/forces/contact.hpp"

#include <algorithm>
#include <cmath>

namespace bough::solver {

std::vector<ForceChannel> ContactElement::channels() const {
  return {{"gap", 1, "distance of the surfaces; negative: depth", "L"},
          {"rate", 1, "rate of the gap", "L/T"},
          {"force", 1, "normal force", "F"},
          {"friction", 3, "friction on the first end, in the inertial frame", "F"}};
}

ForceResult ContactElement::calc(const Tree& tree, const TreeData& data, Loads* loads) const {
  const MarkerInWorld a = calc_marker_in_world(data, tree, from_), b = calc_marker_in_world(data, tree, to_);
  const Vector3d d = a.p - b.p;
  Vector3d n;  // from B to A
  double gap;
  if (law_.is_plane) {
    n = b.R * law_.normal;
    gap = n.dot(d) - law_.radius;
  } else {
    const double distance = d.norm();
    n = distance > 0 ? Vector3d(d / distance) : Vector3d::UnitZ();
    gap = distance - law_.radius - law_.to_radius;
  }
  const Vector3d at = a.p - (law_.radius + gap) * n;  // on the surface of B
  const Vector3d v = a.v + a.w.cross(at - a.p) - b.v - b.w.cross(at - b.p);
  const double rate = n.dot(v);
  ForceResult result;
  result.values = {gap, rate};
  if (gap >= 0) return result;

  const double depth = -gap;
  const double elastic = law_.stiffness * std::pow(depth, law_.exponent);
  const double normal = std::max(0.0, elastic * (1 - law_.damping * rate));
  const Vector3d slip = v - rate * n;
  Vector3d friction = Vector3d::Zero();
  if (law_.friction > 0)
    friction = -law_.friction * normal / std::sqrt(slip.squaredNorm() + law_.slip_velocity * law_.slip_velocity) * slip;
  if (loads != nullptr) {
    const Vector3d f = normal * n + friction;
    loads->add_wrench(from_, f, (at - a.p).cross(f));
    loads->add_wrench(to_, -f, (b.p - at).cross(f));
  }
  result.strain = elastic * depth / (law_.exponent + 1);
  result.power = elastic * rate;
  result.dissipated = (elastic - normal) * rate - friction.dot(slip);
  result.values[2] = normal;
  for (int i = 0; i < 3; ++i) result.values[static_cast<size_t>(3 + i)] = friction[i];
  return result;
}

}  // namespace bough::solver
