#include "analysis/linearize/operating_point.hpp"

#include <fmt/format.h>

#include "analysis/common/choices.hpp"
#include "analysis/common/start_state.hpp"
#include "solver/linear/equilibrium.hpp"
#include "solver/simulate/hybrid_system.hpp"
#include "solver/simulate/simulate.hpp"

namespace bough::analysis {

namespace {

/// Keeps the last checkpoint and nothing else.
class LastState final : public records::ResultSink {
 public:
  void begin(const records::ResultsHeader&) override {}
  void write_sample(const Eigen::Ref<const Eigen::VectorXd>&) override {}
  void write_event(const records::EventRecord&) override {}
  void write_checkpoint(const records::Checkpoint& checkpoint) override { last_ = checkpoint; }
  void end(bool, const std::string&) override {}
  const records::Checkpoint& last() const { return last_; }

 private:
  records::Checkpoint last_;
};

}  // namespace

std::unique_ptr<solver::Plant> make_plant(const LoadedSystem& loaded, bool is_open) {
  return std::make_unique<solver::Plant>(loaded.system, is_open);
}

solver::OperatingPoint make_start(const LoadedSystem& loaded, solver::Plant& plant, Diagnostics& diagnostics) {
  auto point = plant.make_initial_point();
  const auto start = find_start_control(loaded.start_from, loaded.system, point.t, diagnostics);
  if (!start) return point;
  point.z = start->state.segment(loaded.system.num_q() + loaded.system.num_u(), loaded.system.num_z());
  if (const auto* control = start->find("control")) point.memory = control->tail(control->size() - 1);
  plant.initialize_signals(point);
  return point;
}

solver::OperatingPoint run_to(const LoadedSystem& loaded, std::unique_ptr<solver::Plant>& plant, double t,
                              Diagnostics& diagnostics, std::optional<records::Checkpoint>* last) {
  auto spec = loaded.spec;
  auto& s = spec.simulation;
  const int nq = loaded.system.num_q(), nu = loaded.system.num_u();
  demand_finite("--at", t);
  if (t < s.start) {
    throw InputError("linear.bad-time", s.at,
                     fmt::format("time {:g} lies before the start of the run, {:g}", t, s.start),
                     "give a later time with --at");
  }
  if (t == s.start) return make_start(loaded, *plant, diagnostics);
  s.duration = s.output_step = t - s.start;
  LastState sink;
  solver::SimulateOptions options;
  if (last) options.resume = *last;
  if (!options.resume) options.resume = find_start_control(loaded.start_from, loaded.system, s.start, diagnostics);
  Diagnostics of_run;
  const auto keep = [&] {
    // Events past the operating point are none that the user expects; there are no samples for the hint.
    for (const auto& item : of_run.items())
      if ((item.id != "run.event-never" && item.id != "run.fast-modes") || item.severity == Severity::Error)
        diagnostics.add(item);
  };
  try {
    solver::simulate(loaded.system, spec, sink, options, of_run);
  } catch (...) {
    keep();
    throw;
  }
  keep();
  if (last) *last = sink.last();
  const auto& state = sink.last().state;
  const auto* discrete = sink.last().find("discrete");
  solver::HybridSystem ode(loaded.system);
  const bool has_changed = discrete && !ode.is_alike(*discrete);
  if (discrete) ode.set_memory(*discrete);
  if (&plant->system() != &ode.system()) plant = std::make_unique<solver::Plant>(ode.system(), plant->is_open());
  if (has_changed) {
    if (last)
      throw InputError(
          "linear.changed-system", s.at,
          fmt::format("an event before t = {:g} locked, released, closed or broke something, and the models "
                      "of a sweep have the same coordinates",
                      t),
          "linearize there by --at, or end the sweep before it by duration");
    plant->set_modes(solver::get_discrete(ode.data()), t, state.head(nq));
  }
  const auto* control = sink.last().find("control");
  Eigen::VectorXd memory;
  if (control) memory = control->tail(control->size() - 1);
  return {t, state.head(nq), plant->restrict(state.segment(nq, nu)), state.segment(nq + nu, loaded.system.num_z()),
          memory};
}

solver::OperatingPoint find_rest(solver::Plant& plant, solver::OperatingPoint start, const std::string& file) {
  start.u = plant.get_initial_state().u;
  return solver::find_equilibrium(plant, start, {file}).point;
}

}  // namespace bough::analysis
