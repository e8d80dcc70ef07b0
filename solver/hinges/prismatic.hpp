#pragma once
/// \file Prismatic hinge. q: travel along `axis` (unit, in Hp); u = q̇. H = [axis; 0], bias 0.
#include "solver/hinges/hinge.hpp"

namespace bough::solver {

class PrismaticHinge final : public Hinge {
 public:
  /// \param unit_axis  in Hp.
  explicit PrismaticHinge(const Vector3d& unit_axis) : Hinge(1, 1), axis_(unit_axis) {}
  void calc_position(const double* q, HingeMotion& motion) const override;
  bool is_constant_in_child() const override { return true; }

 private:
  Vector3d axis_;
};

}  // namespace bough::solver
