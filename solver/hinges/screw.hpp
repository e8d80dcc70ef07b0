#pragma once
/// \file Screw. q: angle about `axis` (unit, the same in Hp and Hc), which advances by `pitch` per radian along it;
/// u = q̇. H = [pitch axis; axis], bias 0.
#include "solver/hinges/hinge.hpp"

namespace bough::solver {

class ScrewHinge final : public Hinge {
 public:
  /// \param unit_axis  in Hp and Hc. \param pitch  [L] travel per radian.
  ScrewHinge(const Vector3d& unit_axis, double pitch) : Hinge(1, 1), axis_(unit_axis), pitch_(pitch) {}
  void calc_position(const double* q, HingeMotion& motion) const override;
  bool is_constant_in_child() const override { return true; }

 private:
  Vector3d axis_;
  double pitch_;
};

}  // namespace bough::solver
