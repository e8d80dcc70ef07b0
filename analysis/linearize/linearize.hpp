#pragma once
/// \file Linear models of a multibody system: about a state, along its run, along a parameter.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/common/events.hpp"
#include "analysis/common/system_files.hpp"
#include "formats/records/linear_model.hpp"
#include "formats/records/linear_sweep.hpp"
#include "solver/linear/plant.hpp"

namespace bough::analysis {

struct LinearizeRequest {
  std::string file;              ///< system file
  std::vector<std::string> set;  ///< "name=value" of [parameters]
  std::string start_from;        ///< results file with the initial state; empty: that of the system file
  std::optional<double> at;      ///< time of the run; none: its start
  bool equilibrium = false;      ///< at rest or in steady spin near that state
  bool open = false;             ///< without the controllers
  std::vector<std::string> inputs, outputs;
  std::string cut;                     ///< actuator, sensor or controller at which one loop is opened; empty: none
  int each = 0;                        ///< sweep over every each-th sample of the run; 0: none
  std::vector<std::string> uncertain;  ///< "NAME=LOW:HIGH": with inputs and outputs of these parameters (uncertain.hpp)
  std::vector<double> spin_axis;   ///< of a sweep, in the frame of position outputs: directions of whirl; empty: none
  std::vector<std::string> sweep;  ///< sweep over "NAME=FROM:TO:N[:log]" of [parameters], or a grid of several
};

/// Called with the files that were read, before the work.
using CheckFiles = std::function<void(const std::vector<std::string>& files)>;

/// Throws InputError "cli.bad-sweep" or "cli.bad-uncertain" unless sweep and ranges of the request can be parsed.
/// "cli.set-and-range" if `set` gives one of their parameters.
void check_sweep(const LinearizeRequest& request);

/// The state to linearize about: start or time of the run, or the rest near it. Throws what these throw.
solver::OperatingPoint find_point(const LinearizeRequest& request, const LoadedSystem& loaded,
                                  std::unique_ptr<solver::Plant>& plant, Diagnostics& diagnostics);
/// The model of a system that is loaded; its source stays empty.
records::LinearModel linearize(const LinearizeRequest& request, const LoadedSystem& loaded, Diagnostics& diagnostics);
/// Loads the system and makes its model, with its source. Throws what loading and linearizing throw.
records::LinearModel linearize(const LinearizeRequest& request, const CheckFiles& check, Events& events);
/// A model for each value of the sweep, their poles followed.
records::LinearSweep sweep_linear_models(const LinearizeRequest& request, const CheckFiles& check, Events& events);

}  // namespace bough::analysis
