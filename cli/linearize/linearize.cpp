#include "solver/linear/linearize.hpp"

#include <CLI/CLI.hpp>
#include <memory>

#include "cli/common/console.hpp"
#include "cli/common/options.hpp"
#include "cli/linearize/linear_model_files.hpp"
#include "cli/linearize/operating_point.hpp"
#include "cli/verbs.hpp"
#include "formats/hdf5/linear_file.hpp"
#include "formats/toml/specs.hpp"

namespace bough::cli {

namespace {

struct LinearizeVerbOptions : CommonOptions {
  std::string file, mat, start_from;
  std::optional<double> at;
  bool equilibrium = false, open = false;
  std::vector<std::string> inputs, outputs, set;
};

int run_linearize(const LinearizeVerbOptions& o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  demand_file(o.file);
  if (has_suffix(o.file, ".toml")) demand_kind(o.file, toml_files::detect_kind(o.file), "system");
  Diagnostics diagnostics;
  const auto loaded = load_system(o.file, diagnostics, o.start_from, o.set);
  const auto sources = collect_sources(o.file, loaded);
  check_outputs(o, {o.output, o.mat}, sources);
  auto plant = make_plant(loaded, o.open);
  auto point = o.at ? run_to(loaded, plant, *o.at, diagnostics) : plant.make_initial_point();
  if (o.equilibrium) point = find_rest(plant, std::move(point), o.file);
  plant.hold_commands(point);
  solver::warn_of_latches(loaded.system, {o.file}, diagnostics);
  auto model = solver::linearize(plant, point, {o.inputs, o.outputs, true}, {o.file}, diagnostics);
  model.source = calc_sources(sources);
  console.print(diagnostics);
  if (o.json)
    console.print_data(make_json(model).dump(2) + "\n");
  else
    console.print(format_linear_model(model));
  if (!o.output.empty()) hdf5::write_linear_model(model, o.output);
  if (!o.mat.empty()) write_linear_mat(model, o.mat);
  for (const auto& path : {o.output, o.mat})
    if (!path.empty() && !o.json) console.print("written: " + path + "\n");
  return kSuccess;
}

}  // namespace

void add_linearize(CLI::App& app, Action& action) {
  auto o = std::make_shared<LinearizeVerbOptions>();
  auto* verb = app.add_subcommand("linearize", "A B C D, poles and zeros of a multibody system about a state");
  verb->add_option("file", o->file, "System file (.toml)")->required();
  verb->add_option("--at", o->at, "Run to this time and linearize there (default: the initial state)");
  verb->add_option("--start-from", o->start_from,
                   "Start from the last state of this results file, of run or equilibrium");
  verb->add_flag("--equilibrium", o->equilibrium, "Linearize about the state of rest or steady spin nearby");
  verb->add_option("--inputs", o->inputs,
                   "Actuators, forces, or hinges, by name, in this order (default: all actuators, or all forces)")
      ->delimiter(',');
  verb->add_option("--outputs", o->outputs, "Sensors, or NAME:component, in this order (default: all)")->delimiter(',');
  verb->add_flag("--open", o->open, "Open the loops: actuators keep the commands they have at the operating point");
  verb->add_option("--mat", o->mat, "Write A B C D and the names to this MATLAB file");
  add_set_option(*verb, o->set);
  add_common_options(*verb, *o, kOutput | kJson, "Write the model to this HDF5 file");
  verb->footer(
      "Example:\n  bough linearize arm.toml -o arm-linear.h5 --mat arm.mat\n"
      "  bough linearize arm.toml --inputs shoulder,elbow --outputs tip:y --at 2.5 --json");
  verb->callback([&action, o] { action = [o] { return blame(o->file, [&] { return run_linearize(*o); }); }; });
}

}  // namespace bough::cli
