#include "modal/modes_result.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "fe/linear/blas.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/matrices/checks.hpp"
#include "fe/matrices/vector_products.hpp"
#include "modal/mode_energies.hpp"

namespace bough::modal {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

EigenPairs sort_negative(EigenPairs pairs) {
  const auto is_negative = [](double value) { return value < 0; };
  if (std::is_partitioned(pairs.lambda.begin(), pairs.lambda.end(), is_negative)) return pairs;
  std::vector<Eigen::Index> order(static_cast<std::size_t>(pairs.lambda.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_partition(order.begin(), order.end(), [&](Eigen::Index i) { return pairs.lambda(i) < 0; });
  pairs.lambda = pairs.lambda(order).eval();
  pairs.residual = pairs.residual(order).eval();
  pairs.Phi = pairs.Phi(Eigen::all, order).eval();
  if (pairs.modal_mass.size() > 0) pairs.modal_mass = pairs.modal_mass(order).eval();
  if (pairs.energy_share.size() > 0) pairs.energy_share = pairs.energy_share(order).eval();
  return pairs;
}

namespace {

/// Shapes at the grids, 6 x n each.
std::vector<MatrixXd> list_shapes(const fe::Model& model, const MatrixXd& Phi) {
  std::vector<MatrixXd> shapes;
  for (const auto& node : model.nodes())
    if (node.num_dofs == 6)
      shapes.emplace_back(Phi.cols() > 0 ? MatrixXd(Phi.middleRows(node.first_gdof, 6)) : MatrixXd(6, 0));
  return shapes;
}

}  // namespace

records::ModesResult make_modes_result(const fe::Model& model, const EigenPairs& found, bool buckling,
                                       const ModesExtras& extras) {
  records::ModesResult result;
  std::optional<EigenPairs> sorted;
  if (!buckling && !std::is_partitioned(found.lambda.begin(), found.lambda.end(), [](double v) { return v < 0; }))
    sorted = sort_negative(found);
  const EigenPairs& pairs = sorted ? *sorted : found;
  result.subcase = model.subcase().id;
  result.mass_properties =
      extras.mass ? *extras.mass : fe::calc_mass_properties(model, model.mass_kind(), Vector3d::Zero());
  const int n = static_cast<int>(pairs.lambda.size());
  std::vector<const fe::Node*> grids;
  for (const auto& node : model.nodes())
    if (node.num_dofs == 6) grids.push_back(&node);
  result.node_xyz.resize(static_cast<Eigen::Index>(grids.size()), 3);
  for (std::size_t k = 0; k < grids.size(); ++k) {
    result.node_id.push_back(grids[k]->id);
    result.node_xyz.row(static_cast<Eigen::Index>(k)) = grids[k]->x.transpose();
  }
  if (extras.has_shapes) {
    result.phi = list_shapes(model, pairs.Phi);
    result.mesh = model.calc_mesh();
  }
  result.residual = pairs.residual;
  result.num_rigid_modes = pairs.num_rigid;
  result.inertia_count = pairs.inertia_count;
  if (buckling) {
    result.load_factor = pairs.lambda;
    return result;
  }
  result.eigenvalue = pairs.lambda;
  result.frequency_hz = pairs.lambda.cwiseMax(0.0).cwiseSqrt() / (2 * M_PI);
  result.kind.assign(n, records::ModeKind::Normal);
  const VectorXd modal_mass =
      pairs.modal_mass.size() == n ? pairs.modal_mass : fe::calc_modal_mass(model, model.mass_kind(), pairs.Phi);
  const auto calc_momentum = [&](const Vector3d& point) {
    MatrixXd L(n, 6);
    const MatrixXd Phi_R = model.calc_rigid_modes(point);
    linear::multiply_dense(true, pairs.Phi, fe::calc_mass_times(model, model.mass_kind(), Phi_R), 0, L);
    return L;
  };
  result.modal_mass = modal_mass;
  result.effective_mass = modal_mass.cwiseInverse().asDiagonal() * calc_momentum(Vector3d::Zero()).cwiseAbs2();
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
    const Vector3d& x = model.node(node).x;
    about.mass = modal_mass.cwiseInverse().asDiagonal() * calc_momentum(x).cwiseAbs2();
    about.rigid = fe::calc_mass_properties(model, model.mass_kind(), x).rigid_mass;
  }
  return result;
}

}  // namespace bough::modal
