#pragma once
/// \file Gravity of a body with spherical layers, with the oblateness J2 if wanted, on extended and flexible bodies.
///
/// With R the centre of mass of a body from the centre of the field, P = ∫ρ x xᵀ about the centre of mass, n = R/|R|:
///     V = -μ m/R - μ/(2R³) (3 nᵀPn - tr P) + μ m J2 a²/(2R³) (3 (n·k)² - 1)
/// All loads are the gradient of V: the force at the centre of mass, the torque 3μ/R³ n × Jn and the modal forces, by
/// S(η) and P(η) to second order in η as in M(η). V depends on neither the origin nor the axes of B. Not in V: third
/// moments of mass and the gradient of the J2 term.
#include "solver/forces/element.hpp"

namespace bough::solver {

/// Gravity on the mass of one body: the affine field g(r) = g + gradient·r, r from Bo; in B; L/T², 1/T².
struct BodyGravity {
  Vector3d g = Vector3d::Zero();
  Matrix3d gradient = Matrix3d::Zero();  ///< symmetric
};

class CentralGravity final : public ForceElement {
 public:
  struct Field {
    double mu = 0, j2 = 0, equator = 0;
    Vector3d centre = Vector3d::Zero(), axis = Vector3d::UnitZ();
    Vector3d dipole = Vector3d::Zero();  ///< of the magnetic field, μ0/4π times its moment; in W
  };
  /// \param bodies  tree indices of the bodies that the field acts on.
  CentralGravity(std::string name, const Field& field, std::vector<int> bodies)
      : ForceElement(std::move(name)), field_(field), bodies_(std::move(bodies)) {}

  ForceResult calc(const Tree& tree, const TreeData& data, Loads* loads) const override;

  /// Returns true if the field acts on this body.
  bool attracts(int body) const;
  /// Acceleration of a free particle at p; in W.
  Vector3d calc_acceleration(const Vector3d& p_W) const;
  /// Magnetic field of the dipole d at p, in W: (3 d·n n - d)/R³.
  Vector3d calc_magnetic_field(const Vector3d& p_W) const;
  /// Constants of the field.
  const Field& field() const { return field_; }
  /// The affine field whose loads calc() puts on a body with mass. After calc_position.
  BodyGravity calc_on_body(const TreeData& data, int body) const;
  /// ∂V/∂m of a body whose content changes as `by` does. After calc_position.
  double calc_potential_rate(const BodyData& d, const TankContent& by) const;

 private:
  struct Pull;
  Pull calc_pull(const BodyData& d) const;

  Field field_;
  std::vector<int> bodies_;
};

/// ½ tr(J) 1 - J: the second moment of mass that belongs to a tensor of inertia.
Matrix3d calc_second_moment(const Matrix3d& inertia);

}  // namespace bough::solver
