#include <map>
#include <numbers>

#include "fe/model/coordinates.hpp"
#include "stiffening/reduce_matrices.hpp"

namespace bough::stiffening {

namespace {

/// R_basic_cd of each grid; none for a matrix in basic axes.
std::map<int, Eigen::Matrix3d> list_axes(const records::Deck& deck, bool is_basic, Diagnostics& diagnostics) {
  std::map<int, Eigen::Matrix3d> axes;
  if (is_basic) return axes;
  const fe::CoordinateSystems systems(deck, Eigen::Vector3d::Zero(), diagnostics);
  for (std::size_t i = 0; i < deck.grids.size(); ++i) {
    const auto& grid = deck.grids[i];
    if (grid.cd != 0)
      axes[grid.id] =
          systems.calc_axes(grid.cd, systems.get_grid_position(static_cast<int>(i)), deck.locate(grid.at), diagnostics);
  }
  return axes;
}

/// Grids and scalar points by id, as a file without a list of dofs has them.
Eigen::MatrixXi list_default_dofs(const records::Deck& deck) {
  std::map<int, int> sizes;
  for (const int id : deck.scalar_points) sizes[id] = 1;
  for (const auto& grid : deck.grids) sizes[grid.id] = 6;
  std::vector<std::pair<int, int>> rows;
  for (const auto& [id, size] : sizes)
    for (int c = 0; c < size; ++c) rows.emplace_back(id, size == 1 ? 0 : c + 1);
  Eigen::MatrixXi dofs(static_cast<Eigen::Index>(rows.size()), 2);
  for (std::size_t i = 0; i < rows.size(); ++i) dofs.row(static_cast<Eigen::Index>(i)) << rows[i].first, rows[i].second;
  return dofs;
}

}  // namespace

ModeCheck compare_modes(const records::FlexBody& body, const records::Deck& deck, const GivenModes& theirs,
                        Diagnostics& diagnostics) {
  const auto& Psi = theirs.Phi.values;
  const Eigen::MatrixXi dofs = theirs.Phi.row_dofs.rows() > 0 ? theirs.Phi.row_dofs : list_default_dofs(deck);
  const auto n = body.num_modes(), p = body.num_nodes();
  const auto m = Psi.cols();
  if (dofs.rows() != Psi.rows())
    throw InputError(
        "reduce.matrix-size", theirs.Phi.at,
        theirs.Phi.label + " has " + std::to_string(Psi.rows()) + " rows for " + std::to_string(dofs.rows()) + " dofs",
        "give a table of dofs with a line for each row of the matrix");
  const auto axes = list_axes(deck, theirs.Phi.is_basic, diagnostics);
  const MatrixXd values = Psi;
  std::map<int, MatrixXd> given;  // 3 x m, basic
  for (Eigen::Index i = 0; i < dofs.rows(); ++i) {
    const int id = dofs(i, 0), code = dofs(i, 1);
    if (code < 1 || code > 3 || body.find_node(id) < 0) continue;
    auto& block = given[id];
    if (block.size() == 0) block.setZero(3, m);
    const auto R = axes.find(id);
    const Eigen::Vector3d e =
        R == axes.end() ? Eigen::Vector3d(Eigen::Vector3d::Unit(code - 1)) : Eigen::Vector3d(R->second.col(code - 1));
    block += e * values.row(i);
  }
  if (given.empty())
    throw InputError("reduce.no-common-nodes", theirs.Phi.at,
                     theirs.Phi.label + " has no node of the " + std::to_string(p) + " output nodes of the body",
                     "name output nodes that both have");

  MatrixXd cross = MatrixXd::Zero(n, m);
  VectorXd ours = VectorXd::Zero(n), others = VectorXd::Zero(m);
  for (const auto& [id, block] : given) {
    const MatrixXd phi = body.phi[static_cast<std::size_t>(body.find_node(id))].topRows(3);
    cross += phi.transpose() * block;
    ours += phi.cwiseAbs2().colwise().sum().transpose();
    others += block.cwiseAbs2().colwise().sum().transpose();
  }
  ModeCheck check;
  const MatrixXd scale = ours * others.transpose();
  check.mac = (scale.array() > 0).select(cross.array().square() / scale.array(), 0.0);
  check.frequency_hz = VectorXd::Constant(m, -1);
  if (theirs.eigenvalue.size() == m)
    check.frequency_hz = theirs.eigenvalue.cwiseMax(0).cwiseSqrt() / (2 * std::numbers::pi);
  return check;
}

}  // namespace bough::stiffening
