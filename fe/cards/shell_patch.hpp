#pragma once
/// \file Patches of shells on which connectors end: projection of points, motion of points by the grids.
#include <map>
#include <optional>
#include <vector>

#include <unsupported/Eigen/BVH>

#include "fe/elements/element.hpp"

namespace bough::fe {

/// Surface of one shell: grids and their shape functions (surface_shape.hpp).
struct ShellFacet {
  int element = 0;         ///< id; 0: given by grids
  int property = 0;        ///< id, that of the copy at the element's temperature where there is one; 0: given by grids
  std::vector<int> nodes;  ///< indices, corners first
  int num_corners = 0;
  std::vector<char> has_midside;
  Matrix3Xd x;                          ///< of the nodes, basic
  Vector3d normal = Vector3d::UnitZ();  ///< at the centre of the corners
  Vector3d centre = Vector3d::Zero();
  double radius = 0;  ///< around the centre of the corners
};

/// Point of a facet: x = Σ N_i x_i.
struct FacetPoint {
  const ShellFacet* facet = nullptr;
  double r = 0, s = 0;
  Vector3d x = Vector3d::Zero(), normal = Vector3d::UnitZ();
  double distance = 0;  ///< [L] from the point that was projected
};

/// Nearest point of the facets at which the line to `p` is normal to the surface; nothing outside of all of them.
std::optional<FacetPoint> project(const std::vector<const ShellFacet*>& facets, const Vector3d& p);

/// Facets whose sphere is within the distance of p [L], in the order of the patch.
std::vector<const ShellFacet*> list_near(const std::vector<const ShellFacet*>& facets, const Vector3d& p,
                                         double distance);

/// Patch of many facets, in a tree of bounding boxes.
class FacetTree {
 public:
  /// The facets must outlive this; one at least.
  explicit FacetTree(std::vector<const ShellFacet*> facets);
  /// Facets of the patch by list_near().
  std::vector<const ShellFacet*> list_near(const Vector3d& p, double distance) const;
  /// The point of project() of all facets.
  std::optional<FacetPoint> project(const Vector3d& p) const;

 private:
  std::vector<const ShellFacet*> facets_;
  Eigen::KdBVH<double, 3, int> tree_;  ///< indices
  double max_radius_ = 0;
};

/// Motion of a point by nodes: 6 x 3 for the translations of each, basic axes.
using PointMotion = std::map<int, Eigen::Matrix<double, 6, 3>>;
/// Translations by the shape functions, rotations by their gradients: θ = ½ curl u with the normal of the surface
/// straight (Kirchhoff). Exact for rigid-body motion.
PointMotion calc_facet_motion(const FacetPoint& at);
/// Best fit (RBE3 with equal weights) of the translations of four points of the patch; about `at`. Exact for rigid-body
/// motion.
PointMotion fit_motion(const std::vector<FacetPoint>& points, const Vector3d& at);

}  // namespace bough::fe
