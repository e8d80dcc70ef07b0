#pragma once
/// \file Actions of events on the system: hinges locked and released, constraints opened and closed, controllers
/// enabled, disabled and switched.
#include "solver/simulate/hybrid_system.hpp"

namespace bough::solver {

class EventActions {
 public:
  /// Actions by event. Reports "run.unknown-target" and "run.bad-event". If `system_is_valid` is false, targets may be
  /// missing because of errors reported before.
  static EventActions build(const System& system, const records::SystemSpec& spec, bool system_is_valid,
                            Diagnostics& diagnostics);

  /// Enables, disables, switches at once; what each coordinate and constraint does from now on; a constraint that
  /// closes keeps what it is found off by.
  DiscreteState apply(size_t trigger, HybridSystem& ode, double t, const VectorXd& y) const;
  /// "hinge 'root' is released", of the last build.
  const std::string& describe(size_t trigger) const { return changes_[trigger].text; }

 private:
  struct Change {
    records::EventAction action = records::EventAction::Log;
    std::vector<int> rows;  ///< of u: lock, release
    int constraint = -1;    ///< break, close
    int place = -1;         ///< of the controller, in the signal graph
    int body = -1;          ///< level
    int choice = 0;         ///< switch, level: from 0
    std::string text;
  };
  std::vector<Change> changes_;
};

}  // namespace bough::solver
