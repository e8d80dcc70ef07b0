#include "analysis/split/assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <deque>

namespace bough::analysis::splitting {

namespace {

using Eigen::Vector3d;

constexpr std::size_t kMaxGroundGrids = 12;  ///< grids at which constraints hold one part at the ground
constexpr double kFlat = 1e-9;               ///< of the largest distance: grids on one line
constexpr unsigned kAll = 0b111111;

/// Grids of the cut by their union: two that a shell or solid has, both in at least two of the same parts. A bar along
/// the cut joins nothing: its grids are joints each.
std::vector<std::vector<int>> group_shared(const Structure& structure, const Partition& partition) {
  std::map<int, int> group;  // shared grid: lowest known member
  for (const auto& [grid, parts] : partition.grid_parts)
    if (parts.size() > 1) group[grid] = grid;
  const auto find = [&](int grid) {
    while (group.at(grid) != grid) grid = group[grid] = group.at(group.at(grid));
    return grid;
  };
  for (const auto& element : structure.elements) {
    // A connector may be at the grids of two cuts, one through the shells of each side.
    if (!is_structural(element) || element.grids.size() < 3 || !element.shells.empty()) continue;
    std::vector<int> shared;
    for (const int grid : element.grids)
      if (group.count(grid) > 0) shared.push_back(grid);
    for (std::size_t i = 0; i < shared.size(); ++i)
      for (std::size_t j = i + 1; j < shared.size(); ++j) {
        const auto &a = partition.grid_parts.at(shared[i]), &b = partition.grid_parts.at(shared[j]);
        std::vector<int> both;
        std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
        if (both.size() > 1) group[find(shared[i])] = find(shared[j]);
      }
  }
  std::map<int, std::vector<int>> members;
  for (const auto& [grid, above] : group) members[find(grid)].push_back(grid);
  std::vector<std::vector<int>> groups;
  for (auto& [first, grids] : members) groups.push_back(std::move(grids));
  std::sort(groups.begin(), groups.end());
  return groups;
}

bool is_at(const DeckItem& item, const std::vector<int>& grids) {
  return std::any_of(item.grids.begin(), item.grids.end(),
                     [&](int grid) { return std::binary_search(grids.begin(), grids.end(), grid); });
}

/// Returns true if elements of the part transfer moments to the grids.
bool has_moments(const Structure& structure, const Partition& partition, int part, const std::vector<int>& grids) {
  for (std::size_t i = 0; i < structure.elements.size(); ++i)
    if (partition.element_part[i] == part && structure.elements[i].has_moments && is_at(structure.elements[i], grids) &&
        !(grids.size() == 1 && structure.pinned.count({structure.elements[i].id, grids.front()}) > 0))
      return true;
  for (std::size_t i = 0; i < structure.rigid.size(); ++i)
    if (partition.rigid_part[i] == part && structure.rigid[i].has_moments && is_at(structure.rigid[i], grids))
      return true;
  return false;
}

/// Joints at single grids without moments, between the same parts, become one joint: longerons of a truss.
void merge_pinned(const Structure& structure, const Partition& partition, std::vector<Joint>& joints) {
  std::map<std::set<int>, std::vector<std::size_t>> pinned;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto& joint = joints[i];
    if (joint.grids.size() > 1) continue;
    if (std::any_of(joint.parts.begin(), joint.parts.end(),
                    [&](int part) { return !has_moments(structure, partition, part, joint.grids); }))
      pinned[joint.parts].push_back(i);
  }
  std::set<std::size_t> merged;
  for (const auto& [parts, list] : pinned)
    for (std::size_t k = 1; k < list.size(); ++k) {
      auto& grids = joints[list.front()].grids;
      grids.push_back(joints[list[k]].grids.front());
      std::sort(grids.begin(), grids.end());
      merged.insert(list[k]);
    }
  std::size_t next = 0;
  std::erase_if(joints, [&](const Joint&) { return merged.count(next++) > 0; });
}

int find_max_grid(const Structure& structure) {
  int max = 0;
  for (const auto& grid : structure.deck.grids) max = std::max(max, grid.id);
  for (const int point : structure.deck.scalar_points) max = std::max(max, point);
  return max;
}

void check_strength(const Structure& structure, const Partition& partition, const Joint& joint,
                    Diagnostics& diagnostics) {
  for (const int part : joint.parts) {
    if (has_moments(structure, partition, part, joint.grids)) continue;
    if (joint.grids.size() > 2 && spans_plane(structure, joint.grids)) continue;
    diagnostics.error(
        "split.weak-cut", structure.locate_grid(joint.grids.front()),
        fmt::format("the cut at {} {} leaves a joint that does not transfer all moments: rods, solids and pinned "
                    "beams there can turn about it",
                    joint.grids.size() == 1 ? "grid" : "grids", fmt::join(joint.grids, ", ")),
        "cut where beams, shells, or three grids off one line are");
    return;
  }
}

void check_independent(const Structure& structure, const Joint& joint, const std::map<int, std::string>& dependent,
                       Diagnostics& diagnostics) {
  for (const int grid : joint.grids)
    if (const auto found = dependent.find(grid); found != dependent.end())
      diagnostics.error(
          "split.dependent-cut", structure.locate_grid(grid),
          fmt::format("grid {} at a cut along several grids depends on others by {}", grid, found->second),
          "move the cut by an element");
}

/// Reports parts whose grids are all in the joint: its RBE2 leaves them no deformation.
void check_extent(const Structure& structure, const Partition& partition, const Joint& joint,
                  Diagnostics& diagnostics) {
  std::map<int, std::size_t> num_grids, num_cut;
  for (const auto& [grid, parts] : partition.grid_parts)
    for (const int part : parts) ++num_grids[part];
  for (const int grid : joint.grids)
    for (const int part : partition.grid_parts.at(grid)) ++num_cut[part];
  for (const auto& [part, number] : num_cut) {
    if (number < num_grids[part]) continue;
    std::vector<std::size_t> own;
    for (std::size_t i = 0; i < structure.elements.size(); ++i)
      if (partition.element_part[i] == part) own.push_back(i);
    const auto& first = structure.elements[own.front()];
    diagnostics.error(
        "split.part-on-cut", structure.locate(first.at),
        fmt::format("the part of {}{} lies on its cut: a rigid element joins all of its {} grids", name_item(first),
                    own.size() > 1 ? fmt::format(" and {} more elements", own.size() - 1) : "", number),
        "leave these elements in the part along which they run, or add elements off the cut to them");
  }
}

/// "RBE2 5" by dependent grid.
std::map<int, std::string> name_dependent(const Structure& structure) {
  std::map<int, std::string> names;
  for (const auto& [grid, mask] : list_dependent(structure.deck)) {
    const auto card = std::find_if(structure.rigid.begin(), structure.rigid.end(), [&, &g = grid](const auto& item) {
      return std::binary_search(item.grids.begin(), item.grids.end(), g);
    });
    names[grid] = card == structure.rigid.end() ? "a rigid element" : name_item(*card);
  }
  return names;
}

/// A constraint at each grid of the joint: from the first part that has it to each other one.
void add_grid_links(const Partition& partition, const Joint& joint, const std::vector<int>& number,
                    std::vector<PartLink>& links) {
  for (const int grid : joint.grids) {
    std::set<int> parts;
    for (const int part : partition.grid_parts.at(grid)) parts.insert(number[static_cast<std::size_t>(part)]);
    for (const int part : parts)
      if (part != *parts.begin()) links.push_back({*parts.begin(), part, grid, kAll, true, true});
  }
}

void add_ground_links(const Structure& structure, const Partition& partition, Assembly& assembly) {
  std::map<int, std::vector<int>> grids_of;
  for (const auto& [grid, mask] : structure.held) {
    const int part = partition.find_owner(grid);
    if (assembly.is_held && part == 0) continue;
    if (!assembly.is_held && grid == assembly.clamp[0]) continue;
    grids_of[part].push_back(grid);
    assembly.links.push_back({-1, part, grid, mask, true});
  }
  Diagnostics diagnostics;
  for (const auto& [part, grids] : grids_of)
    if (grids.size() > kMaxGroundGrids)
      diagnostics.error("split.held-grids", structure.locate_grid(grids.front()),
                        fmt::format("the deck holds {} grids of one part at the ground, at most {} are supported",
                                    grids.size(), kMaxGroundGrids),
                        "cut such that the first part has the held grids, or hold the others by one RBE2");
  for (std::size_t i = 0; i < structure.elements.size(); ++i)
    if (structure.elements[i].is_grounded && !(assembly.is_held && partition.element_part[i] == 0))
      diagnostics.error("split.grounded", structure.locate(structure.elements[i].at),
                        name_item(structure.elements[i]) + " is fixed to the ground, in a part that moves",
                        "join it to a held grid, or leave it out with --ignore and give the system a [[force]]");
  diagnostics.throw_if_errors();
}

}  // namespace

