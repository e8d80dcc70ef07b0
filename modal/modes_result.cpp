#include "modal/modes_result.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fe/matrices/assembly.hpp"
#include "fe/matrices/checks.hpp"
#include "modal/mode_energies.hpp"

namespace bough::modal {

using Eigen::MatrixXd;
using Eigen::Vector3d;

EigenPairs sort_negative(EigenPairs pairs) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(pairs.lambda.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_partition(order.begin(), order.end(), [&](Eigen::Index i) { return pairs.lambda(i) < 0; });
  pairs.lambda = pairs.lambda(order).eval();
  pairs.residual = pairs.residual(order).eval();
  pairs.Phi = pairs.Phi(Eigen::all, order).eval();
  return pairs;
}

records::ModesResult make_modes_result(const fe::Model& model, const EigenPairs& found, bool buckling,
                                       const ModesExtras& extras) {
  records::ModesResult result;
  const EigenPairs pairs = buckling ? found : sort_negative(found);
  result.subcase = model.subcase().id;
  result.mass_properties = fe::calc_mass_properties(model, model.mass_kind(), Vector3d::Zero());
  const int n = static_cast<int>(pairs.lambda.size());
  std::vector<const fe::Node*> grids;
  for (const auto& node : model.nodes())
    if (node.num_dofs == 6) grids.push_back(&node);
  result.node_xyz.resize(static_cast<Eigen::Index>(grids.size()), 3);
  for (std::size_t k = 0; k < grids.size(); ++k) {
    result.node_id.push_back(grids[k]->id);
    result.node_xyz.row(static_cast<Eigen::Index>(k)) = grids[k]->x.transpose();
    result.phi.push_back(n > 0 ? MatrixXd(pairs.Phi.middleRows(grids[k]->first_gdof, 6)) : MatrixXd(6, 0));
  }
  result.residual = pairs.residual;
  result.num_rigid_modes = pairs.num_rigid;
  result.inertia_count = pairs.inertia_count;
  result.mesh = model.calc_mesh();
  if (buckling) {
    result.load_factor = pairs.lambda;
    return result;
  }
  result.eigenvalue = pairs.lambda;
  result.frequency_hz = pairs.lambda.cwiseMax(0.0).cwiseSqrt() / (2 * M_PI);
  result.kind.assign(n, records::ModeKind::Normal);
  const MatrixXd M_Phi = fe::calc_mass_times(model, model.mass_kind(), pairs.Phi);
  result.modal_mass = pairs.Phi.cwiseProduct(M_Phi).colwise().sum();
  result.effective_mass = calc_effective_mass(model, pairs.Phi, M_Phi);
  if (extras.energies_of != nullptr) result.energies = calc_mode_energies(model, *extras.energies_of, pairs.Phi);
  if (extras.about_grid != 0) {
    const int node = model.find_node(extras.about_grid);
    if (node < 0 || model.node(node).num_dofs != 6)
      throw InputError("modal.unknown-grid", {},
                       "effective masses are asked for about grid " + std::to_string(extras.about_grid) +
                           ", which the deck does not have",
                       "name a GRID of the deck");
    auto& about = result.effective_mass_about;
    about.grid = extras.about_grid;
    const MatrixXd Phi_R = model.calc_rigid_modes(model.node(node).x);
    about.mass = result.modal_mass.cwiseInverse().asDiagonal() * (M_Phi.transpose() * Phi_R).cwiseAbs2();
    about.rigid = fe::calc_mass_properties(model, model.mass_kind(), model.node(node).x).rigid_mass;
  }
  return result;
}

}  // namespace bough::modal
