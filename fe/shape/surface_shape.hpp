#pragma once
/// \file Shape functions of curved triangles and quadrilaterals, any midside node absent.
#include <vector>

#include <Eigen/Dense>

namespace bough::fe {

/// Shape functions and their derivatives by (r, s) at one point of the square [-1, 1]² or of the triangle r, s >= 0,
/// r + s <= 1. Serendipity by hierarchy, as in solid_shape.hpp.
struct SurfaceShapes {
  Eigen::VectorXd corner;  ///< of the corners alone, (bi)linear
  Eigen::VectorXd all;     ///< of the corners, then of the midside nodes present
  Eigen::Matrix2Xd dall;
};

/// num_corners: 3 or 4. has_midside[k]: the node on side k -> k+1 is there (empty: none). Eight of them on four
/// corners: two on each side, at a third and at two thirds of it from corner k, as on a face of a cubic brick; all are
/// there.
SurfaceShapes calc_surface_shapes(int num_corners, const std::vector<char>& has_midside, double r, double s);

}  // namespace bough::fe
