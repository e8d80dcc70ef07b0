#include <map>
#include <numbers>

#include "stiffening/given_elements.hpp"

namespace bough::stiffening {

ModeCheck compare_modes(const records::FlexBody& body, const records::Deck& deck, const GivenModes& theirs,
                        Diagnostics& diagnostics) {
  const auto& Psi = theirs.Phi.values;
  const PointTable points(deck, Eigen::Vector3d::Zero(), diagnostics);
  const Eigen::MatrixXi dofs = theirs.Phi.row_dofs.rows() > 0 ? theirs.Phi.row_dofs : points.calc_default_dofs();
  const auto n = body.num_modes(), p = body.num_nodes();
  const auto m = Psi.cols();
  if (dofs.rows() != Psi.rows())
    throw InputError(
        "reduce.matrix-size", theirs.Phi.at,
        theirs.Phi.label + " has " + std::to_string(Psi.rows()) + " rows for " + std::to_string(dofs.rows()) + " dofs",
        "give a table of dofs with a line for each row of the matrix");
  const MatrixXd values = Psi;
  std::map<int, MatrixXd> given;  // 3 x m, basic
  for (Eigen::Index i = 0; i < dofs.rows(); ++i) {
    const int id = dofs(i, 0), code = dofs(i, 1);
    if (code < 1 || code > 3 || body.find_node(id) < 0) continue;
    auto& block = given[id];
    if (block.size() == 0) block.setZero(3, m);
    const fe::Node* const node = theirs.Phi.is_basic ? nullptr : points.find(id);
    const Eigen::Vector3d e =
        node ? Eigen::Vector3d(node->R_basic_cd.col(code - 1)) : Eigen::Vector3d(Eigen::Vector3d::Unit(code - 1));
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
