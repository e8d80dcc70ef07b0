#pragma once
/// \file Fixed hinge: Hc = Hp. No coordinates.
#include "solver/hinges/hinge.hpp"

namespace bough::solver {

class FixedHinge final : public Hinge {
 public:
  FixedHinge() : Hinge(0, 0) {}
  void calc_motion(const double*, const double*, HingeMotion&) const override {}
};

}  // namespace bough::solver
