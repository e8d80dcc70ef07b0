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

template <class T>
std::array<T, 5> ContactElement::calc_forces(const std::array<T, 5>& at) const {
  using std::pow, std::sqrt;
  const T gap = law_.is_plane ? at[0] - law_.radius : at[0] - law_.radius - law_.to_radius, rate = at[1];
  const T depth = std::max(T(0), -gap);
  const T elastic = law_.stiffness * pow(depth, law_.exponent);
  const T normal = std::max(T(0.0), elastic * (1 - law_.damping * rate));
  if (!(law_.friction > 0)) return {elastic, normal, T(0), T(0), T(0)};
  const T slip = at[2] * at[2] + at[3] * at[3] + at[4] * at[4];
  const T by = -law_.friction * normal / sqrt(slip + law_.slip_velocity * law_.slip_velocity);
  return {elastic, normal, by * at[2], by * at[3], by * at[4]};
}

ForceResult ContactElement::calc(const Tree& tree, const TreeData& data, Loads* loads) const {
  const MarkerInWorld a = calc_marker_in_world(data, tree, from_), b = calc_marker_in_world(data, tree, to_);
  const Vector3d d = a.place - b.place;
  Vector3d n;  // from B to A
  double gap, separation;
  if (law_.is_plane) {
    n = b.R * law_.normal;
    separation = n.dot(d);
    gap = separation - law_.radius;
  } else {
    separation = d.norm();
    n = separation > 0 ? Vector3d(d / separation) : Vector3d::UnitZ();
    gap = separation - law_.radius - law_.to_radius;
  }
  const Vector3d from_a = -(law_.radius + gap) * n;  // to the surface of B
  const Vector3d v = a.v + a.w.cross(from_a) - b.v - b.w.cross(d + from_a);
  const double rate = n.dot(v);
  ForceResult result;
  result.values = {gap, rate};
  if (gap >= 0 && data.tangents == nullptr) return result;

  const double depth = -gap;
  const Vector3d slip = v - rate * n;
  const auto forces =
      evaluate_law<5, 5>(data.tangents, {this, "force", name()}, 0, {separation, rate, slip.x(), slip.y(), slip.z()},
                         [this](const auto& x) { return calc_forces(x); }, {calc_reach(a.place, b.place), 0, 0, 0, 0});
  const double elastic = forces[0], normal = forces[1];
  const Vector3d friction(forces[2], forces[3], forces[4]);
  if (loads != nullptr) {
    const Vector3d f = normal * n + friction;
    loads->add_wrench(from_, f, from_a.cross(f));
    loads->add_wrench(to_, -f, f.cross(d + from_a));
  }
  result.strain = elastic * depth / (law_.exponent + 1);
  result.power = elastic * rate;
  result.dissipated = (elastic - normal) * rate - friction.dot(slip);
  result.values[2] = normal;
  for (int i = 0; i < 3; ++i) result.values[static_cast<size_t>(3 + i)] = friction[i];
  return result;
}

}  // namespace bough::solver
