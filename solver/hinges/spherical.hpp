#pragma once
/// \file Spherical hinge. q: unit quaternion of R_HpHc, x y z w; u: angular velocity of Hc in Hp, components in Hc.
/// H = [0; R_HpHc], bias 0 (d/dt (R w) = R ẇ). Springs: ½ θᵀ diag(k) θ with θ the rotation vector from the null
/// orientation, components in the null frame; τ = -T(θ)⁻¹ k θ, which is -kθ when the three k are equal.
#include "solver/hinges/hinge.hpp"

namespace bough::solver {

class SphericalHinge : public Hinge {
 public:
  /// Hinge with num_q = 4, num_u = 3.
  SphericalHinge() : SphericalHinge(4, 3) {}
  void calc_position(const double* q, HingeMotion& motion) const override;
  bool is_constant_in_child() const override { return true; }
  void calc_q_dot(const double* q, const double* u, double* q_dot) const override;
  void set_neutral(double* q) const override;
  void set_from_file(const double* file, double* q) const override;
  void get_for_file(const double* q, double* file) const override;
  double calc_spring(const double* q, const double* q_null, const double* k, double* force) const override;
  bool has_independent_coordinates() const override { return false; }

 protected:
  SphericalHinge(int num_q, int num_u) : Hinge(num_q, num_u) {}
};

}  // namespace bough::solver
