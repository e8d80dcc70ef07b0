#include "fe/cards/shell_patch.hpp"

#include <algorithm>

#include <Eigen/LU>

#include "base/rotation.hpp"
#include "fe/shape/surface_shape.hpp"

namespace bough::fe {
namespace {

/// Beyond a side by this share of it a point counts as inside: neighbours leave no gap.
constexpr double kInside = 1e-6;
constexpr int kMaxIterations = 50;

SurfaceShapes calc_shapes(const ShellFacet& facet, double r, double s) {
  return calc_surface_shapes(facet.num_corners, facet.has_midside, r, s);
}

bool is_inside(const ShellFacet& facet, double r, double s) {
  if (facet.num_corners == 3) return r >= -kInside && s >= -kInside && r + s <= 1 + kInside;
  return std::abs(r) <= 1 + kInside && std::abs(s) <= 1 + kInside;
}

/// Gauss-Newton for the nearest point.
std::optional<FacetPoint> project_on(const ShellFacet& facet, const Vector3d& p) {
  FacetPoint at;
  at.facet = &facet;
  at.r = at.s = facet.num_corners == 3 ? 1.0 / 3 : 0;
  for (int i = 0; i < kMaxIterations; ++i) {
    const auto shapes = calc_shapes(facet, at.r, at.s);
    at.x = facet.x * shapes.all;
    const Eigen::Matrix<double, 3, 2> tangents = facet.x * shapes.dall.transpose();
    const Eigen::Vector2d step = (tangents.transpose() * tangents).inverse() * (tangents.transpose() * (p - at.x));
    at.normal = tangents.col(0).cross(tangents.col(1)).normalized();
    at.r += step[0];
    at.s += step[1];
    if (!(std::abs(at.r) < 10 && std::abs(at.s) < 10)) return std::nullopt;
    if (step.norm() < 1e-13) break;
  }
  if (!is_inside(facet, at.r, at.s)) return std::nullopt;
  at.x = facet.x * calc_shapes(facet, at.r, at.s).all;
  at.distance = (p - at.x).norm();
  return at;
}

bool is_near(const ShellFacet& facet, const Vector3d& p, double distance) {
  return (p - facet.centre).norm() <= facet.radius + distance;
}

/// Collects the facets whose sphere is within a distance of a point, for Eigen::BVIntersect.
struct NearFacets {
  const std::vector<const ShellFacet*>& facets;
  const Vector3d& p;
  double distance = 0;
  std::vector<int> found = {};

  bool intersectVolume(const Eigen::AlignedBox3d& box) const { return box.exteriorDistance(p) <= distance; }
  bool intersectObject(int i) {
    if (is_near(*facets[static_cast<std::size_t>(i)], p, distance)) found.push_back(i);
    return false;  // goes on
  }
};

}  // namespace

std::vector<const ShellFacet*> list_near(const std::vector<const ShellFacet*>& facets, const Vector3d& p,
                                         double distance) {
  std::vector<const ShellFacet*> list;
  for (const auto* facet : facets)
    if (is_near(*facet, p, distance)) list.push_back(facet);
  return list;
}

FacetTree::FacetTree(std::vector<const ShellFacet*> facets) : facets_(std::move(facets)) {
  std::vector<int> indices;
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const auto* facet : facets_) {
    indices.push_back(static_cast<int>(indices.size()));
    const Vector3d half = Vector3d::Constant(facet->radius);
    boxes.emplace_back(facet->centre - half, facet->centre + half);
    max_radius_ = std::max(max_radius_, facet->radius);
  }
  tree_.init(indices.begin(), indices.end(), boxes.begin(), boxes.end());
}

std::vector<const ShellFacet*> FacetTree::list_near(const Vector3d& p, double distance) const {
  NearFacets near{facets_, p, distance};
  Eigen::BVIntersect(tree_, near);
  std::sort(near.found.begin(), near.found.end());
  std::vector<const ShellFacet*> list;
  for (const int i : near.found) list.push_back(facets_[static_cast<std::size_t>(i)]);
  return list;
}

std::optional<FacetPoint> FacetTree::project(const Vector3d& p) const {
  for (double distance = max_radius_;; distance *= 2) {
    const auto near = list_near(p, distance);
    const auto found = fe::project(near, p);
    // A facet that is not in the list is farther.
    if ((found && found->distance <= distance) || near.size() == facets_.size()) return found;
  }
}

std::optional<FacetPoint> project(const std::vector<const ShellFacet*>& facets, const Vector3d& p) {
  std::optional<FacetPoint> nearest;
  for (const auto* facet : facets) {
    if (nearest && (p - facet->centre).norm() - facet->radius > nearest->distance) continue;
    const auto found = project_on(*facet, p);
    if (found && (!nearest || found->distance < nearest->distance)) nearest = found;
  }
  return nearest;
}

PointMotion calc_facet_motion(const FacetPoint& at) {
  const auto& facet = *at.facet;
  const auto shapes = calc_shapes(facet, at.r, at.s);
  const Eigen::Matrix<double, 3, 2> tangents = facet.x * shapes.dall.transpose();
  const Vector3d n = at.normal, t1 = tangents.col(0).normalized(), t2 = n.cross(t1);
  Eigen::Matrix2d J;  // derivatives of the coordinates along t1 and t2 by r and s
  J << tangents.col(0).dot(t1), tangents.col(0).dot(t2), tangents.col(1).dot(t1), tangents.col(1).dot(t2);
  const Eigen::Matrix2Xd along = J.inverse() * shapes.dall;
  PointMotion motion;
  for (Eigen::Index i = 0; i < shapes.all.size(); ++i) {
    Eigen::Matrix<double, 6, 3> block;
    block.topRows<3>() = shapes.all[i] * Matrix3d::Identity();
    block.bottomRows<3>() = t1 * (along(1, i) * n.transpose()) - t2 * (along(0, i) * n.transpose()) +
                            0.5 * n * (along(0, i) * t2.transpose() - along(1, i) * t1.transpose());
    motion[facet.nodes[static_cast<std::size_t>(i)]] = block;
  }
  return motion;
}

PointMotion fit_motion(const std::vector<FacetPoint>& points, const Vector3d& at) {
  using Map = Eigen::Matrix<double, 3, 6>;
  // Rotations by a length, so that the normal matrix has one dimension.
  double size = 0;
  for (const auto& p : points) size = std::max(size, (p.x - at).norm());
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  std::vector<Map> maps;
  for (const auto& p : points) {
    Map map;
    map << Matrix3d::Identity(), -skew(Vector3d((p.x - at) / size));
    maps.push_back(map);
    sum += map.transpose() * map;
  }
  Eigen::Matrix<double, 6, 6> fit = sum.inverse();
  fit.bottomRows<3>() /= size;
  PointMotion motion;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto& facet = *points[k].facet;
    const auto shapes = calc_shapes(facet, points[k].r, points[k].s);
    const Eigen::Matrix<double, 6, 3> of_point = fit * maps[k].transpose();
    for (Eigen::Index i = 0; i < shapes.all.size(); ++i) {
      const auto slot =
          motion.try_emplace(facet.nodes[static_cast<std::size_t>(i)], Eigen::Matrix<double, 6, 3>::Zero());
      slot.first->second += shapes.all[i] * of_point;
    }
  }
  return motion;
}

}  // namespace bough::fe
