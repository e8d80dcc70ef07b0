#pragma once
/// \file Free hinge. q: quaternion of R_HpHc (x y z w), then p_HpHc in Hp; u: angular velocity of Hc in Hp, components
/// in Hc, then the rate of p_HpHc. H = [0 1; R_HpHc 0], bias 0. Springs: as spherical, then one per translation.
#include "solver/hinges/spherical.hpp"

namespace bough::solver {

class FreeHinge final : public SphericalHinge {
 public:
  /// Hinge with num_q = 7, num_u = 6.
  FreeHinge() : SphericalHinge(7, 6) {}
  void calc_position(const double* q, HingeMotion& motion) const override;
  bool is_constant_in_child() const override { return false; }
  void calc_q_dot(const double* q, const double* u, double* q_dot) const override;
  double calc_spring(const double* q, const double* q_null, const double* k, double* force) const override;
};

}  // namespace bough::solver
