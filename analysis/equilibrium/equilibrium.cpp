#include "analysis/equilibrium/equilibrium.hpp"

#include <fmt/format.h>

#include <limits>

#include "analysis/common/inputs.hpp"
#include "analysis/linearize/operating_point.hpp"
#include "formats/toml/specs.hpp"
#include "solver/linear/linearize.hpp"
#include "solver/simulate/channel_units.hpp"
#include "solver/simulate/modal_range_monitor.hpp"
#include "solver/simulate/outputs.hpp"

namespace bough::analysis {

namespace {

/// Fills header, sample and checkpoint.
void make_results(const LoadedSystem& loaded, solver::Plant& plant, EquilibriumAnswer& answer) {
  const auto& point = answer.found.point;
  const Eigen::VectorXd u = plant.calc_speeds(point);
  plant.evaluate(point);
  solver::Outputs recorder(loaded.system);
  auto& header = answer.header;
  header.system_text = loaded.spec.text;
  header.channels = recorder.channels();
  solver::label_channels(loaded.system, loaded.spec, header.channels);
  header.max_samples = 1;
  header.settings = {{"equilibrium_residual", fmt::format("{:.17g}", answer.found.residual)}};
  answer.sample = recorder.calc_sample({point.t, plant.data(), point.q, u, 0, 0});
  Eigen::VectorXd state = Eigen::VectorXd::Zero(point.q.size() + u.size() + point.z.size() + 2);
  state.head(state.size() - 2) << point.q, u, point.z;
  answer.checkpoint.time = point.t;
  answer.checkpoint.state = state;
  // Control memory as a run writes it: the time of the last samples, before any, then the memory.
  Eigen::VectorXd control(1 + point.memory.size());
  control << std::numeric_limits<double>::lowest(), point.memory;
  answer.checkpoint.memory = {{"control", control}};
}

}  // namespace

EquilibriumAnswer find_equilibrium(const EquilibriumRequest& request, const CheckFiles& check, Events& events) {
  demand_file(request.file);
  if (has_suffix(request.file, ".toml")) demand_kind(request.file, toml_files::detect_kind(request.file), "system");
  Diagnostics diagnostics;
  const auto loaded = load_system(request.file, diagnostics, {}, request.set);
  const auto files = collect_sources(request.file, loaded);
  check(files);
  solver::warn_of_latches(loaded.system, {request.file}, diagnostics);
  const auto made = make_plant(loaded);
  auto& plant = *made;
  const auto start = plant.make_initial_point();
  EquilibriumAnswer answer;
  answer.found = solver::find_equilibrium(plant, start, {request.file});
  const auto& found = answer.found;
  if (!found.unstable.empty())
    diagnostics.warning("equilibrium.unstable", {request.file},
                        fmt::format("the state found is unstable: {} leaves it, growing by e in {:.3g}",
                                    found.unstable.front().mode, 1 / found.unstable.front().rate),
                        "start nearer to the state wanted, by position and eta; bough linearize --equilibrium has the "
                        "poles");
  for (const auto& crossing : solver::ModalRangeMonitor(loaded.system).find_deflections(found.point.q, {}))
    diagnostics.warning(crossing.id, {request.file}, crossing.what, crossing.advice);
  answer.q = plant.get_for_file(found.point.q);
  for (int b = 0; b < loaded.system.num_bodies(); ++b)
    if (const int size = loaded.system.num_hinge_q(b); size > 0)
      answer.hinges.emplace_back(loaded.system.hinge_name(b), answer.q.segment(loaded.system.q_offset(b), size));
  make_results(loaded, plant, answer);
  answer.header.source = calc_sources(files);
  add_messages(diagnostics, events);
  return answer;
}

}  // namespace bough::analysis
