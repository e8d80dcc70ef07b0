#include "analysis/split/part_deck.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace bough::analysis::splitting {

namespace {

constexpr unsigned kAllComponents = 0b111111;
constexpr int kClampSet = 1;  ///< the SPC set of a part, which make_structure gives the id 1

/// Returns true for grids and points whose loads and masses belong to the part.
class Owner {
 public:
  Owner(const Partition& partition, int part) : partition_(partition), part_(part) {}
  bool operator()(int grid) const { return partition_.find_owner(grid) == part_; }

 private:
  const Partition& partition_;
  int part_;
};

std::set<int> list_part_elements(const Structure& structure, const std::vector<char>& is_kept) {
  std::set<int> ids;
  for (std::size_t i = 0; i < is_kept.size(); ++i)
    if (is_kept[i] != 0) ids.insert(structure.elements[i].id);
  return ids;
}

/// Grids and points of the part; those without elements belong to part 0.
std::set<int> list_part_grids(const Structure& structure, const Partition& partition, int part) {
  std::set<int> grids;
  const auto add = [&](int grid) {
    const auto found = partition.grid_parts.find(grid);
    const bool is_alone = found == partition.grid_parts.end() || found->second.empty();
    if (is_alone ? part == 0 : found->second.count(part) > 0) grids.insert(grid);
  };
  for (const auto& grid : structure.deck.grids) add(grid.id);
  for (const int point : structure.deck.scalar_points) add(point);
  return grids;
}

/// A pressure on grids (PLOAD) is in the first part that has all of these.
void keep_grid_pressures(const Structure& structure, const Partition& partition, int part, records::Deck& deck) {
  std::erase_if(deck.load_cards.grid_pressures, [&](const auto& card) {
    const auto common = partition.find_common(card.grids);
    if (common.empty())
      throw InputError("split.load-across-cut", structure.locate(card.at),
                       fmt::format("PLOAD on the grids {} is on several parts: the cut goes through it",
                                   fmt::join(card.grids, ", ")),
                       "move the cut, or give the pressure by PLOAD2 or PLOAD4 on elements");
    return *common.begin() != part;
  });
}

/// Nonstructural mass (NSM) of the elements and properties of the part.
void keep_nonstructural(const std::set<int>& elements, const std::set<int>& properties, records::Deck& deck) {
  auto& cards = deck.special.nsm;
  std::erase_if(cards, [&](const auto& card) {
    const auto& ids = card.type == "ELEMENT" || card.type == "CONROD" ? elements : properties;
    if (card.is_all) return ids.empty();
    return std::none_of(card.range.begin(), card.range.end(), [&](const auto& range) {
      const auto found = ids.lower_bound(range.first);
      return found != ids.end() && *found <= range.second;
    });
  });
  std::set<int> sets;
  for (const auto& card : cards) sets.insert(card.sid);
  for (auto& [id, members] : deck.special.nsmadd)
    std::erase_if(members, [&](int member) { return sets.count(member) == 0; });
  std::erase_if(deck.special.nsmadd, [](const auto& sum) { return sum.second.empty(); });
  for (const auto& [id, members] : deck.special.nsmadd) sets.insert(id);
  for (auto& subcase : deck.subcases)
    if (sets.count(subcase.nsm) == 0) subcase.nsm = 0;
}

void keep_loads(const Owner& owns, const std::set<int>& grids, const std::set<int>& elements, records::Deck& deck) {
  const auto is_foreign = [&](const auto& card) { return !owns(card.g); };
  std::erase_if(deck.point_loads, is_foreign);
  auto& cards = deck.load_cards;
  std::erase_if(cards.directed, is_foreign);
  std::erase_if(cards.spcd, is_foreign);
  std::erase_if(cards.scalar, [&](const auto& card) { return !owns(card.point); });
  const auto is_of_other = [&](const auto& card) { return elements.count(card.element) == 0; };
  std::erase_if(cards.beams, is_of_other);
  std::erase_if(cards.pressures, is_of_other);
  for (auto& card : deck.special.accelerations) std::erase_if(card.grids, [&](int g) { return grids.count(g) == 0; });
  std::erase_if(deck.special.accelerations,
                [](const auto& card) { return card.table.empty() && !card.is_all && card.grids.empty(); });
  std::erase_if(deck.temperatures.grids, [&](const auto& card) { return grids.count(card.g) == 0; });
  std::erase_if(deck.temperatures.bars, is_of_other);
  std::erase_if(deck.temperatures.plates, is_of_other);
}

std::set<int> list_load_sets(const records::Deck& deck) {
  std::set<int> sets;
  const auto add = [&](const auto& cards) {
    for (const auto& card : cards) sets.insert(card.sid);
  };
  add(deck.point_loads), add(deck.gravity);
  const auto& cards = deck.load_cards;
  add(cards.directed), add(cards.beams), add(cards.grid_pressures), add(cards.pressures), add(cards.rotations);
  add(cards.spcd), add(cards.scalar), add(deck.special.accelerations);
  return sets;
}

/// Combinations and selections without the sets of which the part has no card.
void keep_sets(records::Deck& deck) {
  auto sets = list_load_sets(deck);
  for (auto& load : deck.loads)
    std::erase_if(load.terms, [&](const auto& term) { return sets.count(term.second) == 0; });
  std::erase_if(deck.loads, [](const auto& load) { return load.terms.empty(); });
  for (const auto& load : deck.loads) sets.insert(load.sid);
  std::set<int> temperatures;
  const auto add = [&](const auto& cards) {
    for (const auto& card : cards) temperatures.insert(card.sid);
  };
  add(deck.temperatures.grids), add(deck.temperatures.defaults);
  add(deck.temperatures.bars), add(deck.temperatures.plates);
  for (auto& subcase : deck.subcases) {
    if (sets.count(subcase.load) == 0) subcase.load = 0;
    if (temperatures.count(subcase.temperature) == 0) subcase.temperature = 0;
    if (temperatures.count(subcase.initial_temperature) == 0) subcase.initial_temperature = 0;
    if (temperatures.count(subcase.material_temperature) == 0) subcase.material_temperature = 0;
    subcase.suport1 = 0;
  }
}

/// A matrix belongs to the part that has all of its grids.
void keep_matrices(const Structure& structure, const Partition& partition, int part, records::Deck& deck) {
  std::set<std::string> kept;
  for (const auto& matrix : deck.direct_matrices) {
    std::vector<int> grids;
    for (const auto& entry : matrix.entries) grids.insert(grids.end(), {entry.gi, entry.gj});
    const auto common = partition.find_common(grids);
    if (common.empty() && !grids.empty())
      throw InputError("split.matrix-across-cut", structure.locate(matrix.at),
                       "DMIG " + matrix.name + " joins grids of several parts: the cut goes through it",
                       "move the cut, so that one part has all of its grids");
    if (!common.empty() && *common.begin() == part) kept.insert(matrix.name);
  }
  const auto is_lost = [&](const auto& name) { return kept.count(name) == 0; };
  std::erase_if(deck.direct_matrices, [&](const auto& matrix) { return is_lost(matrix.name); });
  for (auto& subcase : deck.subcases)
    for (auto* matrices : {&subcase.k2gg, &subcase.m2gg, &subcase.b2gg})
      std::erase_if(*matrices, [&](const auto& entry) { return is_lost(entry.second); });
}

/// Components of each constraint card that every grid holds; the others are those of the part's links.
void keep_common_constraints(const Structure& structure, records::Deck& deck) {
  const auto keep = [&](int grid, unsigned& mask) {
    if (structure.joined.count(grid) > 0) mask &= structure.common_held;
  };
  for (auto& grid : deck.grids) keep(grid.id, grid.ps);
  for (auto& constraint : deck.spc) keep(constraint.g, constraint.c);
  std::erase_if(deck.spc, [](const auto& constraint) { return constraint.c == 0; });
}

int find_next_element(const Structure& structure) {
  int max = 0;
  for (const auto& element : structure.elements) max = std::max(max, element.id);
  for (const auto& rigid : structure.rigid) max = std::max(max, rigid.id);
  return max + 1;
}

/// Components whose mean the new grid follows: translations, and of grids on one line the rotation nearest to it.
/// Other rotations of shells, about their normal, have hardly any stiffness.
unsigned find_averaged(const Structure& structure, const std::vector<int>& grids) {
  constexpr unsigned kTranslations = 0b000111;
  if (spans_plane(structure, grids)) return kTranslations;
  const Eigen::Vector3d line = structure.position.at(grids.back()) - structure.position.at(grids.front());
  Eigen::Index nearest = 0;
  (structure.axes.at(grids.front()).transpose() * line).cwiseAbs().maxCoeff(&nearest);
  return kTranslations | (1U << (3 + nearest));
}

/// The new grid of a joint, and RBE2 from it to the grids of the cut, without their held components, or an RBE3.
void add_joint(const Structure& structure, const Joint& joint, bool is_held_by_deck, int& next_id,
               records::Deck& deck) {
  // A part at the end of a cut may have some of its grids.
  std::vector<int> own;
  int cd = 0;
  for (const auto& grid : deck.grids)
    if (std::binary_search(joint.grids.begin(), joint.grids.end(), grid.id)) {
      own.push_back(grid.id);
      cd = grid.cd;
    }
  std::sort(own.begin(), own.end());
  records::Grid node;
  node.id = joint.node;
  node.x = joint.x;
  if (structure.common_held != 0) {
    node.cd = cd;
    node.ps = structure.common_held;
  }
  if (joint.is_average) {
    records::Rbe3 mean;
    mean.id = next_id++;
    mean.ref_grid = joint.node;
    mean.ref_c = kAllComponents;
    mean.groups.push_back({1.0, find_averaged(structure, own), own});
    deck.grids.push_back(node);
    deck.rbe3.push_back(mean);
    return;
  }
  std::map<unsigned, std::vector<int>> grids_by_mask;
  for (const int grid : own) {
    const auto held = structure.held.find(grid);
    unsigned mask = kAllComponents & ~structure.common_held;
    if (is_held_by_deck && held != structure.held.end()) mask &= ~held->second;
    if (mask != 0) grids_by_mask[mask].push_back(grid);
  }
  deck.grids.push_back(node);
  for (const auto& [mask, grids] : grids_by_mask) deck.rbe2.push_back({next_id++, joint.node, mask, grids, {}});
}

/// Holds the grid at which the hinge carries the part.
void clamp_grid(const Structure& structure, int grid, records::Deck& deck) {
  for (const auto& [dependent, mask] : list_dependent(deck))
    if (dependent == grid)
      throw InputError(
          "split.dependent-cut", structure.locate_grid(grid),
          fmt::format("grid {} at a cut depends on others by a rigid element of the part that it carries", grid),
          "move the cut by an element, or cut at the independent grid");
  unsigned held = 0;
  for (const auto& entry : deck.grids)
    if (entry.id == grid) held = entry.ps;
  for (const auto& constraint : deck.spc)
    if (constraint.g == grid) held |= constraint.c;
  const unsigned open = kAllComponents & ~held;
  if (open == 0) return;
  deck.spc.push_back({kClampSet, grid, open, 0, false, {}});
  deck.subcases.front().spc = kClampSet;
}

}  // namespace

