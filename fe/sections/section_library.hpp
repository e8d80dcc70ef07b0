#pragma once
/// \file Section properties of the shapes of PBARL and PBEAML from their dimensions. Sources:
/// docs/elements/sections.md.
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace bough::fe {

/// Corners (y, z) of a convex polygon.
using SectionFace = std::vector<Eigen::Vector2d>;

/// Element axes: y is plane 1 (up in the manuals' figures), z is plane 2 (to the right seen from B to A: figures draw z
/// to the left). I's about the centroid; n: centroid from the shear centre, (y, z).
struct LibrarySection {
  double A = 0, I1 = 0, I2 = 0, I12 = 0, J = 0;
  double k1 = 0, k2 = 0;
  Eigen::Vector2d n = Eigen::Vector2d::Zero();
  /// Where stresses are given, from the centroid: the corners of the convex hull, where bending is largest; of round
  /// sections the ends of both axes.
  std::vector<Eigen::Vector2d> points;
  /// Polygons that cover the section without overlap, from the centroid; circles have kRoundSides sides.
  std::vector<SectionFace> faces;
};

inline constexpr int kRoundSides = 16;

/// Every shape name known, sorted.
std::vector<std::string> list_section_shapes();
/// Properties, or an empty optional with the reason in *problem (unknown shape, wrong count, dimensions that do not
/// fit).
std::optional<LibrarySection> calc_library_section(const std::string& shape, const std::vector<double>& dims,
                                                   std::string* problem);

/// Plain shape for a section of which only A, I and J are given (PBAR, PBEAM, PROD): for pictures, not for stress.
struct EquivalentSection {
  /// Rectangle: sides along the principal axes; a solid one with the radii of gyration of the section. Ring: I1 = I2
  /// and J = I1 + I2. Circle: of the area alone.
  enum class Kind { Rectangle, Ring, Circle };
  Kind kind = Kind::Circle;
  double d1 = 0, d2 = 0;  ///< [L] height and width; outer and inner diameter; diameter and 0
  double angle = 0;       ///< [rad] of the side d1 from y towards z
};

/// A [L^2]; I1, I2, I12, J [L^4]. Empty: no area. With no I1 or I2 a circle of the area.
std::optional<EquivalentSection> find_equivalent_section(double A, double I1, double I2, double I12, double J);

/// Polygons (y, z) from the centroid.
std::vector<SectionFace> list_faces(const EquivalentSection& section);

}  // namespace bough::fe
