#pragma once
/// \file Universal hinge. q: angle 1 about `axis` fixed in Hp, then angle 2 about `axis2`, which turns with the first
/// (in Hp at q = 0); R_HpHc = exp(q1 axis) exp(q2 axis2); u = q̇.
/// H = [0 0; axis, R1 axis2], bias = [0; q̇1 q̇2 axis × R1 axis2]. The axes may not be parallel.
#include "solver/hinges/hinge.hpp"

namespace bough::solver {

class UniversalHinge final : public Hinge {
 public:
  /// \param unit_axis  in Hp. \param unit_axis2  in Hp at q = 0; not parallel to the first.
  UniversalHinge(const Vector3d& unit_axis, const Vector3d& unit_axis2)
      : Hinge(2, 2), axis_(unit_axis), axis2_(unit_axis2) {}
  void calc_position(const double* q, HingeMotion& motion) const override;
  void calc_bias(const double* u, HingeMotion& motion) const override;

 private:
  Vector3d axis_, axis2_;
};

}  // namespace bough::solver
