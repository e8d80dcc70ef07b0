#pragma once
/// \file Cylindrical hinge. q: angle about, then travel along `axis` (unit, the same in Hp and Hc); u = q̇.
/// H = [0 axis; axis 0], bias 0.
#include "solver/hinges/hinge.hpp"

namespace bough::solver {

class CylindricalHinge final : public Hinge {
 public:
  /// \param unit_axis  in Hp and Hc.
  explicit CylindricalHinge(const Vector3d& unit_axis) : Hinge(2, 2), axis_(unit_axis) {}
  void calc_position(const double* q, HingeMotion& motion) const override;
  bool is_constant_in_child() const override { return true; }

 private:
  Vector3d axis_;
};

}  // namespace bough::solver
