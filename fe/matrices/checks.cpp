#include "fe/matrices/checks.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include <Eigen/Geometry>

#include "fe/matrices/assembly.hpp"
#include "fe/model/element_loop.hpp"

namespace bough::fe {

using Vector6d = Eigen::Matrix<double, 6, 1>;

Vector6d calc_ground_check(const Model& model, GroundSet set) {
  if (set == GroundSet::Global) return calc_ground_check(model);
  // Rigid-body motion of the independent dofs in their CD axes; T makes the dependent ones follow.
  Vector3d centre = Vector3d::Zero();
  for (const Node& node : model.nodes()) centre += node.x / static_cast<double>(model.nodes().size());
  MatrixXd motion = model.calc_rigid_modes(centre);
  for (const Node& node : model.nodes()) {
    if (node.num_dofs != 6) continue;
    for (const int part : {0, 3}) {
      auto rows = motion.middleRows<3>(node.first_gdof + part);
      rows = (node.R_basic_cd.transpose() * rows).eval();
    }
  }
  MatrixXd q(model.num_fdofs(), 6);
  for (int k = 0; k < static_cast<int>(model.nodes().size()); ++k) {
    const Node& node = model.node(k);
    for (int c = 0; c < node.num_dofs; ++c)
      if (const int f = model.find_fdof(k, node.num_dofs == 1 ? 0 : c + 1); f >= 0)
        q.row(f) = motion.row(node.first_gdof + c);
  }
  MatrixXd u = model.T() * q;
  if (set == GroundSet::Independent) u += model.T_fixed() * MatrixXd(motion(model.fixed_dofs(), Eigen::all));
  const MatrixXd K_u = calc_stiffness_times(model, u);
  // The scale is the diagonal's energy, element by element.
  MatrixXd scale = MatrixXd::Zero(6, 1);
  visit_elements(model, get_own_elements(model), [&](int, const Element& element) {
    MatrixXd K = MatrixXd::Zero(element.num_dofs(), element.num_dofs());
    element.add_stiffness(1, K);
    for (int i = 0; i < element.num_dofs(); ++i)
      scale += K(i, i) * u.row(element.gdofs()[static_cast<std::size_t>(i)]).cwiseAbs2().transpose();
  });
  linear::sum_over_ranks(scale);
  Vector6d result = Vector6d::Zero();
  for (int r = 0; r < 6; ++r)
    if (scale(r, 0) > 0) result[r] = std::abs(u.col(r).dot(K_u.col(r))) / scale(r, 0);
  return result;
}

double choose_coincidence(const Model& model) {
  Eigen::AlignedBox3d box;
  for (const Node& node : model.nodes())
    if (node.num_dofs == 6) box.extend(node.x);
  return box.isEmpty() ? 0 : 1e-6 * box.diagonal().norm();
}

/// A deck may have a million grids in one place.
constexpr std::size_t most_partners = 10;

std::vector<std::array<int, 2>> find_coincident_grids(const Model& model, double tolerance) {
  // Along one axis first: only neighbours within the tolerance are compared.
  std::vector<const Node*> grids;
  for (const Node& node : model.nodes())
    if (node.num_dofs == 6) grids.push_back(&node);
  const Vector3d axis = Vector3d(0.48, 0.6, 0.64);
  std::sort(grids.begin(), grids.end(), [&](const Node* a, const Node* b) { return axis.dot(a->x) < axis.dot(b->x); });
  std::vector<std::array<int, 2>> pairs;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const std::size_t before = pairs.size();
    for (std::size_t j = i + 1; j < grids.size() && axis.dot(grids[j]->x - grids[i]->x) <= tolerance; ++j) {
      if ((grids[j]->x - grids[i]->x).norm() > tolerance) continue;
      pairs.push_back({std::min(grids[i]->id, grids[j]->id), std::max(grids[i]->id, grids[j]->id)});
      if (pairs.size() == before + most_partners) break;
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<int> find_unused_grids(const Model& model, const records::Deck& deck) {
  std::set<int> used;
  for (const auto& element : model.elements())
    for (int k : element->nodes()) used.insert(model.node(k).id);
  for (const auto& e : deck.beams) used.insert(e.g0);
  for (const auto& e : deck.cbush) used.insert(e.g0);
  for (const auto& s : deck.coord_systems)
    if (s.by_grids) used.insert(s.grids.begin(), s.grids.end());
  for (const auto& e : deck.rbe2) {
    used.insert(e.gn);
    used.insert(e.gm.begin(), e.gm.end());
  }
  for (const auto& e : deck.rbe3) {
    used.insert(e.ref_grid);
    for (const auto& group : e.groups) used.insert(group.grids.begin(), group.grids.end());
    for (const auto& dependent : e.um) used.insert(dependent.g);
  }
  for (const auto& e : deck.rbe1) {
    for (const auto& dof : e.independent) used.insert(dof.g);
    for (const auto& dof : e.dependent) used.insert(dof.g);
  }
  for (const auto& e : deck.special.rspline)
    for (const auto& point : e.points) used.insert(point.g);
  for (const auto& e : deck.rbar) used.insert({e.ga, e.gb});
  for (const auto& e : deck.rrod) used.insert({e.ga, e.gb});
  for (const auto& e : deck.mpc)
    for (const auto& term : e.terms) used.insert(term.g);
  std::vector<int> unused;
  for (const Node& node : model.nodes())
    if (node.num_dofs == 6 && used.count(node.id) == 0) unused.push_back(node.id);
  return unused;
}

namespace {

using Corners = std::vector<std::vector<int>>;
/// Edges, and per corner the three (solid) or two (plane) neighbours that span its Jacobian, right-handed.
struct Topology {
  std::vector<std::array<int, 2>> edges;
  Corners neighbours;
};

const Topology& get_topology(const std::string& type) {
  static const std::map<std::string, Topology> all{
      {"tri3", {{{0, 1}, {1, 2}, {2, 0}}, {{1, 2}, {2, 0}, {0, 1}}}},
      {"quad4", {{{0, 1}, {1, 2}, {2, 3}, {3, 0}}, {{1, 3}, {2, 0}, {3, 1}, {0, 2}}}},
      {"tetra4", {{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}, {{1, 2, 3}}}},
      {"pyramid5",
       {{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}},
        {{1, 3, 4}, {2, 0, 4}, {3, 1, 4}, {0, 2, 4}}}},
      {"penta6",
       {{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}},
        {{1, 2, 3}, {2, 0, 4}, {0, 1, 5}, {5, 4, 0}, {3, 5, 1}, {4, 3, 2}}}},
      {"hexa8",
       {{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}},
        {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}}}}};
  const auto found = all.find(type);
  BOUGH_DEMAND(found != all.end());
  return found->second;
}

}  // namespace

