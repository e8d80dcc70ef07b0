#pragma once
/// \file Mass properties of the propellant in one tank, as functions of its mass (docs/theory/forces.md).
///
/// All about the body origin Bo, in B: mass m, first moment S = ∫ρ r, inertia J = ∫ρ (r·r 1 - r rᵀ), and their
/// derivatives with respect to m. The derivatives are those of the mass that is removed: for a tank that drains they
/// are S' = r and J' = r·r 1 - r rᵀ of the free surface, averaged over it.
#include <memory>
#include <vector>

#include "solver/bodies/spatial.hpp"

namespace bough::solver {

/// Mass properties of a tank's content and their derivatives with respect to its mass. In B, about Bo.
struct TankContent {
  double mass = 0;
  Vector3d S = Vector3d::Zero(), S_m = Vector3d::Zero();  ///< M L; L
  Matrix3d J = Matrix3d::Zero(), J_m = Matrix3d::Zero();  ///< M L²; L²
};

class TankShape {
 public:
  virtual ~TankShape() = default;
  /// Mass of the full tank; infinite if nothing bounds it.
  virtual double capacity() const = 0;
  /// \param mass  0 to capacity. No allocation.
  virtual TankContent calc(double mass) const = 0;
};

/// A body of revolution about `axis` (unit), in B; `position` is the centre of the bottom, of a sphere its centre. The
/// content moves with the body as if it were rigid.
struct TankAxis {
  Vector3d position = Vector3d::Zero(), axis = Vector3d::UnitZ();
};

/// A liquid settled at the bottom of a cylinder.
std::unique_ptr<const TankShape> make_cylinder_tank(const TankAxis& place, double radius, double height,
                                                    double density);
/// A liquid settled at the bottom (the side -axis) of a sphere.
std::unique_ptr<const TankShape> make_sphere_tank(const TankAxis& place, double radius, double density);
/// A solid grain between `bore` and `radius` when full, of length `height`, that burns from the bore outwards.
std::unique_ptr<const TankShape> make_grain(const TankAxis& place, double radius, double bore, double height,
                                            double density);

/// Rows of a table: centre of mass and inertia about it, linear in mass between rows, constant outside.
struct TankTable {
  std::vector<double> mass;  ///< ascending
  std::vector<Vector3d> cg;
  std::vector<Matrix3d> inertia;
};
/// \param whole  if it has mass, the table is of body and content together, and `whole` is the body without content.
std::unique_ptr<const TankShape> make_tank_table(const TankTable& table, const TankContent& whole);

/// A tank without a point mass, which is a separate body.
std::unique_ptr<const TankShape> make_tank_without(std::shared_ptr<const TankShape> tank, double point_mass,
                                                   const Vector3d& position);

}  // namespace bough::solver
