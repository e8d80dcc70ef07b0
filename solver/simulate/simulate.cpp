#include "solver/simulate/simulate.hpp"

#include <limits>

#include "solver/simulate/no_sink.hpp"
#include "solver/simulate/run.hpp"
#include "solver/simulate/simulator.hpp"

namespace bough::solver {

void check_start(const System& system, const records::SystemSpec& spec, Diagnostics& diagnostics) {
  Diagnostics found;
  try {
    RunSetup setup = prepare_run(system, spec, found);
    if (found.num_errors() == 0) {
      NoSink sink;
      const SimulateOptions options;
      Run(system, spec, std::move(setup), sink, options, found).start();
    }
  } catch (const Failure& failure) {
    for (const auto& item : failure.items()) found.add_new(item);
  }
  for (const auto& item : found.items()) diagnostics.add_new(item);
}

void check_run(const System& system, const records::SystemSpec& spec, Diagnostics& diagnostics) {
  prepare_run(system, spec, diagnostics);
}

SimulateOutcome simulate(const System& system, const records::SystemSpec& spec, records::ResultSink& sink,
                         const SimulateOptions& options, Diagnostics& diagnostics) {
  Simulator simulator(system, spec, sink, options, diagnostics);
  simulator.advance_to(std::numeric_limits<double>::infinity());
  return *simulator.outcome();
}

}  // namespace bough::solver
