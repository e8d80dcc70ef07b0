#include <CLI/CLI.hpp>
#include <utility>

#include "analysis/common/body_files.hpp"
#include "analysis/common/failures.hpp"
#include "analysis/select/selection.hpp"
#include "analysis/select/weighing.hpp"
#include "cli/common/console_events.hpp"
#include "cli/common/number_checks.hpp"
#include "cli/common/options.hpp"
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

int run_select(const SelectOptions& o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  const auto& request = o.request;
  const auto sources = analysis::list_select_inputs(request);
  check_outputs(o, {o.output, o.response}, sources);
  Diagnostics of_file;
  const auto body =
      o.output.empty() ? analysis::read_body(request.body, of_file) : analysis::read_moving_body(request.body, of_file);
  ConsoleEvents events(console);
  const auto selection = analysis::select_modes(request, body, events, std::move(of_file));
  console.print(events.get_messages());
  if (o.json)
    console.print_data(make_json(body, selection).dump(2) + "\n");
  else
    console.print(format(body, selection, o.inertial_load));
  if (!o.response.empty()) write_response(selection, o.response);
  if (!o.output.empty()) hdf5::write_flex_body(analysis::keep_selected(request, body, selection, sources), o.output);
  return print_written_files(o, console, {o.response, o.output});
}

}  // namespace

void add_select(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_select, "select", &analysis::SelectRequest::body);
  verb->add_option("body", o->request.body, "Flexible-body HDF5 file, or .FLX (panels.FLX:2: its body 2)")->required();
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
  verb->add_option("-n,--number", o->request.number, "Keep so many modes")->check(make_positive());
  verb->add_option("--tolerance", o->request.tolerance,
                   "Drop modes without which the outputs lose at most this part of their mean square (default: 0.01)")
      ->check(is_within(0.0, 1.0))
      ->check(make_finite());
  verb->add_option("--below", o->request.below_hz, "Drop modes above this frequency")->check(make_positive());
  verb->add_option("--keep", o->request.pinned, "Modes that stay, by their numbers")->delimiter(',');
  verb->add_option("--damping", o->request.damping, "Damping ratio of modes that have none (default: 0.01)")
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
  add_common_options(*verb, *o, kOutput | kJson, "Write the body with the modes kept to this HDF5 file");
}

}  // namespace bough::cli
