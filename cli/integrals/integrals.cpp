#include "analysis/integrals/integrals.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/text_file.hpp"
#include "cli/common/console_events.hpp"
#include "cli/common/options.hpp"
#include "cli/flx/flx_output.hpp"

namespace bough::cli {

namespace {

using Eigen::MatrixXd;

struct IntegralsOptions : FlxOptions {
  analysis::IntegralsRequest request;
  std::string fi;
};

std::string format_inertial_loads(const MatrixXd& F_I, const Eigen::MatrixXi& dof_map) {
  std::string text =
      "# node dof, F_I per unit of ax ay az alx aly alz wx2 wy2 wz2 wxwy wxwz wywz (docs/formats/flx.md)\n";
  for (Eigen::Index i = 0; i < F_I.rows(); ++i) {
    text += fmt::format("{:8d} {:1d}", dof_map(i, 0), dof_map(i, 1));
    for (Eigen::Index c = 0; c < F_I.cols(); ++c) text += fmt::format(" {:24.16E}", F_I(i, c) + 0.0);
    text += "\n";
  }
  return text;
}

int run_integrals(const IntegralsOptions& o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  auto request = o.request;
  analysis::demand_file(request.model);
  analysis::demand_file(request.matrices);
  const std::string output =
      o.output.empty() ? std::filesystem::path(request.model).stem().string() + ".FLX" : o.output;
  check_outputs(o, {output, o.fi}, {request.model, request.matrices, o.layout});
  const auto layout = choose_layout(o, o.digits);
  request.digits = o.digits;
  request.inertial_loads = !o.fi.empty();
  ConsoleEvents events(console);
  const auto answer = analysis::calc_integrals(request, events);
  const auto text = flx::write_flx(answer.file, layout);
  if (answer.inertial_loads)
    analysis::write_text_file(o.fi, format_inertial_loads(*answer.inertial_loads, answer.dof_map));
  analysis::write_text_file(output, text);
  console.print(events.get_messages());
  if (o.json)
    console.print_data(format_flx_json({answer.file}));
  else
    console.print("written: " + output + (o.fi.empty() ? "" : " and " + o.fi) + "\n");
  return kSuccess;
}

}  // namespace

void add_integrals(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_integrals, "integrals", &analysis::IntegralsRequest::matrices);
  verb->add_option("model", o->request.model, "Model information file: sizes, dof map, nodes, options")->required();
  verb->add_option("matrices", o->request.matrices, "Matrices file: mass, stiffness, damping, mode shapes")->required();
  verb->add_option("--fi", o->fi, "Write the twelve inertial loads, ndof x 12, too: text, a row per dof");
  verb->add_option("--integrals", o->request.integrals, "momentum (the report's formulas) or exact")
      ->check(CLI::IsMember({"momentum", "exact"}))
      ->capture_default_str();
  add_flx_options(*verb, *o);
  add_common_options(*verb, *o, kOutput | kJson, ".FLX file to write (default: the model file's name with .FLX, here)");
}

}  // namespace bough::cli
