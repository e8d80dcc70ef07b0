#pragma once
/// \file Displacement field of a straight beam by the exact (flexibility) route: equilibrium gives the section forces,
/// the section compliance their deformations, integration the displacements. Exact for any taper, up to quadrature.
///
/// Local axes: x along the shear centres from end A to end B, y and z in the section. Displacements of a section are
/// [u v w θx θy θz] of its shear centre; section forces [N Vy Vz T My Mz] act on the face whose normal is +x, moments
/// about the shear centre; section deformations [ε γy γz κx κy κz]: γy = v' - θz, γz = w' + θy, κ = θ'.
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "fe/sections/beam_property.hpp"

namespace bough::fe {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Matrix6x12d = Eigen::Matrix<double, 6, 12>;
using Matrix12d = Eigen::Matrix<double, 12, 12>;

/// The four section stiffnesses that a deck may leave zero (as PBAR without I2 does).
struct ActiveForces {
  bool axial = true, torsion = true, plane1 = true, plane2 = true;
};

class BeamField {
 public:
  /// Computes the inverse flexibility of a beam of this length, along the breaks of a tapered one. `property` must
  /// outlive the field.
  BeamField(const BeamProperty& property, double length);

  /// 6 x 6 inverse flexibility: forces at B per displacement of B with A clamped. Rows and columns of a stiffness that
  /// the property lacks still hold a shape (unit) stiffness; mask() tells which.
  const Matrix6d& shape_stiffness() const { return G_; }
  /// Stiffnesses that the property has: axial, torsion, bending in either plane.
  ActiveForces active() const { return active_; }
  /// shape_stiffness() with zeros where the property has no stiffness.
  Matrix6d calc_stiffness() const;

  /// S (6 x 12): displacement of B relative to the rigid-body motion of A, for the nodal displacements [A; B].
  Matrix6x12d calc_relative() const;

  /// At x: displacement D (6 x 12) and section deformation e (6 x 12) per nodal displacement [A; B].
  void calc_shape(double x, Matrix6x12d* D, Matrix6x12d* e) const;

  /// [L] distance of the ends along x.
  double length() const { return length_; }
  /// Returns true if the section is constant along x.
  bool is_uniform() const { return uniform_; }
  /// Gauss points for integrals over the element (mass, geometric stiffness); absolute x, weights sum to L.
  struct Point {
    double x, weight;
  };
  /// Quadrature points: `num_uniform` for a uniform beam, else `num_tapered` in each interval between stations.
  std::vector<Point> calc_points(int num_uniform, int num_tapered) const;

  /// ∫ Dᵀ m D with the inertia of the sections, 12 x 12 in element axes, and the mass of the line.
  struct LineMass {
    Matrix12d M;
    double mass;
  };
  /// Integrates over calc_points(4, 7), or returns the kept matrix.
  LineMass calc_line_mass() const;

  /// Keeps the shapes at calc_points(3, 7) and calc_points(4, 7) and the mass, some 9 kB of a uniform beam;
  /// calc_shape() and calc_line_mass() then take them from there. For a field that many beams share. Nothing for a
  /// tapered one.
  void keep_shapes();

 private:
  struct Shape {
    Matrix6x12d D, e;
  };
  Matrix6d calc_compliance(double x) const;
  Matrix6d calc_flexibility(double x) const;
  const Shape* find_kept(double x) const;

  const BeamProperty& property_;
  double length_;
  bool uniform_;
  ActiveForces active_;
  Matrix6d G_;
  Matrix6x12d GS_;              ///< G S
  std::vector<double> breaks_;  ///< tapered: ends of the panels of the quadrature, 0 to length
  std::vector<std::pair<double, Shape>> kept_;
  std::optional<LineMass> kept_mass_;
};

/// Fields by property and length, to be shared by the beams that have them: most of the work on a small frame is in
/// them. The properties must outlive the fields.
class BeamFields {
 public:
  /// Returns the field, made at the first call; the first 512 are shared and keep their shapes.
  std::shared_ptr<const BeamField> find(std::shared_ptr<const BeamProperty> property, double length);

 private:
  std::map<std::pair<std::shared_ptr<const BeamProperty>, double>, std::shared_ptr<const BeamField>> fields_;
};

}  // namespace bough::fe
