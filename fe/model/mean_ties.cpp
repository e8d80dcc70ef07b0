#include "fe/model/mean_ties.hpp"

#include <algorithm>

#include "fe/model/tie_rows.hpp"

namespace bough::fe {
namespace {

/// Translations and rotations of a grid in terms of the f-dofs.
struct GridRows {
  TieRows u, theta;
};

GridRows get_grid_rows(const Model& model, const Node& node) {
  return {get_tie_rows(model, node.first_gdof), get_tie_rows(model, node.first_gdof + 3)};
}

/// Returns true if the f-dofs of the rows are all of the grid itself.
bool are_own(const Model& model, const Node& node, const TieRows& rows) {
  return std::all_of(rows.begin(), rows.end(),
                     [&](const auto& term) { return model.describe_fdof(term.first).first == node.id; });
}

}  // namespace

MeanTies::MeanTies(const records::Deck& deck, const Model& model, const RigidArms& arms)
    : means_(list_weighted_means(deck, model)) {
  std::vector<GridRows> of_means;
  for (const WeightedMean& mean : means_) of_means.push_back(get_grid_rows(model, model.node(mean.reference)));
  for (const int id : arms.others()) {
    const int k = model.find_node(id);
    const Node& node = model.node(k);
    MeanTie tie;
    tie.node = k;
    bool is_found = false;
    const GridRows rows = node.num_dofs == 6 ? get_grid_rows(model, node) : GridRows();
    const bool translates = !are_own(model, node, rows.u), rotates = !are_own(model, node, rows.theta);
    for (std::size_t m = 0; m < means_.size() && node.num_dofs == 6 && !is_found; ++m) {
      const WeightedMean& mean = means_[m];
      const Vector3d arm = node.x - model.node(mean.reference).x;
      // A reference grid that turns by itself carries no arms of the mean.
      if (k != mean.reference && !mean.rotates) continue;
      is_found = (!translates || are_rigid(rows.u, of_means[m].u, of_means[m].theta, arm)) &&
                 (!rotates || are_rigid(rows.theta, of_means[m].theta, TieRows(), Vector3d::Zero()));
      if (k == mean.reference) is_found = translates && rotates == mean.rotates;
      if (!is_found) continue;
      tie.mean = static_cast<int>(m);
      tie.translates = translates;
      tie.rotates = rotates;
      tie.arm = node.x - mean.centre;
    }
    if (is_found)
      ties_.push_back(tie);
    else
      others_.push_back(id);
  }
  std::sort(ties_.begin(), ties_.end(), [](const MeanTie& a, const MeanTie& b) { return a.node < b.node; });
}

const MeanTie* MeanTies::find(int node) const {
  const auto found =
      std::lower_bound(ties_.begin(), ties_.end(), node, [](const MeanTie& tie, int k) { return tie.node < k; });
  return found != ties_.end() && found->node == node ? &*found : nullptr;
}

}  // namespace bough::fe