records::Deck make_part_deck(const Structure& structure, const Partition& partition, const Assembly& assembly,
                             int part) {
  const bool is_held_by_deck = assembly.is_held && part == 0;
  records::Deck deck = structure.deck;
  const auto grids = list_part_grids(structure, partition, part);
  std::vector<char> is_kept(structure.elements.size(), 0), is_rigid_kept(structure.rigid.size(), 0);
  for (std::size_t i = 0; i < is_kept.size(); ++i) {
    const auto& element = structure.elements[i];
    const bool has_grids =
        std::all_of(element.grids.begin(), element.grids.end(), [&](int grid) { return grids.count(grid) > 0; });
    is_kept[i] = static_cast<char>(element.is_drawn ? has_grids : partition.element_part[i] == part);
  }
  for (std::size_t i = 0; i < is_rigid_kept.size(); ++i)
    is_rigid_kept[i] = static_cast<char>(partition.rigid_part[i] == part);
  keep_elements(deck, is_kept);
  keep_rigid(deck, is_rigid_kept);
  const Owner owns(partition, part);
  const auto ids = list_part_elements(structure, is_kept);
  std::set<int> properties;
  for (std::size_t i = 0; i < is_kept.size(); ++i)
    if (is_kept[i] != 0) properties.insert(structure.elements[i].property);
  keep_loads(owns, grids, ids, deck);
  keep_grid_pressures(structure, partition, part, deck);
  keep_nonstructural(ids, properties, deck);
  keep_matrices(structure, partition, part, deck);

  std::set<int> referred;
  for (const int grid : list_reference_grids(deck))
    if (grids.count(grid) == 0) referred.insert(grid);
  std::erase_if(deck.grids,
                [&](const auto& grid) { return grids.count(grid.id) == 0 && referred.count(grid.id) == 0; });
  std::erase_if(deck.scalar_points, [&](int point) { return grids.count(point) == 0; });
  const auto is_foreign = [&](const auto& card) { return grids.count(card.g) == 0; };
  std::erase_if(deck.spc, is_foreign);
  for (auto& grid : deck.grids)
    if (referred.count(grid.id) > 0) grid.ps = kAllComponents;  // orients alone
  if (!is_held_by_deck) keep_common_constraints(structure, deck);
  for (auto* terms : {&deck.suport, &deck.qset, &deck.bset, &deck.cset}) terms->clear();
  deck.suport1.clear();
  std::erase_if(deck.params, [](const auto& param) { return param.name == "GRDPNT"; });

  int next_id = find_next_element(structure);
  for (const auto& joint : assembly.joints)
    if (joint.is_new && joint.parts.count(part) > 0) add_joint(structure, joint, is_held_by_deck, next_id, deck);
  const int clamp = assembly.clamp[static_cast<std::size_t>(part)];
  if (clamp != 0 && assembly.is_averaged[static_cast<std::size_t>(part)] == 0) clamp_grid(structure, clamp, deck);
  deck.subcases.front().spc = deck.spc.empty() ? 0 : kClampSet;
  deck.subcases.front().mpc = deck.mpc.empty() ? 0 : deck.subcases.front().mpc;
  keep_sets(deck);
  deck.unused.clear();  // reported of the deck itself
  deck.left_out.clear();
  deck.card_counts.clear();
  return deck;
}

}  // namespace bough::analysis::splitting
