#include "solver/forces/sunlight.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

namespace bough::solver {
namespace {

/// Angular radius of the planet, and its distance from the sun on the sky.
struct Sky {
  double planet = 0, apart = 0;
};

Sky calc_sky(const Shadow& shadow, const Vector3d& p_W, const Vector3d& sun_W) {
  const Vector3d R = p_W - shadow.centre_W;
  return {std::asin(std::min(1.0, shadow.radius / R.norm())), std::atan2(sun_W.cross(-R).norm(), sun_W.dot(-R))};
}

}  // namespace

double calc_sunlight(const Shadow& shadow, const Vector3d& p_W, const Vector3d& sun_W) {
  if (!(shadow.radius > 0)) return 1;
  const auto [b, c] = calc_sky(shadow, p_W, sun_W);
  const double a = shadow.sun_size;
  if (c >= a + b) return 1;
  if (c <= b - a) return 0;
  if (c <= a - b) return 1 - b * b / (a * a);
  const double x = (c * c + a * a - b * b) / (2 * c), y = std::sqrt(std::max(0.0, a * a - x * x));
  const double covered =
      a * a * std::acos(std::clamp(x / a, -1.0, 1.0)) + b * b * std::acos(std::clamp((c - x) / b, -1.0, 1.0)) - c * y;
  return 1 - covered / (std::numbers::pi * a * a);
}

Eigen::Vector2d calc_contacts(const Shadow& shadow, const Vector3d& p_W, const Vector3d& sun_W) {
  const auto [b, c] = calc_sky(shadow, p_W, sun_W);
  return {c - b - shadow.sun_size, c - b + shadow.sun_size};
}

void demand_outside(const Shadow& shadow, const Vector3d& p_W, const std::string& force, double t) {
  if (!(shadow.radius > 0) || (p_W - shadow.centre_W).norm() >= shadow.radius) return;
  std::ostringstream message;
  message << "force '" << force << "': its panel is inside the planet at t = " << t;
  throw ComputationError("run.inside-planet", {}, message.str(),
                         "look at the orbit, and at centre and radius of the gravity_central");
}

Vector3d calc_panel_force(const SolarPressure::Panel& panel, Vector3d n, double area) {
  double cosine = n.dot(panel.sun_W);
  if (cosine < 0 && !panel.is_one_sided) {
    n = -n;
    cosine = -cosine;
  }
  return -panel.pressure * area * std::max(0.0, cosine) *
         ((1 - panel.specular) * panel.sun_W + 2 * (panel.specular * cosine + panel.diffuse / 3) * n);
}

ForceResult SolarPressure::calc(const Tree& tree, const TreeData& data, Loads* loads) const {
  const MarkerInWorld k = calc_marker_in_world(data, tree, marker_);
  demand_outside(panel_.shadow, k.p, name(), data.t);
  const Vector3d n_W = k.R * panel_.normal;
  double light = calc_sunlight(panel_.shadow, k.p, panel_.sun_W);
  if (!panel_.shading.is_empty()) light *= panel_.shading.calc_lit_share_of_disc(data, k.place, n_W, panel_.area);
  const Vector3d f = calc_panel_force(panel_, n_W, light * panel_.area);
  if (loads != nullptr) loads->add_wrench(marker_, f, Vector3d::Zero());
  ForceResult result;
  for (int i = 0; i < 3; ++i) result.values[static_cast<size_t>(i)] = f[i];
  result.values[3] = light;
  return result;
}

void SolarPressure::calc_kinks(const Tree& tree, const TreeData& data, double* g) const {
  const MarkerInWorld k = calc_marker_in_world(data, tree, marker_);
  g[0] = (k.R * panel_.normal).dot(panel_.sun_W);
  if (panel_.shadow.radius > 0) Eigen::Map<Eigen::Vector2d>{g + 1} = calc_contacts(panel_.shadow, k.p, panel_.sun_W);
}

}  // namespace bough::solver
