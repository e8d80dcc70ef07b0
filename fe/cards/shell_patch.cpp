#include "fe/cards/shell_patch.hpp"

#include <Eigen/LU>

#include "fe/corotational/mean_motion.hpp"
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

/// Motion of an end at `at` by points at `places`, as the mean of an RBE3 has it.
void fit(const Eigen::Matrix<double, 3, 4>& places, const Vector3d& at, PatchEnd& end) {
  WeightedMean mean;
  mean.centre = places.rowwise().mean();
  for (Eigen::Index k = 0; k < 4; ++k) mean.members.push_back({0, places.col(k) - mean.centre, 1, 0});
  const MeanMotion at_rest(mean, Matrix3Xd::Zero(3, 4), {});
  const Vector3d arm = at - mean.centre;
  const auto pick = [](Eigen::Index row) { return 6 * (row / 3) + row % 3; };  // translations of the members
  const MatrixXd A = at_rest.calc_tangent(arm);
  for (Eigen::Index j = 0; j < 12; ++j) end.motion.col(j) = A.col(pick(j));
  end.rotation.arm = arm;
  end.rotation.points = places.colwise() - mean.centre;
  for (int c = 0; c < 3; ++c) {
    const MatrixXd slope = at_rest.calc_slope(Vector3d::Zero(), Vector3d::Zero(), Vector3d::Unit(c));
    // A moment on the rotation vector in place of one fixed in space: the slope is symmetric.
    auto& form = end.rotation.forms[static_cast<std::size_t>(c)];
    for (Eigen::Index i = 0; i < 12; ++i)
      for (Eigen::Index j = 0; j < 12; ++j) form(i, j) = 0.5 * (slope(pick(i), pick(j)) + slope(pick(j), pick(i)));
  }
}

}  // namespace

std::optional<FacetPoint> project(const std::vector<const ShellFacet*>& facets, const Vector3d& p) {
  std::optional<FacetPoint> nearest;
  for (const auto* facet : facets) {
    if (nearest && (p - facet->centre).norm() - facet->radius > nearest->distance) continue;
    const auto found = project_on(*facet, p);
    if (found && (!nearest || found->distance < nearest->distance)) nearest = found;
  }
  return nearest;
}

PatchEnd follow_facet(const FacetPoint& at) {
  const auto& facet = *at.facet;
  const auto shapes = calc_shapes(facet, at.r, at.s);
  const Eigen::Matrix<double, 3, 2> tangents = facet.x * shapes.dall.transpose();
  const Vector3d n = at.normal, t1 = tangents.col(0).normalized(), t2 = n.cross(t1);
  Eigen::Matrix2d J;  // derivatives of the coordinates along t1 and t2 by r and s
  J << tangents.col(0).dot(t1), tangents.col(0).dot(t2), tangents.col(1).dot(t1), tangents.col(1).dot(t2);
  const Eigen::Matrix2Xd along = J.inverse() * shapes.dall;
  const double h = facet.radius;
  PatchEnd end;
  for (Eigen::Index i = 0; i < shapes.all.size(); ++i) {
    const double N = shapes.all[i], by_1 = h * along(0, i), by_2 = h * along(1, i);
    end.shares[facet.nodes[static_cast<std::size_t>(i)]] = {N + by_1, N + by_2, N - by_1, N - by_2};
  }
  Eigen::Matrix<double, 3, 4> places;
  places << h * t1, h * t2, -h * t1, -h * t2;
  fit(places, Vector3d::Zero(), end);
  end.x = at.x;
  return end;
}

PatchEnd fit_points(const std::vector<FacetPoint>& points, const Vector3d& at) {
  PatchEnd end;
  Eigen::Matrix<double, 3, 4> places;
  for (Eigen::Index k = 0; k < 4; ++k) {
    const FacetPoint& point = points[static_cast<std::size_t>(k)];
    places.col(k) = point.x;
    const auto shapes = calc_shapes(*point.facet, point.r, point.s);
    for (Eigen::Index i = 0; i < shapes.all.size(); ++i)
      end.shares.try_emplace(point.facet->nodes[static_cast<std::size_t>(i)], Eigen::Vector4d::Zero())
          .first->second[k] += shapes.all[i];
  }
  fit(places, at, end);
  end.x = at;
  return end;
}

}  // namespace bough::fe
