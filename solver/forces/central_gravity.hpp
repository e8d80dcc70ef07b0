#pragma once
/// \file Gravity of a body with spherical layers, with the oblateness J2 if wanted, on extended and flexible bodies.
///
/// With R the mass centre of a body from the centre, P = ∫ρ x xᵀ about the mass centre, n = R/|R|:
///     V = -μ m/R - μ/(2R³) (3 nᵀPn - tr P) + μ m J2 a²/(2R³) (3 (n·k)² - 1)
/// of which every force is the exact derivative: on the mass centre, the gradient's torque 3μ/R³ n × Jn and, on
/// flexible bodies, the modes by ∂R/∂η = ∂S/∂η / m (second order included) and ∂P/∂η (first order in η). What varies
/// over the body beyond its second moments, and J2's own gradient, is left out.
#include "solver/forces/element.hpp"

namespace bough::solver {

class CentralGravity final : public ForceElement {
 public:
  struct Field {
    double mu = 0, j2 = 0, equator = 0;
    Vector3d centre = Vector3d::Zero(), axis = Vector3d::UnitZ();
  };
  struct Attracted {
    int body = 0;
    Matrix3d P0 = Matrix3d::Zero();  ///< ∫ρ r rᵀ about Bo, undeformed
    std::vector<Matrix3d> P1;        ///< per mode: its derivative
  };
  CentralGravity(std::string name, const Field& field, std::vector<Attracted> bodies)
      : ForceElement(std::move(name)), field_(field), bodies_(std::move(bodies)) {}

  ForceResult calc(const Tree& tree, const TreeData& data, Loads* loads) const override;

 private:
  Field field_;
  std::vector<Attracted> bodies_;
};

/// ½ tr(J) 1 - J: the second moment of mass that belongs to a tensor of inertia.
Matrix3d calc_second_moment(const Matrix3d& inertia);

}  // namespace bough::solver