bool spans_plane(const Structure& structure, const std::vector<int>& grids) {
  const Vector3d& first = structure.position.at(grids.front());
  Vector3d far = Vector3d::Zero();
  for (const int grid : grids)
    if (const Vector3d d = structure.position.at(grid) - first; d.norm() > far.norm()) far = d;
  return std::any_of(grids.begin(), grids.end(), [&](int grid) {
    return (structure.position.at(grid) - first).cross(far).norm() > kFlat * far.squaredNorm();
  });
}

std::vector<Joint> find_joints(const Structure& structure, const Partition& partition, const std::string& interface) {
  std::vector<Joint> joints;
  for (auto& grids : group_shared(structure, partition)) {
    Joint joint;
    joint.grids = std::move(grids);
    for (const int grid : joint.grids)
      joint.parts.insert(partition.grid_parts.at(grid).begin(), partition.grid_parts.at(grid).end());
    joints.push_back(std::move(joint));
  }
  Diagnostics diagnostics;
  for (const auto& joint : joints)
    for (const int grid : joint.grids)
      if (structure.position.count(grid) == 0)
        diagnostics.error("split.scalar-cut", structure.locate({}),
                          fmt::format("the cut goes through scalar point {}", grid),
                          "keep all elements of a scalar point in one part");
  diagnostics.throw_if_errors();
  merge_pinned(structure, partition, joints);
  const auto dependent = name_dependent(structure);
  int next = find_max_grid(structure) + 1;
  for (auto& joint : joints) {
    check_strength(structure, partition, joint, diagnostics);
    joint.is_by_grids = joint.grids.size() > 1 && interface == "grids";
    joint.is_new = joint.grids.size() > 1 && !joint.is_by_grids;
    joint.node = joint.is_by_grids ? 0 : joint.is_new ? next++ : joint.grids.front();
    for (const int grid : joint.grids) joint.x += structure.position.at(grid);
    joint.x /= static_cast<double>(joint.grids.size());
    joint.is_average = joint.is_new && interface == "average";
    if ((joint.is_average || joint.is_by_grids) && structure.common_held != 0)
      throw InputError("split.bad-choice", structure.locate({}),
                       "--interface " + interface + " needs a deck whose grids do not all hold a component",
                       "use --interface rigid");
    if (joint.grids.size() == 1 || joint.is_average) continue;
    check_independent(structure, joint, dependent, diagnostics);
    if (joint.is_new) check_extent(structure, partition, joint, diagnostics);
  }
  diagnostics.throw_if_errors();
  return joints;
}

