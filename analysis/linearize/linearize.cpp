#include "analysis/linearize/linearize.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/common/inputs.hpp"
#include "analysis/linearize/operating_point.hpp"
#include "analysis/linearize/sweep.hpp"
#include "analysis/linearize/uncertain.hpp"
#include "formats/toml/specs.hpp"
#include "solver/linear/linearize.hpp"
#include "solver/simulate/modal_range_monitor.hpp"
#include "solver/simulate/time_events.hpp"

namespace bough::analysis {

namespace {

/// Unit vector of the axis; zero without. \throws InputError "cli.bad-axis"
Eigen::Vector3d get_spin_axis(const LinearizeRequest& request) {
  const auto& given = request.spin_axis;
  if (given.empty()) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d axis =
      given.size() == 3 ? Eigen::Vector3d(given[0], given[1], given[2]) : Eigen::Vector3d::Zero();
  if (!(axis.norm() > 0))
    throw InputError("cli.bad-axis", {}, "the axis of --spin-axis is zero",
                     "give the direction of the spin, --spin-axis 1 0 0");
  return axis.normalized();
}

/// Warns of bodies that leave the range of their modes at the point, once each: a run to there may have said so.
void warn_of_deflections(const LinearizeRequest& request, const solver::System& system,
                         const solver::OperatingPoint& point, Diagnostics& diagnostics) {
  const auto t = request.equilibrium ? std::optional<double>() : point.t;
  for (const auto& crossing : solver::ModalRangeMonitor(system).find_deflections(point.q, t)) {
    const std::string subject = "body '" + system.body_name(crossing.body) + "' deflects";
    const auto is_same = [&](const Diagnostic& d) { return d.id == crossing.id && d.what.starts_with(subject); };
    if (std::none_of(diagnostics.items().begin(), diagnostics.items().end(), is_same))
      diagnostics.warning(crossing.id, {request.file}, crossing.what, crossing.advice);
  }
}

records::LinearModel linearize_at(const LinearizeRequest& request, const LoadedSystem& loaded, solver::Plant& plant,
                                  solver::OperatingPoint point, bool check, Diagnostics& diagnostics) {
  warn_of_deflections(request, loaded.system, point, diagnostics);
  plant.hold_commands(point);
  auto model = solver::linearize(plant, point, {request.inputs, request.outputs, check, request.cut}, {request.file},
                                 diagnostics);
  model.units = loaded.spec.units;
  return model;
}

/// Warnings and notes of the first model; of the others only those that it did not have.
void keep_new(const Diagnostics& found, Diagnostics& diagnostics) {
  for (const auto& item : found.items()) {
    const auto is_same = [&](const Diagnostic& d) { return d.id == item.id; };
    if (std::none_of(diagnostics.items().begin(), diagnostics.items().end(), is_same)) diagnostics.add(item);
  }
}

records::LinearSweep sweep_parameter(const LinearizeRequest& request, Diagnostics& diagnostics) {
  const auto ranges = parse_sweeps(request.sweep);
  const auto linearize = [&](const std::vector<double>& values) {
    auto set = request.set;
    for (std::size_t i = 0; i < ranges.size(); ++i) set.push_back(fmt::format("{}={:.17g}", ranges[i].name, values[i]));
    Diagnostics found;
    const auto loaded = load_system(request.file, found, request.start_from, set);
    auto plant = make_plant(loaded, request.open);
    auto point = find_point(request, loaded, plant, found);
    auto model = linearize_at(request, loaded, *plant, std::move(point), false, found);
    keep_new(found, diagnostics);
    return model;
  };
  return make_sweep(ranges, linearize, request.file, diagnostics, get_spin_axis(request));
}

/// At every N-th sample of the run.
records::LinearSweep sweep_run(const LinearizeRequest& request, const LoadedSystem& loaded, Diagnostics& diagnostics) {
  Diagnostics checked;
  const auto plan = solver::make_run_plan(loaded.spec.simulation, checked);
  checked.throw_if_errors();
  const solver::TimeEvents samples(plan);
  std::vector<double> times;
  for (long i = 0; i < samples.num_outputs(); i += request.each) times.push_back(samples.calc_output(i));
  auto plant = make_plant(loaded, request.open);
  std::optional<records::Checkpoint> last;
  const auto linearize = [&](const std::vector<double>& values) {
    Diagnostics found;
    auto point = run_to(loaded, plant, values.front(), found, &last);
    if (request.equilibrium) point = find_rest(*plant, std::move(point), request.file);
    auto model = linearize_at(request, loaded, *plant, std::move(point), false, found);
    keep_new(found, diagnostics);
    return model;
  };
  return make_sweep({{"time", times}}, linearize, request.file, diagnostics, get_spin_axis(request));
}

/// Loads the system, with the first value of a sweep: a parameter without a value has one from it.
LoadedSystem load(const LinearizeRequest& request, Diagnostics& diagnostics) {
  demand_file(request.file);
  if (has_suffix(request.file, ".toml")) demand_kind(request.file, toml_files::detect_kind(request.file), "system");
  auto set = request.set;
  for (const auto& range : parse_sweeps(request.sweep))
    set.push_back(fmt::format("{}={:.17g}", range.name, range.values.front()));
  for (const auto& text : request.uncertain)
    if (const auto range = parse_uncertain(text); range.body.empty())
      set.push_back(fmt::format("{}={:.17g}", range.name, range.low));
  return load_system(request.file, diagnostics, request.start_from, set);
}

}  // namespace

solver::OperatingPoint find_point(const LinearizeRequest& request, const LoadedSystem& loaded,
                                  std::unique_ptr<solver::Plant>& plant, Diagnostics& diagnostics) {
  auto point = request.at ? run_to(loaded, plant, *request.at, diagnostics) : make_start(loaded, *plant, diagnostics);
  return request.equilibrium ? find_rest(*plant, std::move(point), request.file) : point;
}

void check_sweep(const LinearizeRequest& request) {
  if (!request.spin_axis.empty() && request.sweep.empty() && request.each == 0)
    throw InputError("cli.bad-axis", {}, "--spin-axis is given without --sweep and --each",
                     "give a sweep over the rate of the rotation, or leave it out");
  get_spin_axis(request);
  std::vector<std::pair<std::string, std::string>> ranged;  // parameter, option
  for (const auto& range : parse_sweeps(request.sweep)) ranged.emplace_back(range.name, "--sweep");
  for (const auto& range : parse_uncertain(request.uncertain)) ranged.emplace_back(range.name, "--uncertain");
  for (const auto& [name, option] : ranged)
    for (const auto& text : request.set)
      if (text.substr(0, text.find('=')) == name)
        throw InputError("cli.set-and-range", {},
                         fmt::format("--set {} and {} {} give one parameter", text, option, name),
                         "leave one of both out: the range gives the parameter its values");
}

records::LinearModel linearize(const LinearizeRequest& request, const LoadedSystem& loaded, Diagnostics& diagnostics) {
  auto plant = make_plant(loaded, request.open);
  solver::warn_of_latches(loaded.system, {request.file}, diagnostics);
  auto point = find_point(request, loaded, plant, diagnostics);
  return linearize_at(request, loaded, *plant, std::move(point), true, diagnostics);
}

records::LinearModel linearize(const LinearizeRequest& request, const CheckFiles& check, Events& events) {
  Diagnostics diagnostics;
  const auto loaded = load(request, diagnostics);
  const auto files = collect_sources(request.file, loaded);
  check(files);
  LoadOptions options;
  options.set = request.set;
  options.start_from = request.start_from;
  auto model = request.uncertain.empty() ? linearize(request, loaded, diagnostics)
                                         : linearize_uncertain(request, options, diagnostics);
  model.source = calc_sources(files);
  add_messages(diagnostics, events);
  return model;
}

records::LinearSweep sweep_linear_models(const LinearizeRequest& request, const CheckFiles& check, Events& events) {
  Diagnostics diagnostics;
  const auto loaded = load(request, diagnostics);
  const auto files = collect_sources(request.file, loaded);
  check(files);
  auto sweep = request.each > 0 ? sweep_run(request, loaded, diagnostics) : sweep_parameter(request, diagnostics);
  sweep.source = calc_sources(files);
  add_messages(diagnostics, events);
  return sweep;
}

}  // namespace bough::analysis
