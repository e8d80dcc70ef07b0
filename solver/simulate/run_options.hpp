#pragma once
/// \file Options of a run in addition to its system, resolved and checked before it starts.
#include <set>

#include "solver/integrate/integrator.hpp"
#include "solver/simulate/event_actions.hpp"
#include "solver/simulate/outputs.hpp"
#include "solver/simulate/time_events.hpp"
#include "solver/simulate/user_events.hpp"

namespace bough::solver {

struct RunSetup {
  RunPlan plan;
  Outputs recorder;
  UserEvents triggers;
  EventActions changes;          ///< by trigger
  std::string integrator;        ///< never "auto"
  std::set<int> spins_reported;  ///< bodies whose spin without stiffening is warned of already
};

/// Reports everything in the spec that `simulate` would refuse: sensors, groups to record, events, [simulation]. The
/// system may have come from draft_system; to be used only when nothing was reported, and while the system stays.
RunSetup prepare_run(const System& system, const records::SystemSpec& spec, Diagnostics& diagnostics);

/// For integrator = "auto": "bdf" where the fastest mode or spring swings more than `kFastMode` radians between
/// samples, so that steps that follow it serve nothing ("radau" with gravity_central: errors of an orbit add up); else
/// "rk" for tolerances below 1e-10, else "adams". A note gives the choice and the reason.
std::string choose_integrator(const System& system, const records::SimulationRecord& simulation, double output_step,
                              Diagnostics& diagnostics);
inline constexpr double kFastMode = 300;

/// Largest frequency of small motions about the initial state, rad per unit of time; 0 without springs and modes.
double calc_fastest_frequency(const System& system);

}  // namespace bough::solver
