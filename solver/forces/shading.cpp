#include "solver/forces/shading.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory_resource>
#include <numbers>

namespace bough::solver {

namespace {

using Eigen::Vector2d;

/// Corners of a polygon across the sun, counterclockwise.
using Polygon = std::pmr::vector<Vector2d>;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

double calc_area(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& next = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    twice += cross(polygon[i] - polygon[0], next - polygon[0]);
  }
  return 0.5 * twice;
}

/// Convex hull of points (Andrew's monotone chain). The points are sorted.
Polygon make_hull(Polygon& points) {
  std::sort(points.begin(), points.end(),
            [](const Vector2d& a, const Vector2d& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  Polygon hull(points.get_allocator());
  const auto add = [&](const Vector2d& p, std::size_t first) {
    while (hull.size() >= first + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
      hull.pop_back();
    hull.push_back(p);
  };
  for (const Vector2d& p : points) add(p, 0);
  if (hull.size() < 2) return hull;
  hull.pop_back();
  const std::size_t upper = hull.size();
  for (auto p = points.rbegin(); p != points.rend(); ++p) add(*p, upper);
  hull.pop_back();
  return hull;
}

/// Part of a polygon on one side of the line a-b: the left for sign = 1, the right for -1.
Polygon clip(const Polygon& polygon, const Vector2d& a, const Vector2d& b, double sign) {
  Polygon part(polygon.get_allocator());
  const auto side = [&](const Vector2d& p) { return sign * cross(b - a, p - a); };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d &p = polygon[i], &q = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    const double at_p = side(p), at_q = side(q);
    if (at_p >= 0) part.push_back(p);
    if ((at_p > 0 && at_q < 0) || (at_p < 0 && at_q > 0)) part.push_back(p + (q - p) * (at_p / (at_p - at_q)));
  }
  return part;
}

bool are_apart(const Polygon& a, const Polygon& b) {
  for (int i = 0; i < 2; ++i) {
    const auto less = [i](const Vector2d& p, const Vector2d& q) { return p[i] < q[i]; };
    const auto [low_a, high_a] = std::minmax_element(a.begin(), a.end(), less);
    const auto [low_b, high_b] = std::minmax_element(b.begin(), b.end(), less);
    if ((*high_a)[i] <= (*low_b)[i] || (*high_b)[i] <= (*low_a)[i]) return true;
  }
  return false;
}

/// Adds the convex parts of a polygon that are outside of the hull.
void subtract(Polygon polygon, const Polygon& hull, std::pmr::vector<Polygon>& parts) {
  if (are_apart(polygon, hull)) {
    parts.push_back(std::move(polygon));
    return;
  }
  for (std::size_t i = 0; i < hull.size() && polygon.size() > 2; ++i) {
    const Vector2d &a = hull[i], &b = hull[i + 1 < hull.size() ? i + 1 : 0];
    Polygon outside = clip(polygon, a, b, -1);
    if (outside.size() > 2) parts.push_back(std::move(outside));
    polygon = clip(polygon, a, b, 1);
  }
}

}  // namespace

Shading::Shading(std::vector<ShadingBody> bodies, const Vector3d& sun_W) : bodies_(std::move(bodies)), sun_W_(sun_W) {
  const Vector3d across = sun_W_.unitOrthogonal();
  plane_.row(0) = across.transpose();
  plane_.row(1) = sun_W_.cross(across).transpose();
}

double Shading::calc_lit_share(const TreeData& data, const Place& middle,
                               const Eigen::Ref<const Eigen::Matrix3Xd>& corners_W, const Vector3d& area_W) const {
  const double facing = area_W.dot(sun_W_);
  if (facing == 0) return 1;
  std::array<std::byte, 32768> buffer;
  std::pmr::monotonic_buffer_resource memory(buffer.data(), buffer.size());
  Polygon face(&memory);
  for (Eigen::Index i = 0; i < corners_W.cols(); ++i) face.emplace_back(plane_ * corners_W.col(i));
  if (facing < 0) std::reverse(face.begin(), face.end());
  const double whole = calc_area(face);
  if (!(whole > 0)) return 1;
  std::pmr::vector<Polygon> lit(&memory), parts(&memory);
  lit.push_back(std::move(face));
  std::pmr::vector<std::pair<Vector2d, double>> corners(&memory);  // place, distance from the plane along the sun
  for (const ShadingBody& shading : bodies_) {
    const BodyState& s = data[shading.body].state;
    corners.clear();
    for (Eigen::Index i = 0; i < shading.corners_B.cols(); ++i) {
      const Vector3d r_W = s.calc_place(shading.corners_B.col(i)) - middle;
      corners.emplace_back(plane_ * r_W, area_W.dot(r_W) / facing);
    }
    Polygon points(&memory);
    for (const auto& [p, height] : corners) {
      if (height < 0) continue;
      points.push_back(p);
      for (const auto& [other, below] : corners)
        if (below < 0 && height > 0) points.emplace_back(p + (other - p) * (height / (height - below)));
    }
    const Polygon hull = make_hull(points);
    if (hull.size() < 3) continue;
    parts.clear();
    for (Polygon& polygon : lit) subtract(std::move(polygon), hull, parts);
    std::swap(lit, parts);
  }
  double seen = 0;
  for (const Polygon& polygon : lit) seen += calc_area(polygon);
  return std::clamp(seen / whole, 0.0, 1.0);
}

double Shading::calc_lit_share_of_disc(const TreeData& data, const Place& centre, const Vector3d& normal_W,
                                       double area) const {
  constexpr int kSides = 48;
  constexpr double kStep = 2 * std::numbers::pi / kSides;
  const double radius = std::sqrt(2 * area / (kSides * std::sin(kStep)));  // of the polygon with this area
  const Vector3d x = normal_W.unitOrthogonal(), y = normal_W.cross(x);
  Eigen::Matrix<double, 3, kSides> corners_W;
  for (int i = 0; i < kSides; ++i) corners_W.col(i) = radius * (std::cos(i * kStep) * x + std::sin(i * kStep) * y);
  return calc_lit_share(data, centre, corners_W, area * normal_W);
}

}  // namespace bough::solver
