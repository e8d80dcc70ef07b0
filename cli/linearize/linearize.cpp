#include "solver/linear/linearize.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/system_files.hpp"
#include "analysis/linearize/operating_point.hpp"
#include "cli/common/console.hpp"
#include "cli/common/options.hpp"
#include "cli/common/text_file.hpp"
#include "cli/common/usage_text.hpp"
#include "cli/linearize/linear_model_files.hpp"
#include "cli/linearize/sweep.hpp"
#include "cli/verbs.hpp"
#include "formats/hdf5/linear_file.hpp"
#include "formats/hdf5/sweep_file.hpp"
#include "formats/toml/specs.hpp"
#include "solver/simulate/time_events.hpp"

namespace bough::cli {

namespace {

struct LinearizeVerbOptions : CommonOptions {
  std::string file, mat, csv, start_from, cut, sweep;
  std::optional<double> at;
  int each = 0;
  bool equilibrium = false, open = false;
  std::vector<std::string> inputs, outputs, set;
};

records::LinearModel linearize_at(const LinearizeVerbOptions& o, solver::Plant& plant, solver::OperatingPoint point,
                                  bool check, Diagnostics& diagnostics) {
  if (o.equilibrium) point = analysis::find_rest(plant, std::move(point), o.file);
  plant.hold_commands(point);
  return solver::linearize(plant, point, {o.inputs, o.outputs, check, o.cut}, {o.file}, diagnostics);
}

/// Warnings and notes of the first model; of the others only those that it did not have.
void keep_new(const Diagnostics& found, Diagnostics& diagnostics) {
  for (const auto& item : found.items()) {
    const auto is_same = [&](const Diagnostic& d) { return d.id == item.id; };
    if (std::none_of(diagnostics.items().begin(), diagnostics.items().end(), is_same)) diagnostics.add(item);
  }
}

records::LinearSweep sweep_parameter(const LinearizeVerbOptions& o, Diagnostics& diagnostics) {
  const auto range = parse_sweep(o.sweep);
  const auto linearize = [&](double value) {
    auto set = o.set;
    set.push_back(fmt::format("{}={:.17g}", range.name, value));
    Diagnostics found;
    const auto loaded = analysis::load_system(o.file, found, o.start_from, set);
    auto plant = analysis::make_plant(loaded, o.open);
    auto point = o.at ? analysis::run_to(loaded, plant, *o.at, found) : analysis::make_start(loaded, plant, found);
    auto model = linearize_at(o, plant, std::move(point), false, found);
    keep_new(found, diagnostics);
    return model;
  };
  return make_sweep(range.name, range.values, linearize, o.file, diagnostics);
}

/// At every N-th sample of the run.
records::LinearSweep sweep_run(const LinearizeVerbOptions& o, const analysis::LoadedSystem& loaded,
                               Diagnostics& diagnostics) {
  Diagnostics checked;
  const auto plan = solver::make_run_plan(loaded.spec.simulation, checked);
  checked.throw_if_errors();
  const solver::TimeEvents samples(plan);
  std::vector<double> times;
  for (long i = 0; i < samples.num_outputs(); i += o.each) times.push_back(samples.calc_output(i));
  auto plant = analysis::make_plant(loaded, o.open);
  std::optional<records::Checkpoint> last;
  const auto linearize = [&](double t) {
    Diagnostics found;
    auto point = analysis::run_to(loaded, plant, t, found, &last);
    auto model = linearize_at(o, plant, std::move(point), false, found);
    keep_new(found, diagnostics);
    return model;
  };
  return make_sweep("time", times, linearize, o.file, diagnostics);
}

int run_sweep(const LinearizeVerbOptions& o, const Console& console, const analysis::LoadedSystem& loaded,
              const std::vector<std::string>& sources, Diagnostics& diagnostics) {
  auto sweep = o.each > 0 ? sweep_run(o, loaded, diagnostics) : sweep_parameter(o, diagnostics);
  sweep.source = analysis::calc_sources(sources);
  console.print(diagnostics);
  if (o.json)
    console.print_data(make_json(sweep).dump(2) + "\n");
  else
    console.print(format_sweep(sweep));
  if (!o.output.empty()) hdf5::write_sweep(sweep, o.output);
  if (!o.csv.empty()) write_text_file(o.csv, make_sweep_csv(sweep));
  return kSuccess;
}

int run_linearize(const LinearizeVerbOptions& o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  analysis::demand_file(o.file);
  if (analysis::has_suffix(o.file, ".toml")) analysis::demand_kind(o.file, toml_files::detect_kind(o.file), "system");
  Diagnostics diagnostics;
  auto set = o.set;
  try {
    if (!o.sweep.empty()) {  // a parameter without a value has one from the sweep
      const auto range = parse_sweep(o.sweep);
      set.push_back(fmt::format("{}={:.17g}", range.name, range.values.front()));
    }
  } catch (const InputError& error) {  // of the command line, not of a file
    report_failure(error, console);
    return kUsageError;
  }
  const auto loaded = analysis::load_system(o.file, diagnostics, o.start_from, set);
  const auto sources = analysis::collect_sources(o.file, loaded);
  check_outputs(o, {o.output, o.mat, o.csv}, sources);
  if (o.each > 0 || !o.sweep.empty()) {
    const int code = run_sweep(o, console, loaded, sources, diagnostics);
    for (const auto& path : {o.output, o.csv})
      if (!path.empty() && !o.json) console.print("written: " + path + "\n");
    return code;
  }
  auto plant = analysis::make_plant(loaded, o.open);
  auto point =
      o.at ? analysis::run_to(loaded, plant, *o.at, diagnostics) : analysis::make_start(loaded, plant, diagnostics);
  solver::warn_of_latches(loaded.system, {o.file}, diagnostics);
  auto model = linearize_at(o, plant, std::move(point), true, diagnostics);
  model.source = analysis::calc_sources(sources);
  console.print(diagnostics);
  if (o.json)
    console.print_data(make_json(model).dump(2) + "\n");
  else
    console.print(format_linear_model(model));
  if (!o.output.empty()) hdf5::write_linear_model(model, o.output);
  if (!o.mat.empty()) write_linear_mat(model, o.mat);
  if (!o.csv.empty()) write_text_file(o.csv, make_linear_csv(model));
  for (const auto& path : {o.output, o.mat, o.csv})
    if (!path.empty() && !o.json) console.print("written: " + path + "\n");
  return kSuccess;
}

}  // namespace

void add_linearize(CLI::App& app, Action& action) {
  auto o = std::make_shared<LinearizeVerbOptions>();
  auto* verb = add_verb(app, "linearize", "A B C D, poles and zeros of a multibody system about a state");
  verb->add_option("file", o->file, "System file (.toml)")->required();
  verb->add_option("--at", o->at, "Run to this time and linearize there (default: the initial state)");
  verb->add_option("--start-from", o->start_from,
                   "Start from the last state of this results file, of run or equilibrium");
  verb->add_flag("--equilibrium", o->equilibrium, "Linearize about the state of rest or steady spin nearby");
  verb->add_option("--inputs", o->inputs,
                   "Actuators, forces, or hinges, by name, in this order (default: all actuators, or all forces)")
      ->delimiter(',');
  verb->add_option("--outputs", o->outputs, "Sensors, or NAME:component, in this order (default: all)")->delimiter(',');
  auto* open =
      verb->add_flag("--open", o->open, "Open the loops: actuators keep the commands they have at the operating point");
  verb->add_option("--break", o->cut,
                   "Cut one loop at this actuator, sensor or controller (NAME or NAME:component): the loop transfer "
                   "with negative feedback, for bough response")
      ->excludes(open)
      ->excludes("--inputs")
      ->excludes("--outputs");
  auto* each = verb->add_option("--each", o->each, "Linearize at every N-th sample of the run, from its start on")
                   ->check(make_positive())
                   ->excludes("--at");
  verb->add_option(
          "--sweep", o->sweep,
          "NAME=FROM:TO:N, a model for each of N values of a parameter, their poles followed; with :log evenly "
          "by ratio")
      ->excludes(each);
  verb->add_option("--csv", o->csv, "Write [A B; C D] with names, or the poles of a sweep, to this CSV file");
  verb->add_option("--mat", o->mat, "Write A B C D and the names to this MATLAB file")
      ->excludes(each)
      ->excludes("--sweep");
  add_set_option(*verb, o->set);
  add_common_options(*verb, *o, kOutput | kJson, "Write the model to this HDF5 file");
  verb->footer(
      "Example:\n  bough linearize arm.toml -o arm-linear.h5 --mat arm.mat\n"
      "  bough linearize arm.toml --inputs shoulder,elbow --outputs tip:y --at 2.5 --json\n"
      "  bough linearize rotor.toml --equilibrium --sweep rate=0:6:25 -o campbell.h5\n"
      "  bough linearize arm.toml --break motor -o loop.h5 && bough response loop.h5");
  verb->callback(
      [&action, o] { action = [o] { return analysis::with_file(o->file, [&] { return run_linearize(*o); }); }; });
}

}  // namespace bough::cli