int find_most_held(const Structure& structure, const Partition& partition) {
  std::vector<int> count(static_cast<std::size_t>(partition.num_parts), 0);
  for (const auto& [grid, mask] : structure.held)
    count[static_cast<std::size_t>(partition.find_owner(grid))] += std::popcount(mask);
  return static_cast<int>(std::max_element(count.begin(), count.end()) - count.begin());
}

Assembly make_assembly(const Structure& structure, std::vector<Joint> joints, bool is_held, int root,
                       Partition& partition) {
  const auto num_parts = static_cast<std::size_t>(partition.num_parts);
  Assembly assembly;
  assembly.is_held = is_held;
  std::vector<int> number(num_parts, -1);
  std::vector<char> is_used(joints.size(), 0);
  std::vector<PartLink> tree, loops;
  std::deque<int> open{root};
  number[static_cast<std::size_t>(root)] = 0;
  int next = 1;
  while (!open.empty()) {
    const int parent = open.front();
    open.pop_front();
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (is_used[j] != 0 || joints[j].parts.count(parent) == 0) continue;
      is_used[j] = 1;
      for (const int child : joints[j].parts) {
        if (child == parent) continue;
        int& its_number = number[static_cast<std::size_t>(child)];
        const bool is_first = its_number < 0;
        if (is_first) {
          its_number = next++;
          open.push_back(child);
        }
        if (joints[j].is_by_grids) {
          if (is_first) tree.push_back({-1, its_number, 0, 0, false, false, joints[j].x});
          continue;
        }
        const unsigned held = is_first ? kAll : kAll & ~structure.common_held;
        (is_first ? tree : loops)
            .push_back({number[static_cast<std::size_t>(parent)], its_number, joints[j].node, held, !is_first});
      }
      if (joints[j].is_by_grids) add_grid_links(partition, joints[j], number, loops);
    }
  }
  for (std::size_t i = 0; i < structure.elements.size(); ++i) {
    const int part = partition.element_part[i];
    if (part >= 0 && number[static_cast<std::size_t>(part)] < 0)
      throw InputError("split.loose-parts", structure.locate(structure.elements[i].at),
                       name_item(structure.elements[i]) + " is in a part that no grid joins to the others",
                       "join the pieces of the structure, or give each its own deck");
  }
  renumber(number, partition);
  for (auto& joint : joints) {
    std::set<int> parts;
    for (const int part : joint.parts) parts.insert(number[static_cast<std::size_t>(part)]);
    joint.parts = std::move(parts);
  }
  assembly.joints = std::move(joints);

  PartLink base{-1, 0, 0, kAll, false};
  const auto by_grids = std::find_if(assembly.joints.begin(), assembly.joints.end(),
                                     [](const Joint& joint) { return joint.is_by_grids && joint.parts.count(0) > 0; });
  if (!is_held && by_grids != assembly.joints.end()) {
    base.held = 0;
    base.point = by_grids->x;
  } else if (!is_held) {
    // At the grid with the most held components; a free structure is carried at its first cut.
    base.held = 0;
    for (const auto& [grid, mask] : structure.held)
      if (partition.find_owner(grid) == 0 && std::popcount(mask) > std::popcount(base.held)) {
        base.node = grid;
        base.held = mask;
      }
    for (const auto& joint : assembly.joints)
      if (base.node == 0 && joint.parts.count(0) > 0) base.node = joint.node;
    base.held |= structure.common_held;
  }
  assembly.links.push_back(base);
  assembly.links.insert(assembly.links.end(), tree.begin(), tree.end());
  assembly.clamp.assign(num_parts, 0);
  assembly.is_averaged.assign(num_parts, 0);
  for (const auto& link : assembly.links) {
    const auto child = static_cast<std::size_t>(link.child);
    assembly.clamp[child] = link.node;
    for (const auto& joint : assembly.joints)
      if (joint.node == link.node && joint.is_average) assembly.is_averaged[child] = 1;
  }
  assembly.links.insert(assembly.links.end(), loops.begin(), loops.end());
  add_ground_links(structure, partition, assembly);
  assembly.interface.resize(num_parts);
  const auto add = [&](int part, int node) {
    if (part < 0 || node == 0 || assembly.clamp[static_cast<std::size_t>(part)] == node) return;
    auto& grids = assembly.interface[static_cast<std::size_t>(part)];
    if (std::find(grids.begin(), grids.end(), node) == grids.end()) grids.push_back(node);
  };
  for (const auto& link : assembly.links) {
    add(link.parent, link.node);
    add(link.child, link.node);
  }
  return assembly;
}

}  // namespace bough::analysis::splitting
