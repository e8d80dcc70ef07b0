#include "fe/model/rigid_arms.hpp"

#include <algorithm>
#include <set>

#include "base/rotation.hpp"
#include "fe/model/tie_rows.hpp"

namespace bough::fe {
namespace {

/// Allowed error of the coefficients of an equation, relative to 1 and the length of the arm.
constexpr double kEquationTolerance = 1e-9;

}  // namespace

TieRows get_tie_rows(const Model& model, int first_gdof) {
  TieRows rows;
  for (int a = 0; a < 3; ++a)
    for (SparseRows::InnerIterator it(model.T(), first_gdof + a); it; ++it) {
      if (it.value() == 0) continue;
      rows.try_emplace(static_cast<int>(it.col()), Vector3d::Zero()).first->second[a] = it.value();
    }
  return rows;
}

bool are_rigid(const TieRows& rows, const TieRows& u, const TieRows& theta, const Vector3d& arm) {
  std::set<int> columns;
  for (const auto* some : {&rows, &u, &theta})
    for (const auto& [column, value] : *some) columns.insert(column);
  const auto get = [](const TieRows& some, int column) {
    const auto found = some.find(column);
    return found == some.end() ? Vector3d(Vector3d::Zero()) : found->second;
  };
  const double tolerance = kEquationTolerance * (1 + arm.norm());
  return std::all_of(columns.begin(), columns.end(), [&](int column) {
    const Vector3d expected = get(u, column) + get(theta, column).cross(arm);
    return (get(rows, column) - expected).cwiseAbs().maxCoeff() <= tolerance;
  });
}

RigidArms::RigidArms(const Model& model) {
  std::vector<int> owner(static_cast<std::size_t>(model.num_fdofs()));
  for (int q = 0; q < model.num_fdofs(); ++q)
    owner[static_cast<std::size_t>(q)] = model.find_node(model.describe_fdof(q).first);
  const auto list_others = [&](const TieRows& rows, int node) {
    std::set<int> nodes;
    for (const auto& [column, value] : rows)
      if (owner[static_cast<std::size_t>(column)] != node) nodes.insert(owner[static_cast<std::size_t>(column)]);
    return nodes;
  };
  for (std::size_t k = 0; k < model.nodes().size(); ++k) {
    const Node& node = model.nodes()[k];
    RigidArm arm;
    arm.node = static_cast<int>(k);
    bool is_joined = false, is_known = true;
    for (int part = 0; 3 * part < node.num_dofs; ++part) {
      if (node.num_dofs != 6) {
        for (SparseRows::InnerIterator it(model.T(), node.first_gdof); it; ++it)
          if (it.value() != 0 && owner[static_cast<std::size_t>(it.col())] != arm.node) is_joined = true;
        is_known = !is_joined;
        break;
      }
      const TieRows rows = get_tie_rows(model, node.first_gdof + 3 * part);
      const auto parents = list_others(rows, arm.node);
      if (parents.empty()) continue;
      const int parent = *parents.begin();
      const Node& other = model.nodes()[static_cast<std::size_t>(parent)];
      is_known = is_known && parents.size() == 1 && other.num_dofs == 6 && (!is_joined || parent == arm.parent);
      is_joined = true;
      if (!is_known) break;
      arm.parent = parent;
      arm.arm = node.x - other.x;
      const TieRows u = get_tie_rows(model, other.first_gdof), theta = get_tie_rows(model, other.first_gdof + 3);
      is_known = part == 0 ? are_rigid(rows, u, theta, arm.arm) : are_rigid(rows, theta, TieRows(), arm.arm);
      (part == 0 ? arm.translates : arm.rotates) = true;
    }
    if (is_joined && !is_known) others_.push_back(node.id);
    if (is_joined && is_known) arms_.push_back(arm);
  }
}

const RigidArm* RigidArms::find(int node) const {
  const auto found =
      std::lower_bound(arms_.begin(), arms_.end(), node, [](const RigidArm& arm, int k) { return arm.node < k; });
  return found != arms_.end() && found->node == node ? &*found : nullptr;
}

}  // namespace bough::fe
