#include "analysis/integrals/integrals.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "analysis/common/choices.hpp"
#include "analysis/common/inputs.hpp"
#include "formats/flx/model_input.hpp"
#include "modal/matrix_body.hpp"
#include "stiffening/reduce.hpp"

namespace bough::analysis {

namespace {

using Eigen::MatrixXd;

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

int count_partial_nodes(const modal::NodalDofs& dofs) {
  int count = 0;
  for (int k = 0; k < dofs.num_nodes(); ++k) {
    const auto given = (dofs.row.row(k).leftCols(3).array() >= 0).count();
    if (given == 1 || given == 2) ++count;
  }
  return count;
}

MatrixXd calc_inertial_loads(const std::string& file, const flx::ModelInput& input, const modal::MatrixModel& model,
                             Diagnostics& diagnostics) {
  const MatrixXd Phi_R = model.dofs.calc_rigid_modes(model.reference);
  if ((input.dof_map.col(1).array() == flx::kGeneralizedDof).any()) {
    diagnostics.warning("flx.generalized-dofs", {file},
                        "the loads of spin (columns 7 to 12) are zero at generalized dofs",
                        "use loads of spin from the model that was reduced");
  }
  if (const int count = count_partial_nodes(model.dofs); count > 0) {
    diagnostics.warning(
        "flx.missing-dofs", {file},
        fmt::format("{} nodes lack some of their translations: loads of spin that come from those are left out", count),
        "give the map all three translations at nodes with mass; in a planar model spin about its normal is not "
        "touched");
  }
  return stiffening::calc_inertial_loads(model.dofs, model.M * Phi_R);
}

}  // namespace

IntegralsAnswer calc_integrals(const IntegralsRequest& request, Events& events) {
  demand_file(request.model);
  demand_file(request.matrices);
  demand_word("--integrals", request.integrals, {"momentum", "exact"});
  demand_range("--digits", request.digits, 2, 17);
  Diagnostics diagnostics;
  const auto input = flx::read_model_input(request.model, diagnostics);
  diagnostics.throw_if_errors();
  auto matrices = flx::read_model_matrices(request.matrices, input, diagnostics);
  diagnostics.throw_if_errors();
  const auto model = make_matrix_model(input, std::move(matrices));
  auto body = modal::calc_matrix_body(model, input.nodes, diagnostics);
  body.name = std::filesystem::path(request.model).stem().string();

  flx::MakeOptions options;
  options.body_id = input.body_id;
  options.modopt = input.modopt;
  options.method = request.integrals == "exact" ? "exact" : "consistent";
  options.has_special_nodes = input.has_special_nodes;
  options.digits = request.digits;
  options.modes = input.modes;
  IntegralsAnswer answer{flx::make_flx(body, options), input.dof_map, {}};
  if (request.inertial_loads) answer.inertial_loads = calc_inertial_loads(request.model, input, model, diagnostics);
  add_messages(diagnostics, events);
  return answer;
}

}  // namespace bough::analysis
