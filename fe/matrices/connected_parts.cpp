#include "fe/matrices/connected_parts.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include <Eigen/Eigenvalues>

#include "fe/matrices/checks.hpp"

namespace bough::fe {

namespace {

/// Disjoint sets of the numbers 0 to n - 1.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int i) {
    while (parent_[static_cast<std::size_t>(i)] != i)
      i = parent_[static_cast<std::size_t>(i)] =
          parent_[static_cast<std::size_t>(parent_[static_cast<std::size_t>(i)])];
    return i;
  }
  void join(int i, int j) { parent_[static_cast<std::size_t>(find(i))] = find(j); }

 private:
  std::vector<int> parent_;
};

/// Node of each g-dof.
std::vector<int> list_owners(const Model& model) {
  std::vector<int> owner(static_cast<std::size_t>(model.num_gdofs()), -1);
  for (std::size_t k = 0; k < model.nodes().size(); ++k)
    for (int c = 0; c < model.nodes()[k].num_dofs; ++c)
      owner[static_cast<std::size_t>(model.nodes()[k].first_gdof + c)] = static_cast<int>(k);
  return owner;
}

/// Constrained dofs (rows of the g-set) that a card constrains, not AUTOSPC.
std::vector<int> list_constrained(const Model& model) {
  std::set<int> automatic;
  for (const auto& entry : model.autospc())
    automatic.insert(model.node(model.find_node(entry.node)).first_gdof + std::max(entry.component - 1, 0));
  std::vector<int> dofs;
  for (const int dof : model.fixed_dofs())
    if (automatic.count(dof) == 0) dofs.push_back(dof);
  return dofs;
}

/// Stiffness of elements with one node: springs to ground. Blocks of DMIG are parts of a sum.
template <class Visit>
void visit_ground_springs(const Model& model, const Visit& visit) {
  for (const auto& element : model.elements()) {
    if (element->nodes().size() != 1 || element->card() == "DMIG") continue;
    MatrixXd K = MatrixXd::Zero(element->num_dofs(), element->num_dofs());
    element->add_stiffness(1, K);
    if (!K.isZero(0)) visit(*element, K);
  }
}

std::string describe_ids(const Model& model, const ConnectedPart& part) {
  std::vector<int> grids, points;
  for (const int k : part.nodes) (model.node(k).num_dofs == 6 ? grids : points).push_back(model.node(k).id);
  const auto range = [](const std::vector<int>& ids, const std::string& name) {
    return ids.size() == 1 ? name + " " + std::to_string(ids.front())
                           : name + "s " + std::to_string(ids.front()) + " to " + std::to_string(ids.back());
  };
  const auto count = [](std::size_t n, const std::string& name) {
    return std::to_string(n) + " " + name + (n == 1 ? "" : "s");
  };
  std::string text;
  if (!grids.empty()) text += count(grids.size(), "grid") + ", ";
  if (!points.empty()) text += count(points.size(), "scalar point") + ", ";
  text += count(static_cast<std::size_t>(part.num_elements), "element");
  if (!grids.empty()) text += ", " + range(grids, "grid");
  if (!points.empty()) text += ", " + range(points, "scalar point");
  return text;
}

}  // namespace

std::vector<ConnectedPart> find_connected_parts(const Model& model) {
  const std::size_t n = model.nodes().size();
  DisjointSets sets(n);
  std::vector<char> is_joined(n, 0), is_held(n, 0);
  const auto join = [&](int a, int b) {
    if (a == b) return;
    sets.join(a, b);
    is_joined[static_cast<std::size_t>(a)] = is_joined[static_cast<std::size_t>(b)] = 1;
  };
  for (const auto& element : model.elements())
    for (const int k : element->nodes()) join(element->nodes().front(), k);
  const auto owner = list_owners(model);
  std::vector<int> first(static_cast<std::size_t>(model.T().cols()), -1);  // node of each column
  const auto join_columns = [&](const SparseRows& T) {
    for (int row = 0; row < T.outerSize(); ++row)
      for (SparseRows::InnerIterator it(T, row); it; ++it) {
        int& node = first[static_cast<std::size_t>(it.col())];
        const int other = owner[static_cast<std::size_t>(row)];
        if (node < 0)
          node = other;
        else if (it.value() != 0)
          join(node, other);
      }
  };
  if (!model.omitted()) join_columns(model.T());  // dofs that ASET leaves out follow along elements
  first.clear();
  for (const int dof : model.fixed_dofs()) first.push_back(owner[static_cast<std::size_t>(dof)]);
  join_columns(model.T_fixed());

  for (const int dof : list_constrained(model)) {
    const int k = owner[static_cast<std::size_t>(dof)];
    if (model.node(k).num_dofs == 1 || dof - model.node(k).first_gdof < 3) is_held[static_cast<std::size_t>(k)] = 1;
  }
  visit_ground_springs(model, [&](const Element& element, const MatrixXd&) {
    is_joined[static_cast<std::size_t>(element.nodes().front())] = 1;
    is_held[static_cast<std::size_t>(element.nodes().front())] = 1;
  });

  std::map<int, ConnectedPart> by_root;
  for (std::size_t k = 0; k < n; ++k) {
    if (!is_joined[k]) continue;
    ConnectedPart& part = by_root[sets.find(static_cast<int>(k))];
    part.nodes.push_back(static_cast<int>(k));
    part.is_held = part.is_held || is_held[k];
  }
  for (const auto& element : model.elements())
    if (!element->nodes().empty())
      if (const auto at = by_root.find(sets.find(element->nodes().front())); at != by_root.end())
        ++at->second.num_elements;
  std::vector<ConnectedPart> parts;
  for (auto& [root, part] : by_root) {
    std::sort(part.nodes.begin(), part.nodes.end(), [&](int a, int b) { return model.node(a).id < model.node(b).id; });
    parts.push_back(std::move(part));
  }
  std::sort(parts.begin(), parts.end(), [&](const ConnectedPart& a, const ConnectedPart& b) {
    if (a.nodes.size() != b.nodes.size()) return a.nodes.size() > b.nodes.size();
    return model.node(a.nodes.front()).id < model.node(b.nodes.front()).id;
  });
  return parts;
}

