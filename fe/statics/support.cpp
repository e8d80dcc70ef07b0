#include <cmath>
#include <limits>

#include "fe/statics/statics.hpp"

namespace bough::fe {
namespace {

using RowVector6d = Eigen::Matrix<double, 1, 6>;

bool has_free(const Model& model, int node, int first, int last) {
  for (int c = first; c <= last; ++c)
    if (model.find_fdof(node, c) < 0) return false;
  return model.node(node).num_dofs == 6;
}

/// Row of component 1..3 of a node by rigid-body motions about `centre`, the rotations times `size`.
RowVector6d calc_rigid_row(const Node& node, int component, const Vector3d& centre, double size) {
  const Vector3d axis = node.R_basic_cd.col(component - 1);
  RowVector6d row;
  row << axis.transpose(), (node.x - centre).cross(axis).transpose() / size;
  return row;
}

template <class Score>
int find_best(const std::vector<int>& candidates, const Score& score) {
  int best = -1;
  double largest = -std::numeric_limits<double>::infinity();
  for (int k : candidates)
    if (const double value = score(k); value > largest * (1 + 1e-12 * (largest > 0 ? 1 : -1))) {
      largest = value;
      best = k;
    }
  return best;
}

std::vector<int> take_six(const Model& model, int node) {
  std::vector<int> fdofs;
  for (int c = 1; c <= 6; ++c) fdofs.push_back(model.find_fdof(node, c));
  return fdofs;
}

/// Three dofs of the first node, two of the second, one of the third: at each the most independent ones.
std::vector<int> take_321(const Model& model, const std::array<int, 3>& nodes, const Vector3d& centre, double size) {
  Eigen::Matrix<double, 6, 6> chosen;  // orthonormal rows
  std::vector<int> fdofs;
  for (int i = 0; i < 3; ++i) {
    std::vector<int> open{1, 2, 3};
    for (int take = 0; take < 3 - i; ++take) {
      RowVector6d best_row;
      double best = -1;
      size_t best_index = 0;
      for (size_t c = 0; c < open.size(); ++c) {
        RowVector6d row = calc_rigid_row(model.node(nodes[i]), open[c], centre, size);
        for (size_t f = 0; f < fdofs.size(); ++f) row -= row.dot(chosen.row(f)) * chosen.row(f);
        if (row.norm() > best * (1 + 1e-9)) {
          best = row.norm();
          best_row = row;
          best_index = c;
        }
      }
      if (best < 1e-4) return {};
      chosen.row(static_cast<int>(fdofs.size())) = best_row / best;
      fdofs.push_back(model.find_fdof(nodes[i], open[best_index]));
      open.erase(open.begin() + static_cast<std::ptrdiff_t>(best_index));
    }
  }
  return fdofs;
}

}  // namespace

std::vector<int> choose_determinate_support(const Model& model, int node_id) {
  if (node_id != 0) {
    const int node = model.find_node(node_id);
    if (node < 0)
      throw InputError("fe.missing-grid", {},
                       "the support names grid " + std::to_string(node_id) + ", which the deck does not define",
                       "name a grid of the deck");
    if (!has_free(model, node, 1, 6))
      throw InputError("fe.no-support", {},
                       "grid " + std::to_string(node_id) +
                           " has not all six dofs free with stiffness,"
                           " so it cannot hold the body",
                       "name a grid that is neither constrained nor dependent and has rotational stiffness");
    return take_six(model, node);
  }
  std::vector<int> solid, full;
  Vector3d centre = Vector3d::Zero();
  for (int k = 0; k < static_cast<int>(model.nodes().size()); ++k) {
    if (!has_free(model, k, 1, 3)) continue;
    solid.push_back(k);
    centre += model.node(k).x;
    if (has_free(model, k, 4, 6)) full.push_back(k);
  }
  if (!solid.empty()) {
    centre /= static_cast<double>(solid.size());
    const auto x = [&](int k) -> const Vector3d& { return model.node(k).x; };
    const int a = find_best(solid, [&](int k) { return (x(k) - centre).norm(); });
    const int b = find_best(solid, [&](int k) { return (x(k) - x(a)).norm(); });
    const Vector3d line = x(b) - x(a);
    const int c = find_best(solid, [&](int k) { return line.cross(x(k) - x(a)).norm(); });
    // Nodes on one line leave the rotation about it; a single node with rotations then holds all.
    if (line.cross(x(c) - x(a)).norm() > 1e-3 * line.squaredNorm()) {
      const std::vector<int> fdofs = take_321(model, {a, b, c}, centre, line.norm());
      if (!fdofs.empty()) return fdofs;
    }
    if (!full.empty()) return take_six(model, find_best(full, [&](int k) { return -(x(k) - centre).norm(); }));
  }
  throw InputError("fe.no-support", {},
                   "no statically determinate support was found, expected three free grids off one line, or one grid "
                   "with six free dofs",
                   "name the support grid");
}

}  // namespace bough::fe
