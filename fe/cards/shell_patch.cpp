#include "fe/cards/shell_patch.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/LU>

#include "fe/corotational/mean_motion.hpp"
#include "fe/shape/surface_shape.hpp"

namespace bough::fe {
namespace {

/// Beyond a side by this share of it a point counts as inside: neighbours leave no gap.
constexpr double kInside = 1e-6;
constexpr int kMaxIterations = 50;
/// Cosine between the normals of a shell and of one that continues it.
constexpr double kContinues = 0.7;

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

bool is_near(const ShellFacet& facet, const Vector3d& p, double distance) {
  return (p - facet.centre).norm() <= facet.radius + distance;
}

/// Collects the facets whose sphere is within a distance of a point, for Eigen::BVIntersect.
struct NearFacets {
  const FacetList& facets;
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

ShellFacets::ShellFacets(const records::Deck& deck, const NodeTable& nodes) : nodes_(nodes) {
  std::vector<int> properties;
  for (const auto& shell : deck.shells) {
    ShellFacet facet;
    facet.element = shell.id;
    facet.property = shell.pid;
    if (!fill(facet, shell.grids, shell.midsides)) continue;
    facets_.push_back(std::move(facet));
    const auto& evaluated = deck.temperatures.properties;
    const auto of_deck = evaluated.find(shell.pid);
    properties.push_back(of_deck == evaluated.end() ? shell.pid : of_deck->second);
  }
  for (std::size_t i = 0; i < facets_.size(); ++i) {
    const auto* facet = &facets_[i];
    by_element_[facet->element] = facet;
    by_property_[properties[i]].push_back(facet);
    for (int k = 0; k < facet->num_corners; ++k) by_node_[facet->nodes[static_cast<std::size_t>(k)]].push_back(facet);
  }
}

bool ShellFacets::fill(ShellFacet& facet, const std::vector<int>& corners, const std::vector<int>& midsides) const {
  facet.num_corners = static_cast<int>(corners.size());
  for (const int g : corners) facet.nodes.push_back(nodes_.find_node(g));
  for (const int g : midsides) {
    facet.has_midside.push_back(g > 0);
    if (g > 0) facet.nodes.push_back(nodes_.find_node(g));
  }
  facet.x.resize(3, static_cast<Eigen::Index>(facet.nodes.size()));
  for (std::size_t i = 0; i < facet.nodes.size(); ++i) {
    if (facet.nodes[i] < 0 || nodes_.node(facet.nodes[i]).num_dofs != 6) return false;
    facet.x.col(static_cast<Eigen::Index>(i)) = nodes_.node(facet.nodes[i]).x;
  }
  facet.centre = facet.x.leftCols(facet.num_corners).rowwise().mean();
  const auto side = [&](int a, int b) { return Vector3d(facet.x.col(b) - facet.x.col(a)); };
  facet.normal = side(0, 2).cross(facet.num_corners == 4 ? side(1, 3) : side(0, 1)).normalized();
  facet.radius = (facet.x.colwise() - facet.centre).colwise().norm().maxCoeff();
  return true;
}

const ShellFacet* ShellFacets::find_element(int id) const {
  const auto found = by_element_.find(id);
  return found == by_element_.end() ? nullptr : found->second;
}

const FacetTree* ShellFacets::find_property(int pid) {
  const auto made = trees_.find(pid);
  if (made != trees_.end()) return &made->second;
  const auto found = by_property_.find(pid);
  return found == by_property_.end() ? nullptr : &trees_.emplace(pid, FacetTree(found->second)).first->second;
}

FacetList ShellFacets::list_around(const ShellFacet& facet) const {
  std::set<int> seen{facet.element};
  FacetList list{&facet};
  for (int k = 0; k < facet.num_corners; ++k)
    for (const auto* other : by_node_.at(facet.nodes[static_cast<std::size_t>(k)]))
      if (seen.insert(other->element).second && std::abs(other->normal.dot(facet.normal)) > kContinues)
        list.push_back(other);
  return list;
}

FacetList list_near(const FacetList& facets, const Vector3d& p, double distance) {
  FacetList list;
  for (const auto* facet : facets)
    if (is_near(*facet, p, distance)) list.push_back(facet);
  return list;
}

FacetTree::FacetTree(FacetList facets) : facets_(std::move(facets)) {
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

FacetList FacetTree::list_near(const Vector3d& p, double distance) const {
  NearFacets near{facets_, p, distance};
  Eigen::BVIntersect(tree_, near);
  std::sort(near.found.begin(), near.found.end());
  FacetList list;
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

std::optional<FacetPoint> project(const FacetList& facets, const Vector3d& p) {
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
