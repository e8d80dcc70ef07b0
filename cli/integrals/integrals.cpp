#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "cli/common/console.hpp"
#include "cli/common/options.hpp"
#include "cli/common/text_file.hpp"
#include "cli/flx/flx_output.hpp"
#include "formats/flx/model_input.hpp"
#include "modal/matrix_body.hpp"
#include "stiffening/reduce.hpp"

namespace bough::cli {

namespace {

using Eigen::MatrixXd;

struct IntegralsOptions : FlxOptions {
  std::string model, matrices, fi, integrals = "momentum";
};

modal::MatrixModel make_matrix_model(const flx::ModelInput& input, flx::ModelMatrices&& given) {
  modal::MatrixModel model;
  model.M = std::move(given.M);
  model.K = std::move(given.K);
  model.D = std::move(given.D);
  model.Phi.resize(given.Phi.rows(), static_cast<Eigen::Index>(input.modes.size()));
  for (std::size_t j = 0; j < input.modes.size(); ++j)
    model.Phi.col(static_cast<Eigen::Index>(j)) = given.Phi.col(input.modes[j] - 1);
  model.dofs = modal::NodalDofs::from_map(input.dof_map, input.xyz);
  model.reference = input.offset;
  model.mass = input.mass;
  model.zeta = input.zeta;
  return model;
}

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

int count_partial_nodes(const modal::NodalDofs& dofs) {
  int count = 0;
  for (int k = 0; k < dofs.num_nodes(); ++k) {
    const auto given = (dofs.row.row(k).leftCols(3).array() >= 0).count();
    if (given == 1 || given == 2) ++count;
  }
  return count;
}

void write_inertial_loads(const IntegralsOptions& o, const flx::ModelInput& input, const modal::MatrixModel& model,
                          Diagnostics& diagnostics) {
  const MatrixXd Phi_R = model.dofs.calc_rigid_modes(model.reference);
  const MatrixXd F_I = stiffening::calc_inertial_loads(model.dofs, model.M * Phi_R);
  if ((input.dof_map.col(1).array() == flx::kGeneralizedDof).any()) {
    diagnostics.warning("flx.generalized-dofs", {o.model},
                        "the loads of spin (columns 7 to 12) are zero at generalized dofs",
                        "use loads of spin from the model that was reduced");
  }
  if (const int count = count_partial_nodes(model.dofs); count > 0) {
    diagnostics.warning(
        "flx.missing-dofs", {o.model},
        fmt::format("{} nodes lack some of their translations: loads of spin that come from those are left out", count),
        "give the map all three translations at nodes with mass; in a planar model spin about its normal is not "
        "touched");
  }
  write_text_file(o.fi, format_inertial_loads(F_I, input.dof_map));
}

int run_integrals(const IntegralsOptions& o) {
  const Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  analysis::demand_file(o.model);
  analysis::demand_file(o.matrices);
  const std::string output = o.output.empty() ? std::filesystem::path(o.model).stem().string() + ".FLX" : o.output;
  check_outputs(o, {output, o.fi}, {o.model, o.matrices, o.layout});
  const auto layout = choose_layout(o, o.digits);

  Diagnostics diagnostics;
  const auto input = flx::read_model_input(o.model, diagnostics);
  diagnostics.throw_if_errors();
  auto matrices = flx::read_model_matrices(o.matrices, input, diagnostics);
  diagnostics.throw_if_errors();
  const auto model = make_matrix_model(input, std::move(matrices));
  auto body = modal::calc_matrix_body(model, input.nodes, diagnostics);
  body.name = std::filesystem::path(o.model).stem().string();

  flx::MakeOptions options;
  options.body_id = input.body_id;
  options.modopt = input.modopt;
  options.method = o.integrals == "exact" ? "exact" : "consistent";
  options.has_special_nodes = input.has_special_nodes;
  options.digits = o.digits;
  options.modes = input.modes;
  const auto file = flx::make_flx(body, options);
  const auto text = flx::write_flx(file, layout);
  if (!o.fi.empty()) write_inertial_loads(o, input, model, diagnostics);
  write_text_file(output, text);
  console.print(diagnostics);
  if (o.json)
    console.print_data(format_flx_json({file}));
  else
    console.print("written: " + output + (o.fi.empty() ? "" : " and " + o.fi) + "\n");
  return kSuccess;
}

}  // namespace

void add_integrals(CLI::App& app, Action& action) {
  auto o = std::make_shared<IntegralsOptions>();
  auto* verb = add_verb(app, "integrals", "Mass integrals of given matrices and modes (NASA-CR-202063 4.2.3)");
  verb->add_option("model", o->model, "Model information file: sizes, dof map, nodes, options")->required();
  verb->add_option("matrices", o->matrices, "Matrices file: mass, stiffness, damping, mode shapes")->required();
  verb->add_option("--fi", o->fi, "Write the twelve inertial loads, ndof x 12, too: text, a row per dof");
  verb->add_option("--integrals", o->integrals, "momentum (the report's formulas) or exact")
      ->check(CLI::IsMember({"momentum", "exact"}))
      ->capture_default_str();
  add_flx_options(*verb, *o);
  add_common_options(*verb, *o, kOutput | kJson, ".FLX file to write (default: the model file's name with .FLX, here)");
  verb->footer(
      "Example:\n  bough integrals test.inp test.mat -o test.FLX\n"
      "  bough integrals test.inp test.mat --fi test.fi --digits 17 -o test.FLX");
  verb->callback(
      [&action, o] { action = [o] { return analysis::with_file(o->matrices, [&] { return run_integrals(*o); }); }; });
}

}  // namespace bough::cli
