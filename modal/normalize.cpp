#include "modal/normalize.hpp"

#include <cmath>
#include <vector>

#include "fe/linear/ranks.hpp"
#include "fe/matrices/reach.hpp"
#include "modal/canonical.hpp"

namespace bough::modal {
namespace {

/// The row of a dof in its displacement axes; component 0: a scalar point. `row`: of Phi, the node's first.
Eigen::RowVectorXd calc_row(const fe::Node& node, int component, int row, const MatrixXd& Phi) {
  if (node.num_dofs != 6) return Phi.row(row);
  const int c = component - 1;
  return node.R_basic_cd.col(c % 3).transpose() * Phi.middleRows(row + 3 * (c / 3), 3);
}

}  // namespace

void normalize(const fe::Model& model, const Norm& norm, MatrixXd& Phi, Diagnostics& diagnostics) {
  if (norm.kind != "MAX" && norm.kind != "POINT") return;
  const fe::Reach reach = fe::find_reach(model);
  const bool is_cut = model.share() != nullptr;
  std::vector<int> place;
  MatrixXd free(model.num_fdofs(), Phi.cols());  // rows of the f-set, of a model by parts of this rank's nodes
  for (int k = 0; k < static_cast<int>(model.nodes().size()); ++k) {
    const fe::Node& node = model.node(k);
    if (is_cut && !model.share()->is_at_home(k)) continue;
    for (int c = 0; c < node.num_dofs; ++c) {
      const int component = node.num_dofs == 1 ? 0 : c + 1;
      if (model.find_fdof(k, component) < 0) continue;
      free.row(static_cast<Eigen::Index>(place.size())) =
          calc_row(node, component, reach.find_row(node.first_gdof), Phi);
      place.push_back(node.first_gdof + c);
    }
  }
  Eigen::RowVectorXd scale =
      detail::find_largest(place, is_cut, free.topRows(static_cast<Eigen::Index>(place.size()))).transpose();
  if (norm.kind == "POINT") {
    const int node = model.find_node(norm.grid);
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(Phi.cols());
    const bool is_there = node >= 0 && (model.node(node).num_dofs != 6 || (norm.component > 0 && norm.component <= 6));
    if (is_there && (!is_cut || model.share()->is_at_home(node)))
      row = calc_row(model.node(node), norm.component, reach.find_row(model.node(node).first_gdof), Phi);
    if (is_cut) {
      MatrixXd sum = row;  // the others have none of it
      fe::sum_over_ranks(sum);
      row = sum;
    }
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
