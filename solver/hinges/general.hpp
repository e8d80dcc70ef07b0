#pragma once
/// \file Hinges put together from rotations and translations along the axes of Hp.
///
/// GeneralHinge. q: up to three angles, each about an axis x, y or z that the ones before it carry along, R_HpHc =
/// R_1(q1) R_2(q2) R_3(q3); then up to three travels along axes of Hp; u = q̇. A gimbal is one with three angles. With
/// a_i = R_1 .. R_{i-1} e_i: H = [0 e_t; a_i 0], bias = [0; Σ_{i<j} q̇_i q̇_j a_i × a_j].
/// OrientedHinge. q: quaternion (x y z w), then the travels; u: angular velocity of Hc in Hp, components in Hc, then
/// their rates. H = [0 e_t; R_HpHc 0], bias 0.
#include <string>

#include "solver/hinges/spherical.hpp"

namespace bough::solver {

class GeneralHinge final : public Hinge {
 public:
  /// Letters x, y, z; rotations: no two alike in a row; translations: none twice.
  GeneralHinge(const std::string& rotations, const std::string& translations);
  void calc_position(const double* q, HingeMotion& motion) const override;
  void calc_bias(const double* u, HingeMotion& motion) const override;

 private:
  std::string rotations_, translations_;
};

class OrientedHinge final : public SphericalHinge {
 public:
  /// \param translations  axes of Hp in the order of the travels, as "xz"; num_q = 4 and num_u = 3, plus one per
  /// travel.
  explicit OrientedHinge(const std::string& translations);
  void calc_position(const double* q, HingeMotion& motion) const override;
  bool is_constant_in_child() const override { return false; }
  void calc_q_dot(const double* q, const double* u, double* q_dot) const override;
  double calc_spring(const double* q, const double* q_null, const double* k, double* force) const override;

 private:
  int num_travels() const { return num_u() - 3; }
  std::string translations_;
};

}  // namespace bough::solver
