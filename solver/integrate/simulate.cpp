#include "solver/integrate/simulate.hpp"

#include <algorithm>

#include "solver/integrate/run.hpp"

namespace bough::solver {

void check_run(const System& system, const records::SystemSpec& spec, Diagnostics& diagnostics) {
  prepare_run(system, spec, diagnostics);
}

SimulateOutcome simulate(const System& system, const records::SystemSpec& spec, records::ResultSink& sink,
                         const SimulateOptions& options, Diagnostics& diagnostics) {
  Diagnostics found;
  RunSetup setup = prepare_run(system, spec, found);
  for (const auto& item : found.items()) {
    const auto is_same = [&](const Diagnostic& d) { return d.id == item.id && d.what == item.what; };
    const auto& said = diagnostics.items();
    if (std::none_of(said.begin(), said.end(), is_same)) diagnostics.add(item);
  }
  found.throw_if_errors();
  return Run(system, spec, std::move(setup), sink, options, diagnostics).go();
}

}  // namespace bough::solver
