#include "modal/normalize.hpp"

#include <cmath>
#include <vector>

#include "modal/canonical.hpp"

namespace bough::modal {
namespace {

/// The row of a dof in its displacement axes; component 0: a scalar point.
Eigen::RowVectorXd calc_row(const fe::Node& node, int component, const MatrixXd& Phi) {
  const int row = node.first_gdof;
  if (node.num_dofs != 6) return Phi.row(row);
  const int c = component - 1;
  return node.R_basic_cd.col(c % 3).transpose() * Phi.middleRows(row + 3 * (c / 3), 3);
}

}  // namespace

void normalize(const fe::Model& model, const Norm& norm, MatrixXd& Phi, Diagnostics& diagnostics) {
  if (norm.kind != "MAX" && norm.kind != "POINT") return;
  MatrixXd free(model.num_fdofs(), Phi.cols());  // rows of the f-set, in the order of the g-set
  Eigen::Index num_free = 0;
  for (int k = 0; k < static_cast<int>(model.nodes().size()); ++k) {
    const fe::Node& node = model.node(k);
    for (int c = 0; c < node.num_dofs; ++c) {
      const int component = node.num_dofs == 1 ? 0 : c + 1;
      if (model.find_fdof(k, component) < 0) continue;
      free.row(num_free++) = calc_row(node, component, Phi);
    }
  }
  Eigen::RowVectorXd scale = detail::find_largest(free.topRows(num_free)).transpose();
  if (norm.kind == "POINT") {
    const int node = model.find_node(norm.grid);
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(Phi.cols());
    const bool is_there = node >= 0 && (model.node(node).num_dofs != 6 || (norm.component > 0 && norm.component <= 6));
    if (is_there) row = calc_row(model.node(node), norm.component, Phi);
    std::string still;
    for (Eigen::Index j = 0; j < Phi.cols(); ++j) {
      if (std::abs(row(j)) > 1e-9 * std::abs(scale(j)))
        scale(j) = row(j);
      else
        still += (still.empty() ? "" : ", ") + std::to_string(j + 1);
    }
    if (!still.empty())
      diagnostics.warning("modal.norm-point", {},
                          "grid " + std::to_string(norm.grid) + " component " + std::to_string(norm.component) +
                              " of NORM = POINT does not move in mode " + still +
                              ": its largest component is 1 instead",
                          "name a dof that moves in every mode, or use NORM MAX");
  }
  for (Eigen::Index j = 0; j < Phi.cols(); ++j)
    if (scale(j) != 0) Phi.col(j) /= scale(j);
}

}  // namespace bough::modal