ElementQuality calc_quality(const std::string& type, const std::vector<Vector3d>& x) {
  const Topology& topology = get_topology(type);
  const auto at = [&](int i) -> const Vector3d& { return x[static_cast<std::size_t>(i)]; };
  ElementQuality quality;
  double shortest = INFINITY, longest = 0;
  for (const auto& [a, b] : topology.edges) {
    const double length = (at(b) - at(a)).norm();
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  quality.aspect = shortest > 0 ? longest / shortest : INFINITY;
  const bool is_plane = topology.neighbours[0].size() == 2;
  const Vector3d mean =
      type == "quad4" ? (at(2) - at(0)).cross(at(3) - at(1)).normalized() : Vector3d(Vector3d::Zero());
  double min_value = INFINITY, max_value = -INFINITY;
  for (int i = 0; i < static_cast<int>(topology.neighbours.size()); ++i) {
    const auto& n = topology.neighbours[static_cast<std::size_t>(i)];
    const Vector3d normal = (at(n[0]) - at(i)).cross(at(n[1]) - at(i));
    const double value = !is_plane ? normal.dot(at(n[2]) - at(i)) : type == "quad4" ? normal.dot(mean) : normal.norm();
    min_value = std::min(min_value, value);
    max_value = std::max(max_value, value);
    if (type == "quad4" && normal.norm() > 0)
      quality.warp_deg =
          std::max(quality.warp_deg, std::atan2(normal.cross(mean).norm(), normal.dot(mean)) * 180 / M_PI);
  }
  quality.jacobian = topology.neighbours.size() == 1 ? (min_value > 0 ? 1 : -1)
                     : max_value > 0                 ? min_value / max_value
                                                     : -1;
  return quality;
}

std::vector<WorstQuality> find_worst_quality(const Model& model) {
  std::map<std::string, WorstQuality> by_card;
  for (const auto& element : model.elements()) {
    const ElementShape shape = element->shape();
    if (shape.type.empty() || shape.type == "vertex" || shape.type == "line2") continue;
    std::vector<Vector3d> corners;
    for (int k : shape.nodes) corners.push_back(model.node(k).x);
    // Curved shells by their corners (their own maker refuses what folds over between them).
    const std::string type = shape.type == "quad8" ? "quad4" : shape.type == "tri6" ? "tri3" : shape.type;
    corners.resize(type == "quad4" ? 4 : type == "tri3" ? 3 : corners.size());
    const ElementQuality q = calc_quality(type, corners);
    WorstQuality& w = by_card[element->card()];
    const bool is_first = w.count++ == 0;
    if (is_first || q.aspect > w.worst.aspect * (1 + 1e-9)) w.worst.aspect = q.aspect, w.aspect_id = element->id();
    if (is_first || q.warp_deg > w.worst.warp_deg + 1e-9) w.worst.warp_deg = q.warp_deg, w.warp_id = element->id();
    if (is_first || q.jacobian < w.worst.jacobian - 1e-9) w.worst.jacobian = q.jacobian, w.jacobian_id = element->id();
  }
  std::vector<WorstQuality> result;
  for (auto& [card, worst] : by_card) {
    worst.card = card;
    result.push_back(worst);
  }
  return result;
}

}  // namespace bough::fe
