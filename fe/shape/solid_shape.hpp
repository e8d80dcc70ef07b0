#pragma once
/// \file Shape functions and quadrature of bricks, wedges, tetrahedra and pyramids with any of their midside nodes
/// absent.
///
/// Node order is Nastran's (CHEXA, CPENTA, CTETRA, CPYRAM). Serendipity by hierarchy: a midside node present on an edge
/// has its bump, and takes half of it from both corners (Zienkiewicz & Taylor, "The finite element method", vol.
/// 1, 8.5). The pyramid has the rational functions of Bedrosian, IJNME 35 (1992) 95-108, over |ξ|, |η| <= 1 - ζ with
/// the apex at ζ = 1: linear on its triangles, bilinear on its base, so that it joins bricks, wedges and tetrahedra.
#include <vector>

#include <Eigen/Dense>

namespace bough::fe {

enum class SolidKind { Hexa, Penta, Tetra, Pyramid };

struct SolidPoint {
  Eigen::Vector3d natural;
  double weight = 0;
};

/// Number of corners: 8, 6, 4 or 5.
int get_num_corners(SolidKind kind);
/// Edges as corner pairs, in the order of the midside nodes.
const std::vector<std::pair<int, int>>& get_edges(SolidKind kind);

/// Two nodes on each edge of a brick: 24 entries of midside, edge by edge, the node next to the edge's first corner
/// first (NASTRAN-95's IHEX3; Zienkiewicz & Taylor, cubic serendipity). None is absent.
inline bool is_cubic(const std::vector<int>& midside) { return midside.size() == 24; }

/// N (m) and dN/dξ (3 x m) at natural coordinates: m = corners plus the midside nodes present, in deck order.
/// midside[e]: 0-based position among the m nodes of the node on edge e, or -1.
void calc_solid_shape(SolidKind kind, const std::vector<int>& midside, const Eigen::Vector3d& natural,
                      Eigen::VectorXd& shape, Eigen::Matrix3Xd& dshape);

/// Natural coordinates of the m nodes, in deck order.
std::vector<Eigen::Vector3d> list_nodes(SolidKind kind, const std::vector<int>& midside);

/// Full integration of the stiffness, or of the mass when `mass` is true. `order` 2 or 3 sets the points of the
/// stiffness: 2³ or 3³ of a brick, 2 or 3 along the axis of a wedge with three in its triangle, or nine, seven with
/// midside nodes; 0: by the nodes. A pyramid has products of Gauss points of the collapsed cube, whatever `order`.
std::vector<SolidPoint> calc_solid_points(SolidKind kind, bool quadratic, bool mass, int order = 0);

}  // namespace bough::fe
