#pragma once
/// \file Thin-walled section of straight walls, open or with any number of cells: shear centre, shear factors, torsion.
#include <vector>

#include <Eigen/Dense>

namespace bough::fe {

/// A wall along its midline; walls that share an end point are joined there.
struct Wall {
  Eigen::Vector2d a, b;  ///< (y, z)
  double t;
};

struct ThinWallResult {
  Eigen::Vector2d shear_center;               ///< (y, z), in the axes of the walls
  double shear_area_1 = 0, shear_area_2 = 0;  ///< V² / ∫ q²/t ds for V along y, z
  double J = 0;
};

/// Shear flow of the flexure formula (with I12) in every wall, the cell flows by least complementary energy:
/// Vlasov, Thin-Walled Elastic Beams (1961); Pilkey, Analysis and Design of Elastic Beams (2002) ch. 6-7. J: Bredt for
/// the cells, Σ b t³/3 for walls outside any cell.
ThinWallResult calc_thin_wall(const std::vector<Wall>& walls);

}  // namespace bough::fe
