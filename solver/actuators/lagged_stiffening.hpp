#pragma once
/// \file The stiffening of the step before, as the report has it (docs/theory/control.md, "Lagged stiffening").
#include "solver/motion/stiffening_terms.hpp"
#include "solver/signals/block.hpp"

namespace bough::solver {

/// Outputs: A_I, then force and moment of each source, in B. Load: -(Σ K_G1 A_I + Σ K_G2 FCONI) η on the modes.
class LaggedStiffening final : public Block {
 public:
  int body = 0, n = 0;
  StiffeningTerms terms;

  bool is_actuator() const override { return true; }
  void calc_outputs(const BlockInput& in, double* y) const override;
  void add_load(const BlockInput& in, const double* y, TreeData& data) const override;
};

}  // namespace bough::solver
