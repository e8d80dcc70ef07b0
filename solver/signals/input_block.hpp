#pragma once
/// \file [[input]]: a signal that is set from outside while the system moves (docs/formats/system-toml.md).
#include "formats/records/control_spec.hpp"
#include "solver/signals/block.hpp"

namespace bough::solver {

/// Its discrete state is a line from `value` at `from` to `next` at `until`, constant before and after. For a held
/// value both are equal.
class InputBlock final : public Block {
 public:
  enum Row { kFrom, kValue, kUntil, kNext, kNumRows };

  explicit InputBlock(const records::InputRecord& record);
  void start(double* z, double* d) const override;
  void calc_outputs(const BlockInput& in, double* y) const override { y[0] = calc_value(in.t, in.d); }
  bool depends_on_time() const override { return is_linear_; }

  /// Returns true if a new value is reached at the next time that is asked for, not at once.
  bool is_linear() const { return is_linear_; }
  /// Value at the start of a run.
  double start_value() const { return start_; }
  /// Value at t of the memory rows d: held, or on the line to the next value.
  static double calc_value(double t, const double* d);

 private:
  double start_;
  bool is_linear_;
};

}  // namespace bough::solver
