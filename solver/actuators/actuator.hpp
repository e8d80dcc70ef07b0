#pragma once
/// \file Base of all actuators: a command in, a force on the bodies out (docs/theory/control.md).
#include <memory>

#include "formats/records/system_spec.hpp"
#include "solver/signals/block.hpp"
#include "solver/text/settings.hpp"
#include "solver/tree/tree.hpp"

namespace bough::solver {

/// Conditions a command before it acts: scale and bias, dead band, limits, then a lag whose rate may be limited.
class Actuator : public Block {
 public:
  bool is_actuator() const override { return true; }
  void start(double* z, double* d) const override;
  bool settle(const BlockInput& in, double* z) const override;
  void calc_rates(const BlockInput& in, double* z_dot) const override;
  /// Reads scale, bias, deadband, lower, upper, lag, initial, rate_limit, the same for each of `commands`; the lags'
  /// states are the first.
  void read_shaping(SettingsReader& keys, int commands = 1);

 protected:
  double calc_command(const BlockInput& in, int i = 0) const;
  /// The first slot of functions (evaluate_law) of a kind of actuator; those before are of the shaping.
  int law_slot() const { return 2 * sizes.inputs; }
  int num_lags() const { return lag_ > 0 ? sizes.inputs : 0; }

 private:
  /// Command i after scale, bias, dead band and limits.
  double shape(const BlockInput& in, int i) const;
  double scale_ = 1, bias_ = 0, deadband_ = 0, low_ = 0, high_ = 0, lag_ = 0, rate_ = 0, initial_ = 0;
  bool is_steady_ = false;
};

}  // namespace bough::solver
