#pragma once
/// \file Planar hinge. q: travel along e1, travel along e2 (in the plane, fixed in Hp), then the angle about the unit
/// normal n; u = q̇. e1 is Hp's x made perpendicular to n (Hp's z when n is along x), e2 = n × e1; for n = z they are
/// x and y. H = [e1 e2 0; 0 0 n], bias 0.
#include "solver/hinges/hinge.hpp"

namespace bough::solver {

class PlanarHinge final : public Hinge {
 public:
  /// \param unit_normal  n, in Hp and Hc.
  explicit PlanarHinge(const Vector3d& unit_normal);
  void calc_position(const double* q, HingeMotion& motion) const override;

 private:
  Vector3d normal_, e1_, e2_;
};

}  // namespace bough::solver
