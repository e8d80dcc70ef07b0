#pragma once
/// \file Fixed hinge: Hc = Hp. No coordinates.
#include "solver/hinges/hinge.hpp"

namespace bough::solver {

class FixedHinge final : public Hinge {
 public:
  /// Hinge with num_q = num_u = 0.
  FixedHinge() : Hinge(0, 0) {}
  void calc_position(const double*, HingeMotion&) const override {}
  bool is_constant_in_child() const override { return true; }
};

}  // namespace bough::solver
