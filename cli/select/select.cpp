#include <CLI/CLI.hpp>
#include <filesystem>
#include <utility>

#include "analysis/common/body_files.hpp"
#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/text_file.hpp"
#include "analysis/select/system_selection.hpp"
#include "cli/common/console_events.hpp"
#include "cli/common/number_checks.hpp"
#include "cli/common/options.hpp"
#include "cli/common/output_folder.hpp"
#include "cli/common/usage_text.hpp"
#include "cli/select/selection_tables.hpp"
#include "cli/verbs.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::cli {

namespace {

struct SelectOptions : CommonOptions {
  analysis::SelectRequest request;
  std::string response;
  int inertial_load = 0;
};

void print(const SelectOptions& o, Console& console, const std::vector<RankedBody>& bodies,
           const analysis::Selection& selection) {
  if (o.json)
    console.print_data(make_json(bodies, selection).dump(2) + "\n");
  else
    console.print(format(bodies, selection, o.inertial_load));
  if (!o.response.empty()) write_response(selection, o.response);
}

/// All flexible bodies of the systems; the output is a folder.
int run_select_system(SelectOptions o, Console& console) {
  auto& request = o.request;
  request.systems.insert(request.systems.begin(), std::exchange(request.body, {}));
  const auto sources = analysis::list_select_inputs(request);
  ConsoleEvents events(console);
  const auto answer = analysis::select_system_modes(request, events);
  console.print(events.get_messages());
  std::vector<std::string> paths;
  analysis::SelectedFiles files;
  if (!o.output.empty()) {
    files = analysis::make_selected_files(request, answer, o.output);
    const std::filesystem::path folder(o.output);
    for (const auto& body : files.bodies) paths.push_back((folder / body.name).string());
    for (const auto& system : files.systems) paths.push_back((folder / system.name).string());
    make_output_folder(o.output);
  }
  auto inputs = sources;
  for (const auto& body : answer.bodies) inputs.push_back(analysis::get_body_path(body.file));
  auto outputs = paths;
  outputs.push_back(o.response);
  check_outputs(o, outputs, inputs);
  std::vector<RankedBody> ranked;
  for (const auto& body : answer.bodies) ranked.push_back({body.name, body.file, &body.body});
  print(o, console, ranked, answer.selection);
  std::size_t written = 0;
  for (const auto& body : files.bodies) hdf5::write_flex_body(body.body, paths[written++]);
  for (const auto& system : files.systems) analysis::write_text_file(paths[written++], system.text);
  return print_written_files(o, console, outputs);
}

int run_select(const SelectOptions& o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  const auto& request = o.request;
  if (analysis::has_suffix(request.body, ".toml")) return run_select_system(o, console);
  const auto sources = analysis::list_select_inputs(request);
  check_outputs(o, {o.output, o.response}, sources);
  Diagnostics of_file;
  const auto body =
      o.output.empty() ? analysis::read_body(request.body, of_file) : analysis::read_moving_body(request.body, of_file);
  ConsoleEvents events(console);
  const auto selection = analysis::select_modes(request, body, events, std::move(of_file));
  console.print(events.get_messages());
  print(o, console, {{"", request.body, &body}}, selection);
  if (!o.output.empty()) hdf5::write_flex_body(analysis::keep_selected(request, body, selection, sources), o.output);
  return print_written_files(o, console, {o.response, o.output});
}

}  // namespace

void add_select(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_select, "select", &analysis::SelectRequest::body);
  verb->add_option(
          "body", o->request.body,
          "Flexible-body HDF5 file, or .FLX (panels.FLX:2: its body 2); or a system (.toml): the modes of all its "
          "flexible bodies, ranked together")
      ->required();
  verb->add_option("system", o->request.systems,
                   "System files (.toml) with their forces, actuators, sensors, in closed loop; of several the worst "
                   "counts; without, the body alone");
  verb->add_option("--inputs", o->request.inputs,
                   "Nodes that are pushed, ID or ID:x, y, z, rx, ry, rz (default: interface); of a system: its "
                   "actuators, without actuators its forces")
      ->delimiter(',');
  verb->add_option("--outputs", o->request.outputs,
                   "Nodes whose motion counts, as above, or ID:vx, vy, vz, wx, wy, wz for rates; of a system: its "
                   "sensors")
      ->delimiter(',');
  verb->add_option("--weight", o->request.weights,
                   "NAME=W: an output or the amplitude of an input counts W times; repeatable")
      ->allow_extra_args(false);
  verb->add_option("--spectrum", o->request.spectrum,
                   "CSV of frequency_hz and a one-sided density of the inputs (a column a name, or one for all) in "
                   "place of white noise");
  verb->add_option("-n,--number", o->request.number, "Number of modes to keep; of a system, of all its bodies together")
      ->check(make_positive());
  verb->add_option("--tolerance", o->request.tolerance,
                   "Drop modes without which the outputs lose at most this part of their mean square (default: 0.01)")
      ->check(is_within(0.0, 1.0))
      ->check(make_finite());
  verb->add_option("--below", o->request.below_hz, "Drop modes above this frequency")->check(make_positive());
  verb->add_option("--keep", o->request.pinned, "Modes that stay, by their numbers: 3, of a system boom:3")
      ->delimiter(',');
  verb->add_flag(
      "--exchange", o->request.exchange,
      "Exchange kept and dropped modes, one pair at a time, as long as the outputs lose less; each pair costs a "
      "linear model");
  verb->add_option("--damping", o->request.damping,
                   "Damping ratio of modes that have none, of a body without a system (default: 0.01)")
      ->check(make_positive());
  verb->add_option("--at", o->request.at, "With a system: weigh the modes at these times of its run; the worst counts")
      ->delimiter(',')
      ->check(make_finite());
  verb->add_flag("--equilibrium", o->request.equilibrium, "With a system: at its state of rest or steady spin");
  verb->add_flag("--open", o->request.open, "With a system: without its controllers");
  verb->add_option("--stiffening", o->inertial_load,
                   "Also list K_G1 over K of each mode for this inertial load, 1 to 12 (1: ax ... 7: wx^2 ...)")
      ->check(is_within(1, 12));
  verb->add_option("--response", o->response,
                   "Write the largest singular value over frequency before and after: .svg, or CSV");
  add_set_option(*verb, o->request.set);
  add_common_options(
      *verb, *o, kOutput | kJson,
      "Write the body with the modes kept to this HDF5 file; of a system: folder for the bodies and the system");
}

}  // namespace bough::cli
