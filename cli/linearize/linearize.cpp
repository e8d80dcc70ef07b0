#include <CLI/CLI.hpp>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/text_file.hpp"
#include "analysis/export/csv_tables.hpp"
#include "analysis/export/linear_mat.hpp"
#include "analysis/linearize/linearize.hpp"
#include "cli/common/console_events.hpp"
#include "cli/common/options.hpp"
#include "cli/common/usage_text.hpp"
#include "cli/linearize/linear_model_files.hpp"
#include "cli/linearize/sweep_tables.hpp"
#include "cli/verbs.hpp"
#include "formats/hdf5/linear_file.hpp"
#include "formats/hdf5/sweep_file.hpp"
#include "formats/toml/specs.hpp"

namespace bough::cli {

namespace {

struct LinearizeVerbOptions : CommonOptions {
  analysis::LinearizeRequest request;
  std::string mat, csv;
};

/// Functions that turn a result into text and into its files.
template <class Result>
struct ResultWriters {
  std::string (*format)(const Result&);
  void (*write)(const Result&, const std::string&);
  void (*write_mat)(const Result&, const std::string&);
  std::string (*make_csv)(const Result&);
};

/// Prints the result and writes the files that the command line names.
template <class Result>
void write_result(const LinearizeVerbOptions& o, const Console& console, const Result& result,
                  const ResultWriters<Result>& writers) {
  if (o.json)
    console.print_data(make_json(result).dump(2) + "\n");
  else
    console.print(writers.format(result));
  if (!o.output.empty()) writers.write(result, o.output);
  if (!o.mat.empty()) writers.write_mat(result, o.mat);
  if (!o.csv.empty()) analysis::write_text_file(o.csv, writers.make_csv(result));
  print_written_files(o, console, {o.output, o.mat, o.csv});
}

int run_linearize(const LinearizeVerbOptions& o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  const auto& request = o.request;
  analysis::demand_file(request.file);
  if (analysis::has_suffix(request.file, ".toml"))
    analysis::demand_kind(request.file, toml_files::detect_kind(request.file), "system");
  try {
    analysis::check_sweep(request);
  } catch (const InputError& error) {  // of the command line, not of a file
    report_failure(error, console);
    return kUsageError;
  }
  ConsoleEvents events(console);
  const auto check = [&](const std::vector<std::string>& files) { check_outputs(o, {o.output, o.mat, o.csv}, files); };
  if (request.each > 0 || !request.sweep.empty()) {
    const auto sweep = analysis::sweep_linear_models(request, check, events);
    console.print(events.get_messages());
    write_result<records::LinearSweep>(
        o, console, sweep, {format_sweep, hdf5::write_sweep, analysis::write_sweep_mat, analysis::make_sweep_csv});
    return kSuccess;
  }
  const auto model = analysis::linearize(request, check, events);
  console.print(events.get_messages());
  write_result<records::LinearModel>(
      o, console, model,
      {format_linear_model, hdf5::write_linear_model, analysis::write_linear_mat, analysis::make_linear_csv});
  return kSuccess;
}

}  // namespace

void add_linearize(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_linearize, "linearize", &analysis::LinearizeRequest::file);
  verb->add_option("file", o->request.file, "System file (.toml)")->required();
  verb->add_option("--at", o->request.at, "Run to this time and linearize there (default: the initial state)")
      ->check(make_finite());
  verb->add_option("--start-from", o->request.start_from,
                   "Start from the last state of this results file, of run or equilibrium");
  verb->add_flag("--equilibrium", o->request.equilibrium, "Linearize about the state of rest or steady spin nearby");
  verb->add_option("--inputs", o->request.inputs,
                   "Actuators, forces, or hinges, by name, in this order (default: all actuators, or all forces)")
      ->delimiter(',');
  verb->add_option("--outputs", o->request.outputs, "Sensors, or NAME:component, in this order (default: all)")
      ->delimiter(',');
  auto* open = verb->add_flag("--open", o->request.open,
                              "Open the loops: actuators keep the commands they have at the operating point");
  verb->add_option("--break", o->request.cut,
                   "Cut one loop at this actuator, sensor or controller (NAME or NAME:component): the loop transfer "
                   "with negative feedback, for bough response")
      ->excludes(open)
      ->excludes("--inputs")
      ->excludes("--outputs");
  auto* each =
      verb->add_option("--each", o->request.each, "Linearize at every N-th sample of the run, from its start on")
          ->check(make_positive())
          ->excludes("--at");
  verb->add_option(
          "--sweep", o->request.sweep,
          "NAME=FROM:TO:N, a model for each of N values of a parameter, their poles followed; with :log evenly "
          "by ratio; given for several parameters, a model for each point of their grid (LPV)")
      ->excludes(each);
  verb->add_option("--spin-axis", o->request.spin_axis,
                   "Of --sweep and --each: X Y Z, axis of the spin in the frame of the position sensors: whirl of each "
                   "mode, forward or backward")
      ->expected(3)
      ->check(make_finite());
  auto* uncertain = verb->add_option("--uncertain", o->request.uncertain,
                                     "NAME=LOW:HIGH, a parameter, or BODY:eta1:frequency, stiffness or damping as a "
                                     "factor: the model with inputs w and "
                                     "outputs z for w = delta z, delta in [-1, 1]; may be repeated");
  uncertain->excludes(each)->excludes("--sweep");
  verb->add_option("--csv", o->csv, "Write [A B; C D] with names, or the poles of a sweep, to this CSV file");
  verb->add_option("--mat", o->mat, "Write A B C D and the names, of a sweep arrays of them, to this MATLAB file");
  add_set_option(*verb, o->request.set);
  add_common_options(*verb, *o, kOutput | kJson, "Write the model to this HDF5 file");
}

}  // namespace bough::cli
