#include "analysis/split/path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <set>

namespace bough::analysis::splitting {

namespace {

using Eigen::Vector3d;

using Neighbours = std::map<int, std::vector<std::pair<int, double>>>;  ///< grid: neighbour, distance

constexpr std::size_t kMaxFullyJoined = 27;  ///< grids of a card that are joined pair by pair; more by the first

void join_grids(const std::vector<int>& grids, const std::map<int, Vector3d>& position, Neighbours& neighbours) {
  std::vector<int> placed;
  for (const int grid : grids)
    if (position.count(grid) > 0) placed.push_back(grid);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (i > 0 && placed.size() > kMaxFullyJoined) break;
    for (std::size_t j = i + 1; j < placed.size(); ++j) {
      const double distance = (position.at(placed[i]) - position.at(placed[j])).norm();
      neighbours[placed[i]].emplace_back(placed[j], distance);
      neighbours[placed[j]].emplace_back(placed[i], distance);
    }
  }
}

Neighbours find_neighbours(const Structure& structure) {
  Neighbours neighbours;
  for (const auto& element : structure.elements)
    if (is_structural(element)) join_grids(element.grids, structure.position, neighbours);
  for (const auto& rigid : structure.rigid) join_grids(rigid.grids, structure.position, neighbours);
  return neighbours;
}

/// Dijkstra's shortest paths from `sources`; grids out of reach are not in the map.
std::map<int, double> calc_distances(const Neighbours& neighbours, const std::vector<int>& sources) {
  using Entry = std::pair<double, int>;
  std::map<int, double> distance;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (const int source : sources) open.emplace(0.0, source);
  while (!open.empty()) {
    const auto [reached, grid] = open.top();
    open.pop();
    if (!distance.emplace(grid, reached).second) continue;
    for (const auto& [other, length] : neighbours.at(grid))
      if (distance.count(other) == 0) open.emplace(reached + length, other);
  }
  return distance;
}

/// The held grids that neighbours connect with the first of them.
std::vector<int> find_held_end(const Structure& structure, const Neighbours& neighbours) {
  std::set<int> held;
  for (const auto& [grid, mask] : structure.held)
    if (neighbours.count(grid) > 0) held.insert(grid);
  if (held.empty()) return {};
  std::vector<int> found{*held.begin()};
  held.erase(held.begin());
  for (std::size_t i = 0; i < found.size(); ++i)
    for (const auto& [other, length] : neighbours.at(found[i]))
      if (held.erase(other) > 0) found.push_back(other);
  return found;
}

int find_farthest(const std::map<int, double>& distance) {
  return std::max_element(distance.begin(), distance.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

std::map<int, double> calc_path(const Structure& structure) {
  const auto neighbours = find_neighbours(structure);
  if (neighbours.empty())
    throw InputError("split.no-elements", structure.locate({}), "no element of the deck joins two grids",
                     "give the bulk data of a structure");
  auto sources = find_held_end(structure, neighbours);
  if (sources.empty()) sources = {find_farthest(calc_distances(neighbours, {neighbours.begin()->first}))};
  auto distance = calc_distances(neighbours, sources);
  for (const auto& [grid, others] : neighbours)
    if (distance.count(grid) == 0)
      throw InputError("split.loose-parts", structure.locate_grid(grid),
                       fmt::format("no element leads from grid {} to grid {}: the structure is in several pieces",
                                   sources.front(), grid),
                       "join the pieces, or split the deck with --elements");
  return distance;
}

Vector3d find_long_axis(const Structure& structure) {
  Vector3d mean = Vector3d::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  double count = 0;
  const auto visit = [&](const std::function<void(const Vector3d&)>& use) {
    for (const auto& element : structure.elements) {
      if (!is_structural(element)) continue;
      for (const int grid : element.grids)
        if (const auto found = structure.position.find(grid); found != structure.position.end()) use(found->second);
    }
  };
  visit([&](const Vector3d& x) { mean += x, count += 1; });
  mean /= std::max(count, 1.0);
  visit([&](const Vector3d& x) { moments += (x - mean) * (x - mean).transpose(); });
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments);
  Vector3d axis = solver.eigenvectors().col(2);
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis(largest) < 0 ? Vector3d(-axis) : axis;
}

}  // namespace

std::map<int, double> calc_coordinate(const Structure& structure, const std::string& along) {
  if (along == "path") return calc_path(structure);
  Vector3d axis = Vector3d::Zero();
  if (along == "long")
    axis = find_long_axis(structure);
  else
    axis(along.front() - 'x') = 1;
  std::map<int, double> coordinate;
  for (const auto& element : structure.elements) {
    if (!is_structural(element)) continue;
    for (const int grid : element.grids)
      if (const auto found = structure.position.find(grid); found != structure.position.end())
        coordinate[grid] = axis.dot(found->second);
  }
  return coordinate;
}

}  // namespace bough::analysis::splitting
