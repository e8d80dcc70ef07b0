#include "solver/integrate/simulate.hpp"

#include <algorithm>

#include "solver/integrate/run.hpp"

namespace bough::solver {

namespace {

class NoSink final : public records::ResultSink {
 public:
  void begin(const records::ResultsHeader&) override {}
  void write_sample(const Eigen::Ref<const Eigen::VectorXd>&) override {}
  void write_event(const records::EventRecord&) override {}
  void write_checkpoint(const records::Checkpoint&) override {}
  void end(bool, const std::string&) override {}
};

void add_new(const Diagnostic& item, Diagnostics& diagnostics) {
  const auto is_same = [&](const Diagnostic& d) { return d.id == item.id && d.what == item.what; };
  const auto& said = diagnostics.items();
  if (std::none_of(said.begin(), said.end(), is_same)) diagnostics.add(item);
}

}  // namespace

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
    for (const auto& item : failure.items()) add_new(item, found);
  }
  for (const auto& item : found.items()) add_new(item, diagnostics);
}

void check_run(const System& system, const records::SystemSpec& spec, Diagnostics& diagnostics) {
  prepare_run(system, spec, diagnostics);
}

SimulateOutcome simulate(const System& system, const records::SystemSpec& spec, records::ResultSink& sink,
                         const SimulateOptions& options, Diagnostics& diagnostics) {
  Diagnostics found;
  RunSetup setup = prepare_run(system, spec, found);
  for (const auto& item : found.items()) add_new(item, diagnostics);
  found.throw_if_errors();
  return Run(system, spec, std::move(setup), sink, options, diagnostics).go();
}

}  // namespace bough::solver
