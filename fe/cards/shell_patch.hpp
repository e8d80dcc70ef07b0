#pragma once
/// \file Patches of shells on which connectors end: projection of points, motion of points by the grids.
#include <map>
#include <optional>
#include <unordered_map>
#include <vector>

#include <unsupported/Eigen/BVH>

#include "fe/elements/connector.hpp"

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

using FacetList = std::vector<const ShellFacet*>;

/// Point of a facet: x = Σ N_i x_i.
struct FacetPoint {
  const ShellFacet* facet = nullptr;
  double r = 0, s = 0;
  Vector3d x = Vector3d::Zero(), normal = Vector3d::UnitZ();
  double distance = 0;  ///< [L] from the point that was projected
};

/// Nearest point of the facets at which the line to `p` is normal to the surface; nothing outside of all of them.
std::optional<FacetPoint> project(const FacetList& facets, const Vector3d& p);

/// Facets whose sphere is within the distance of p [L], in the order of the patch.
FacetList list_near(const FacetList& facets, const Vector3d& p, double distance);

/// Patch of many facets, in a tree of bounding boxes.
class FacetTree {
 public:
  /// The facets must outlive this; one at least.
  explicit FacetTree(FacetList facets);
  /// All facets of the patch.
  const FacetList& facets() const { return facets_; }
  /// Facets of the patch by list_near().
  FacetList list_near(const Vector3d& p, double distance) const;
  /// The point of project() of all facets.
  std::optional<FacetPoint> project(const Vector3d& p) const;

 private:
  FacetList facets_;
  Eigen::KdBVH<double, 3, int> tree_;  ///< indices
  double max_radius_ = 0;
};

/// Shells of a deck as facets, by element, property and grid.
class ShellFacets {
 public:
  ShellFacets(const records::Deck& deck, const NodeTable& nodes);
  ShellFacets(const ShellFacets&) = delete;
  ShellFacets& operator=(const ShellFacets&) = delete;

  /// Facet with these corners and midside grids (0: none); false without its grids.
  bool fill(ShellFacet& facet, const std::vector<int>& corners, const std::vector<int>& midsides) const;
  /// The facet of a shell, or nullptr.
  const ShellFacet* find_element(int id) const;
  /// Facets of a property of the deck, copies at temperatures included; nullptr without.
  const FacetTree* find_property(int pid);
  /// The shell and those that share a grid with it and continue it: no webs across it.
  FacetList list_around(const ShellFacet& facet) const;

 private:
  const NodeTable& nodes_;
  std::vector<ShellFacet> facets_;
  std::unordered_map<int, const ShellFacet*> by_element_;
  std::unordered_map<int, FacetList> by_property_, by_node_;
  std::unordered_map<int, FacetTree> trees_;  ///< by property, made when first named
};

/// End of a connector that follows four points as the reference grid of an RBE3 with equal weights follows its grids.
/// The points move by the translations of nodes, linearly at any amplitude. Basic axes.
struct PatchEnd {
  Vector3d x = Vector3d::Zero();          ///< place
  std::map<int, Eigen::Vector4d> shares;  ///< of each node in the four points; over all nodes they add up to 1
  Eigen::Matrix<double, 6, 12> motion;    ///< translations and rotation by the translations of the points
  PatchRotation rotation;
};

/// The point, its rotations by the gradients of the translations: θ = ½ curl u with the normal of the surface straight
/// (Kirchhoff). That is the fit of four points on its tangents. Exact for rigid-body motion.
PatchEnd follow_facet(const FacetPoint& at);
/// Best fit of four points of the patch, about `at`. Exact for rigid-body motion.
PatchEnd fit_points(const std::vector<FacetPoint>& points, const Vector3d& at);

}  // namespace bough::fe