int count_held_motions(const Model& model) {
  using Matrix6d = Eigen::Matrix<double, 6, 6>;
  Vector3d centre = Vector3d::Zero();
  double size = 0, number = 0;
  for (const Node& node : model.nodes())
    if (node.num_dofs == 6) centre += node.x, number += 1;
  if (number > 0) centre /= number;
  for (const Node& node : model.nodes())
    if (node.num_dofs == 6) size = std::max(size, (node.x - centre).norm());
  if (!(size > 0)) size = 1;
  MatrixXd R = model.calc_rigid_modes(centre);
  R.rightCols<3>() /= size;
  const auto owner = list_owners(model);
  Matrix6d held = Matrix6d::Zero();
  const auto add = [&](Eigen::Matrix<double, 1, 6> row) {
    if (row.norm() > 0) row /= row.norm(), held += row.transpose() * row;
  };
  for (const int dof : list_constrained(model)) {
    const Node& node = model.node(owner[static_cast<std::size_t>(dof)]);
    if (node.num_dofs != 6) continue;
    const int c = dof - node.first_gdof;
    add(node.R_basic_cd.col(c % 3).transpose() * R.middleRows<3>(node.first_gdof + 3 * (c / 3)));
  }
  visit_ground_springs(model, [&](const Element& element, const MatrixXd& K) {
    if (model.node(element.nodes().front()).num_dofs != 6) return;
    const MatrixXd forces = K * R(element.gdofs(), Eigen::all);
    for (Eigen::Index i = 0; i < forces.rows(); ++i) add(forces.row(i));
  });
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(held);
  return static_cast<int>((solver.eigenvalues().array() > 1e-10 * std::max(1.0, solver.eigenvalues()(5))).count());
}

LooseParts describe_loose_parts(const Model& model) {
  constexpr int kMaxNamed = 5;
  const auto parts = find_connected_parts(model);
  const bool is_any_held = std::any_of(parts.begin(), parts.end(), [](const auto& part) { return part.is_held; });
  std::vector<std::size_t> loose;
  for (std::size_t p = 0; p < parts.size(); ++p)
    if (!parts[p].is_held && (is_any_held || p > 0)) loose.push_back(p);
  if (loose.empty() || parts.size() < 2) return {};

  std::map<int, std::size_t> part_of;  // by grid id
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (const int k : parts[p].nodes)
      if (model.node(k).num_dofs == 6) part_of[model.node(k).id] = p;
  std::map<std::size_t, std::vector<std::array<int, 2>>> touching;  // pairs of grids, that of the part first
  for (const auto& [a, b] : find_coincident_grids(model, choose_coincidence(model))) {
    const auto p = part_of.find(a), q = part_of.find(b);
    if (p == part_of.end() || q == part_of.end() || p->second == q->second) continue;
    touching[p->second].push_back({a, b});
    touching[q->second].push_back({b, a});
  }
  LooseParts result;
  result.what = std::to_string(parts.size()) + " parts";
  for (std::size_t i = 0; i < loose.size() && i < kMaxNamed; ++i) {
    const std::size_t p = loose[i];
    result.what += "; part " + std::to_string(p + 1) + ": " + describe_ids(model, parts[p]) + ", touches nothing";
    const auto at = touching.find(p);
    if (at == touching.end()) continue;
    const auto [own, other] = at->second.front();
    result.what += "; its grid " + std::to_string(own) + " lies on grid " + std::to_string(other) + " of part " +
                   std::to_string(part_of.at(other) + 1);
    if (const auto more = at->second.size() - 1; more > 0) result.what += " and " + std::to_string(more) + " more so";
  }
  if (loose.size() > kMaxNamed)
    result.what += "; and " + std::to_string(loose.size() - kMaxNamed) + " more that touch nothing";
  const bool is_coincident = std::any_of(loose.begin(), loose.end(), [&](auto p) { return touching.count(p) > 0; });
  result.advice = is_coincident ? "merge them, or join them by rigid elements or springs"
                                : "join the parts by elements, rigid elements or MPC, or take them out of the deck";
  return result;
}

}  // namespace bough::fe
