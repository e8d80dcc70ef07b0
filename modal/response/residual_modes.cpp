#include "modal/response/residual_modes.hpp"

#include <algorithm>

#include "fe/loads/loads.hpp"
#include "fe/statics/statics.hpp"
#include "formats/records/load_name.hpp"
#include "modal/bases/ritz.hpp"
#include "modal/null_motions.hpp"
#include "modal/response/excitation.hpp"

namespace bough::modal::response {
namespace {

void add_load(const VectorXd& F, const std::string& name, ResidualLoads& loads) {
  if (F.isZero(0)) return;
  loads.F.conservativeResize(F.size(), loads.F.cols() + 1);
  loads.F.rightCols(1) = F;
  loads.name.push_back(name);
}

/// Unit forces at the components of one point.
void add_unit_forces(const fe::Model& model, const records::DynamicDeck& deck, const records::ResidualDofs& dofs, int g,
                     ResidualLoads& loads, Diagnostics& diagnostics) {
  const std::string components = dofs.components.empty() ? "0" : dofs.components;
  for (const char digit : components) {
    const int c = digit - '0';
    const int row = find_dof(model, deck, g, c, "USET or RVDOF", dofs.at, diagnostics);
    if (row < 0) continue;
    VectorXd F = VectorXd::Zero(model.num_gdofs());
    F(row) = 1;
    turn_to_basic(model, F);
    const std::string name = "grid " + std::to_string(g) + (c > 0 ? " component " + std::to_string(c) : "");
    if ((model.T().transpose() * F).isZero(0)) {
      diagnostics.warning("modal.residual-dof", deck.locate(dofs.at),
                          name + " does not move: a force there does nothing", "take it out of the list");
      continue;
    }
    add_load(F, name, loads);
  }
}

}  // namespace

bool asks_residual_vectors(const records::Deck& deck, const records::DynamicSelection& selection) {
  if (selection.resvec) return *selection.resvec;
  const auto* param = deck.find_param("RESVEC");
  return param != nullptr && !param->value.empty() && param->value[0] == 'Y';
}

ResidualLoads collect_unit_loads(const fe::Model& model, const records::DynamicDeck& deck, Diagnostics& diagnostics) {
  ResidualLoads loads;
  loads.F.resize(model.num_gdofs(), 0);
  for (const auto& dofs : deck.dynamics.residual_dofs)
    for (int g = dofs.first; g <= dofs.last; ++g)
      if (dofs.first == dofs.last || model.find_node(g) >= 0) add_unit_forces(model, deck, dofs, g, loads, diagnostics);
  return loads;
}

ResidualLoads collect_residual_loads(const fe::Model& model, const records::DynamicDeck& deck,
                                     const records::DynamicSubcase& subcase, Diagnostics& diagnostics) {
  ResidualLoads loads;
  loads.F.resize(model.num_gdofs(), 0);
  if (subcase.load != 0)
    add_load(calc_load(model, deck, subcase.load, diagnostics), records::name_load(subcase), loads);
  if (subcase.dynamics.dload != 0) {
    const auto is_transient = [&](const records::DynamicLoad& load) {
      return load.kind == records::DynamicLoad::Kind::Tload1 || load.kind == records::DynamicLoad::Kind::Tload2;
    };
    const bool is_over_time = std::any_of(deck.dynamics.loads.begin(), deck.dynamics.loads.end(), is_transient);
    const auto excitation = calc_excitation(model, deck, subcase, is_over_time, diagnostics);
    for (Eigen::Index c = 0; c < excitation.F.cols(); ++c)
      add_load(excitation.F.col(c), "DLOAD " + std::to_string(subcase.dynamics.dload), loads);
  }
  const auto units = collect_unit_loads(model, deck, diagnostics);
  for (Eigen::Index c = 0; c < units.F.cols(); ++c)
    add_load(units.F.col(c), units.name[static_cast<std::size_t>(c)], loads);
  return loads;
}

std::vector<std::string> append_residual_vectors(const fe::System& system, const ResidualLoads& loads,
                                                 EigenPairs& pairs) {
  if (loads.F.cols() == 0) return {};
  std::vector<int> supports;
  if (pairs.num_rigid > 0 || pairs.num_massless > 0) {
    const auto motions = detail::find_null_motions(detail::Pencil(system));
    supports = motions.held;
    supports.insert(supports.end(), motions.supports.begin(), motions.supports.end());
    std::sort(supports.begin(), supports.end());
    supports.erase(std::unique(supports.begin(), supports.end()), supports.end());
  }
  const fe::StaticSolver solver(system.model, system.K, std::move(supports));
  const auto solve = [&](const MatrixXd& F) { return solver.solve(F); };
  const auto num_rigid = pairs.num_rigid, n = static_cast<int>(pairs.lambda.size());
  const auto residual = bases::calc_residual_vectors(system.model, solve, pairs.Phi.leftCols(num_rigid),
                                                     pairs.Phi.rightCols(n - num_rigid), loads.F);
  const auto more = residual.modes.lambda.size();
  pairs.lambda.conservativeResize(n + more);
  pairs.lambda.tail(more) = residual.modes.lambda;
  pairs.residual.conservativeResize(n + more);
  pairs.residual.tail(more).setZero();
  pairs.Phi.conservativeResize(pairs.Phi.rows(), n + more);
  pairs.Phi.rightCols(more) = residual.modes.Phi;
  std::vector<std::string> unused;
  for (const int i : residual.unused) unused.push_back(loads.name[static_cast<std::size_t>(i)]);
  return unused;
}

}  // namespace bough::modal::response
