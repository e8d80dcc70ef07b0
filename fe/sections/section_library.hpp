#pragma once
/// \file Section properties of the shapes of PBARL and PBEAML from their dimensions. Sources:
/// docs/elements/sections.md.
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace bough::fe {

/// Element axes: y is plane 1 (up in the manuals' figures), z is plane 2 (to the right seen from B to A: figures draw z
/// to the left). I's about the centroid; n: centroid from the shear centre, (y, z).
struct LibrarySection {
  double A = 0, I1 = 0, I2 = 0, I12 = 0, J = 0;
  double k1 = 0, k2 = 0;
  Eigen::Vector2d n = Eigen::Vector2d::Zero();
  /// Where stresses are given, from the centroid: the corners of the convex hull, where bending is largest; of round
  /// sections the ends of both axes.
  std::vector<Eigen::Vector2d> points;
};

/// Every shape name known, sorted.
std::vector<std::string> list_section_shapes();
/// Properties, or an empty optional with the reason in *problem (unknown shape, wrong count, dimensions that do not
/// fit).
std::optional<LibrarySection> calc_library_section(const std::string& shape, const std::vector<double>& dims,
                                                   std::string* problem);

}  // namespace bough::fe
