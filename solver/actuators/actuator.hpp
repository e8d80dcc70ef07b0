#pragma once
/// \file [[actuator]] of a system file as blocks: a command in, a force on the bodies out (docs/theory/control.md).
#include <memory>

#include "formats/records/system_spec.hpp"
#include "solver/signals/block.hpp"
#include "solver/system/system.hpp"
#include "solver/text/settings.hpp"
#include "solver/tree/tree.hpp"

namespace bough::solver {

/// What becomes of a command before it acts: scale and bias, dead band, limits, then a lag whose rate may be limited.
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
  /// The first slot of laws (evaluate_law) of a kind of actuator; those before are of the shaping.
  int law_slot() const { return 2 * sizes.inputs; }
  int num_lags() const { return lag_ > 0 ? sizes.inputs : 0; }

 private:
  /// Of the command i.
  double shape(const BlockInput& in, int i) const;
  double scale_ = 1, bias_ = 0, deadband_ = 0, low_ = 0, high_ = 0, lag_ = 0, rate_ = 0, initial_ = 0;
  bool is_steady_ = false;
};

/// Outputs by type; 0: unknown type.
int find_actuator_outputs(const std::string& type);

/// Types: hinge motor brake force moment jet wheel cmg double_gimbal_cmg modal. Adds the marker it acts at to the tree.
/// Reports "control.*" and what find_loaded_node does; nullptr on errors.
std::unique_ptr<Block> make_actuator(const records::ActuatorRecord& record, const System& system, Tree& tree,
                                     Diagnostics& diagnostics);

}  // namespace bough::solver
