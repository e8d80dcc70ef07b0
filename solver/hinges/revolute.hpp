#pragma once
/// \file Revolute hinge. q: angle about `axis` (unit, the same in Hp and Hc); u = q̇. H = [0; axis], bias 0.
#include "solver/hinges/hinge.hpp"

namespace bough::solver {

class RevoluteHinge final : public Hinge {
 public:
  /// \param unit_axis  in Hp and Hc; the angle is positive by the right-hand rule.
  explicit RevoluteHinge(const Vector3d& unit_axis) : Hinge(1, 1), axis_(unit_axis) {}
  void calc_position(const double* q, HingeMotion& motion) const override;
  bool is_constant_in_child() const override { return true; }

 private:
  Vector3d axis_;
};

}  // namespace bough::solver
