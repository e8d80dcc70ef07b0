#include "analysis/split/partition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "analysis/split/connectors.hpp"
#include "analysis/split/path.hpp"
#include "base/platform.hpp"

namespace bough::analysis::splitting {

namespace {

using Eigen::Vector3d;

constexpr double kSameStation = 1e-9;  ///< of the length: grids at one station of the coordinate
constexpr double kSmallPiece = 0.25;   ///< of the mean number of elements of a part: a piece that joins a neighbour

/// Union of grids that elements of one part connect.
class Groups {
 public:
  int find(int grid) {
    auto at = parent_.emplace(grid, grid).first;
    while (at->second != at->first) {
      const auto above = parent_.find(at->second);
      at->second = above->second;
      at = parent_.find(at->second);
    }
    return at->first;
  }
  void join(const std::vector<int>& grids) {
    for (const int grid : grids) parent_[find(grid)] = find(grids.front());
  }

 private:
  std::map<int, int> parent_;
};

bool parse_number(std::string_view text, double& value) {
  const auto end = text.data() + text.size();
  const auto result = platform::read_number(text.data() + (text.starts_with('+') ? 1 : 0), end, value);
  return !text.empty() && result.ec == std::errc() && result.ptr == end && std::isfinite(value);
}

std::vector<std::string> split_words(const std::string& text, char separator) {
  std::vector<std::string> words{""};
  for (const char c : text)
    if (c == separator)
      words.emplace_back();
    else
      words.back() += c;
  return words;
}

struct Plane {
  Vector3d normal = Vector3d::Zero();
  double offset = 0;
};

Plane parse_plane(const std::string& text) {
  Plane plane;
  const auto sides = split_words(text, '=');
  bool is_read = sides.size() == 2 && parse_number(sides[1], plane.offset);
  if (is_read && sides[0].size() == 1 && sides[0][0] >= 'x' && sides[0][0] <= 'z') {
    plane.normal(sides[0][0] - 'x') = 1;
  } else if (is_read) {
    const auto words = split_words(sides[0], ',');
    is_read = words.size() == 3;
    for (int i = 0; i < 3 && is_read; ++i) is_read = parse_number(words[static_cast<std::size_t>(i)], plane.normal(i));
    is_read = is_read && plane.normal.norm() > 0;
  }
  if (!is_read)
    throw InputError("split.bad-plane", {}, "cannot read --plane \"" + text + "\"",
                     "write x=2.5, or the normal and its product with a point, as 1,0,1=3.5");
  plane.offset /= plane.normal.norm();
  plane.normal.normalize();
  return plane;
}

/// Mean of the positions of its grids; false if none has a position.
bool find_centre(const Structure& structure, const DeckItem& element, Vector3d& centre) {
  centre.setZero();
  int count = 0;
  for (const int grid : element.grids)
    if (const auto found = structure.position.find(grid); found != structure.position.end())
      centre += found->second, ++count;
  if (count > 0) centre /= count;
  return count > 0;
}

/// Keys of elements, any integers, -1 for none: equal keys are one part, numbered by their order.
struct Keys {
  std::vector<int> key;
  bool merges_small = false;
};

Keys cut_by_planes(const Structure& structure, const std::vector<std::string>& texts) {
  Keys keys{std::vector<int>(structure.elements.size(), -1)};
  if (texts.size() > 30)
    throw InputError("split.bad-plane", {}, fmt::format("{} planes, at most 30 are supported", texts.size()),
                     "use --parts, or cut the parts again");
  int bit = 1;
  for (const auto& text : texts) {
    const Plane plane = parse_plane(text);
    int num_below = 0, num_above = 0;
    for (std::size_t i = 0; i < keys.key.size(); ++i) {
      Vector3d centre;
      if (!is_placed(structure.elements[i]) || !find_centre(structure, structure.elements[i], centre)) continue;
      const bool is_above = plane.normal.dot(centre) > plane.offset;
      ++(is_above ? num_above : num_below);
      if (keys.key[i] < 0) keys.key[i] = 0;
      if (is_above) keys.key[i] += bit;
    }
    if (num_below == 0 || num_above == 0)
      throw InputError("split.nothing-separated", structure.locate({}),
                       "the plane " + text + " separates nothing: every element is on one side of it",
                       "move the plane into the structure");
    bit *= 2;
  }
  return keys;
}

struct ElementWord {
  int first = 0, last = -1, property = 0;
  std::string card;
  bool names(const DeckItem& element) const {
    return (element.id >= first && element.id <= last) || (property > 0 && element.property == property) ||
           (!card.empty() && element.card == card);
  }
};

ElementWord parse_element_word(const std::string& word) {
  ElementWord parsed;
  const auto fail = [&]() -> InputError {
    return {"split.bad-choice",
            {},
            "cannot read \"" + word + "\" of --elements",
            "write ids and ranges such as 17,20-25, property:3 or card:CBAR"};
  };
  const auto read_id = [&](std::string_view text) {
    int id = 0;
    const auto end = text.data() + text.size();
    if (text.empty() || platform::read_number(text.data(), end, id).ptr != end || id <= 0) throw fail();
    return id;
  };
  std::string upper = word;
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const auto colon = upper.find(':'), dash = upper.find('-');
  if (colon != std::string::npos) {
    const auto kind = upper.substr(0, colon), name = upper.substr(colon + 1);
    if (kind == "PROPERTY")
      parsed.property = read_id(name);
    else if (kind == "CARD" && !name.empty())
      parsed.card = name;
    else
      throw fail();
  } else if (dash != std::string::npos) {
    parsed.first = read_id(std::string_view(upper).substr(0, dash));
    parsed.last = read_id(std::string_view(upper).substr(dash + 1));
    if (parsed.last < parsed.first) throw fail();
  } else {
    parsed.first = parsed.last = read_id(upper);
  }
  return parsed;
}

Keys cut_by_elements(const Structure& structure, const std::vector<std::string>& lists) {
  const int rest = static_cast<int>(lists.size());
  Keys keys{std::vector<int>(structure.elements.size(), -1)};
  for (std::size_t i = 0; i < keys.key.size(); ++i)
    if (is_placed(structure.elements[i])) keys.key[i] = rest;
  Diagnostics diagnostics;
  for (int part = 0; part < rest; ++part) {
    for (const auto& word : split_words(lists[static_cast<std::size_t>(part)], ',')) {
      const auto parsed = parse_element_word(word);
      bool is_there = false;
      for (std::size_t i = 0; i < keys.key.size(); ++i) {
        const auto& element = structure.elements[i];
        if (!is_structural(element) || !parsed.names(element)) continue;
        is_there = true;
        if (keys.key[i] != -1 && keys.key[i] != rest && keys.key[i] != part)
          diagnostics.error(
              "split.element-in-two-parts", structure.locate(element.at),
              fmt::format("{} is in parts {} and {} of --elements", name_item(element), keys.key[i] + 1, part + 1),
              "name each element in one part");
        keys.key[i] = part;
      }
      if (!is_there)
        diagnostics.error("split.unknown-element", structure.locate({}),
                          "\"" + word + "\" of --elements names no element that joins two grids",
                          "name elements, properties or cards of the deck");
    }
  }
  diagnostics.throw_if_errors();
  return keys;
}

/// Groups of elements that share a grid other than the cut ones. Rigid elements connect, too.
Keys cut_at_grids(const Structure& structure, const std::vector<int>& cuts) {
  Diagnostics diagnostics;
  std::set<int> cut;
  for (const int grid : cuts) {
    if (structure.position.count(grid) == 0)
      diagnostics.error("split.unknown-grid", structure.locate({}),
                        fmt::format("grid {} of --grids is not a grid of the deck", grid), "name grids of the deck");
    else if (!cut.insert(grid).second)
      diagnostics.error("split.bad-choice", structure.locate_grid(grid),
                        fmt::format("grid {} occurs twice in --grids", grid), "name each grid once");
  }
  diagnostics.throw_if_errors();
  Groups groups;
  const auto join = [&](const DeckItem& item) {
    std::vector<int> inner;
    for (const int grid : item.grids)
      if (cut.count(grid) == 0) inner.push_back(grid);
    if (!inner.empty()) groups.join(inner);
  };
  for (const auto& element : structure.elements)
    if (is_structural(element)) join(element);
  for (const auto& rigid : structure.rigid) join(rigid);
  Keys keys{std::vector<int>(structure.elements.size(), -1)};
  std::map<int, std::set<int>> keys_at;
  int next = -2;  // an element between cut grids alone is a part
  for (std::size_t i = 0; i < keys.key.size(); ++i) {
    const auto& element = structure.elements[i];
    if (!is_placed(element)) continue;
    const auto inner =
        std::find_if(element.grids.begin(), element.grids.end(), [&](int grid) { return cut.count(grid) == 0; });
    keys.key[i] = inner == element.grids.end() ? next-- : groups.find(*inner);
    for (const int grid : element.grids)
      if (cut.count(grid) > 0) keys_at[grid].insert(keys.key[i]);
  }
  for (const int grid : cut)
    if (keys_at[grid].size() < 2)
      diagnostics.error("split.nothing-separated", structure.locate_grid(grid),
                        fmt::format("grid {} separates nothing: all elements at it stay connected{}", grid,
                                    keys_at[grid].empty() ? ", and there are none" : ""),
                        "name every grid of a cut, or a grid between two parts of the structure");
  diagnostics.throw_if_errors();
  return keys;
}

/// The coordinates of num_parts - 1 cuts: stations of grids nearest to equal lengths that no rigid element bridges.
std::vector<double> choose_stations(const Structure& structure, const std::map<int, double>& coordinate,
                                    const SplitChoice& choice) {
  std::vector<double> stations;
  for (const auto& [grid, s] : coordinate) stations.push_back(s);
  std::sort(stations.begin(), stations.end());
  const double first = stations.front(), last = stations.back(), length = last - first;
  std::vector<std::pair<double, double>> bridged;
  for (const auto& rigid : structure.rigid) {
    double low = last, high = first;
    for (const int grid : rigid.grids)
      if (const auto found = coordinate.find(grid); found != coordinate.end()) {
        low = std::min(low, found->second);
        high = std::max(high, found->second);
      }
    if (high > low) bridged.emplace_back(low, high);
  }
  const double same = kSameStation * length;
  for (const auto& [low, high] : list_joined_ranges(structure, coordinate))
    if (high > low) bridged.emplace_back(low - 2 * same, high + 2 * same);  // shells are cut at these, too
  std::vector<double> free;
  for (const double s : stations) {
    if (s <= first + same || s >= last - same || (!free.empty() && s <= free.back() + same)) continue;
    if (std::none_of(bridged.begin(), bridged.end(),
                     [&](const auto& range) { return s > range.first + same && s < range.second - same; }))
      free.push_back(s);
  }
  const auto num_cuts = static_cast<std::size_t>(choice.num_parts) - 1;
  if (free.size() < num_cuts)
    throw InputError("split.too-many-parts", structure.locate({}),
                     fmt::format("{} parts need {} stations of grids along the structure, which has {} that no rigid "
                                 "element, CFAST or CWELD bridges",
                                 choice.num_parts, num_cuts, free.size()),
                     fmt::format("give --parts {} at most, or cut with --grids or --elements", free.size() + 1));
  std::vector<double> cuts;
  std::size_t begin = 0;
  for (std::size_t k = 0; k < num_cuts; ++k) {
    const double goal = first + length * static_cast<double>(k + 1) / choice.num_parts;
    const std::size_t end = free.size() - (num_cuts - 1 - k);  // leaves a station for each cut that follows
    std::size_t best = begin;
    for (std::size_t i = begin; i < end; ++i)
      if (std::abs(free[i] - goal) < std::abs(free[best] - goal)) best = i;
    cuts.push_back(free[best]);
    begin = best + 1;
  }
  return cuts;
}

Keys cut_along(const Structure& structure, const SplitChoice& choice) {
  const auto coordinate = calc_coordinate(structure, choice.along);
  Keys keys{std::vector<int>(structure.elements.size(), -1), true};
  if (coordinate.empty())
    throw InputError("split.no-elements", structure.locate({}), "no element of the deck joins two grids",
                     "give the bulk data of a structure");
  const auto cuts = choose_stations(structure, coordinate, choice);
  for (std::size_t i = 0; i < keys.key.size(); ++i) {
    const auto& element = structure.elements[i];
    if (!is_placed(element)) continue;
    if (const auto mean = calc_mean_coordinate(element, coordinate))
      keys.key[i] = static_cast<int>(std::count_if(cuts.begin(), cuts.end(), [&](double s) { return s < *mean; }));
  }
  return keys;
}

/// Numbers from 0 in the order of the keys as they first occur; -1 stays.
int number_keys(std::vector<int>& keys) {
  std::map<int, int> number;
  for (int& key : keys)
    if (key != -1) key = number.emplace(key, static_cast<int>(number.size())).first->second;
  return static_cast<int>(number.size());
}

/// Joins the pieces at the grids of an RBE3 if they are two at most: its equations move the reference grid as the mean
/// of the others, so that one piece carries the other. Pieces at held grids are one, which the ground joins.
/// \return false for more pieces
bool join_by_mean(const DeckItem& rbe3, const std::set<int>& held, Groups& group) {
  std::set<int> held_roots, pieces;
  for (const int grid : held) held_roots.insert(group.find(grid));
  for (const int grid : rbe3.grids) {
    const int root = group.find(grid);
    pieces.insert(held_roots.count(root) > 0 ? 0 : root);
  }
  if (pieces.size() > 2) return false;
  group.join(rbe3.grids);
  return true;
}

/// Elements of one key that are connected get one number; returns the number of them. `joins_pieces`: as that of
/// Partition.
int separate_pieces(const Structure& structure, std::vector<int>& keys, std::vector<char>& joins_pieces) {
  std::map<int, Groups> groups;
  std::map<int, std::vector<std::size_t>> means;  // key: RBE3 by index
  joins_pieces.assign(structure.rigid.size(), 0);
  std::map<int, std::set<int>> keys_at;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i] < 0) continue;
    groups[keys[i]].join(structure.elements[i].grids);
    for (const int grid : structure.elements[i].grids) keys_at[grid].insert(keys[i]);
  }
  // A rigid element connects the pieces of the part that has all of its grids.
  for (std::size_t i = 0; i < structure.rigid.size(); ++i) {
    const auto& rigid = structure.rigid[i];
    for (auto& [key, group] : groups) {
      const auto is_of_part = [&, &k = key](int grid) {
        const auto found = keys_at.find(grid);
        return found == keys_at.end() || found->second.count(k) > 0;
      };
      if (!std::all_of(rigid.grids.begin(), rigid.grids.end(), is_of_part)) continue;
      if (rigid.card == "RBE3")
        means[key].push_back(i);
      else
        group.join(rigid.grids);
    }
  }
  for (auto& [key, left] : means) {
    std::set<int> held;
    for (const auto& [grid, mask] : structure.held)
      if (const auto found = keys_at.find(grid); found != keys_at.end() && found->second.count(key) > 0)
        held.insert(grid);
    const auto is_joined = [&, &group = groups[key]](std::size_t i) {
      return join_by_mean(structure.rigid[i], held, group);
    };
    while (std::erase_if(left, is_joined) > 0) {  // two pieces that one joins are one for the others
    }
    for (const std::size_t i : left) joins_pieces[i] = 1;
  }
  std::map<std::pair<int, int>, int> number;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i] < 0) continue;
    const std::pair<int, int> piece{keys[i], groups[keys[i]].find(structure.elements[i].grids.front())};
    keys[i] = number.emplace(piece, static_cast<int>(number.size())).first->second;
  }
  return static_cast<int>(number.size());
}

/// Pieces with few elements join the neighbour with which they share most grids. Returns how many did.
int merge_small(const Structure& structure, int num_pieces, double min_elements, std::vector<int>& keys) {
  int num_merged = 0;
  std::vector<int> size(static_cast<std::size_t>(num_pieces), 0);
  for (const int key : keys)
    if (key >= 0) ++size[static_cast<std::size_t>(key)];
  for (int piece = 0; piece < num_pieces; ++piece) {
    if (size[static_cast<std::size_t>(piece)] >= min_elements) continue;
    std::set<int> grids;
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (keys[i] == piece) grids.insert(structure.elements[i].grids.begin(), structure.elements[i].grids.end());
    std::map<int, std::set<int>> shared;
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (keys[i] >= 0 && keys[i] != piece)
        for (const int grid : structure.elements[i].grids)
          if (grids.count(grid) > 0) shared[keys[i]].insert(grid);
    if (shared.empty()) continue;
    const int neighbour = std::max_element(shared.begin(), shared.end(), [](const auto& a, const auto& b) {
                            return a.second.size() < b.second.size();
                          })->first;
    for (int& key : keys)
      if (key == piece) key = neighbour;
    size[static_cast<std::size_t>(neighbour)] += size[static_cast<std::size_t>(piece)];
    ++num_merged;
  }
  return num_merged;
}

/// Names one grid in each part that the RBE3 joins.
void report_pieces(const Structure& structure, const DeckItem& rbe3, const std::map<int, std::set<int>>& parts_of,
                   Diagnostics& diagnostics) {
  std::set<std::set<int>> parts;
  std::vector<int> grids;
  for (const int grid : rbe3.grids)
    if (const auto found = parts_of.find(grid); found != parts_of.end() && parts.insert(found->second).second)
      grids.push_back(grid);
  diagnostics.error("split.rbe3-pieces", structure.locate(rbe3.at),
                    fmt::format("{} alone joins the pieces of a part, at grids {}: its equations give a mean motion, "
                                "which holds no piece against the others",
                                name_item(rbe3), fmt::join(grids, ", ")),
                    "join the pieces by elements or an RBE2, or cut where elements or the ground join them");
}

}  // namespace

std::set<int> Partition::find_common(const std::vector<int>& grids) const {
  std::set<int> common;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const auto found = grid_parts.find(grids[i]);
    const std::set<int> parts = found == grid_parts.end() ? std::set<int>{0} : found->second;
    std::set<int> both;
    std::set_intersection(common.begin(), common.end(), parts.begin(), parts.end(), std::inserter(both, both.end()));
    common = i == 0 ? parts : both;
  }
  return common;
}

Partition assign_elements(const Structure& structure, const SplitChoice& choice) {
  const int num_choices = static_cast<int>(choice.num_parts > 0) + static_cast<int>(!choice.planes.empty()) +
                          static_cast<int>(!choice.elements.empty()) + static_cast<int>(!choice.grids.empty());
  if (num_choices != 1)
    throw InputError("split.bad-choice", {},
                     num_choices == 0 ? "nothing tells where to cut the deck" : "two ways to cut the deck are given",
                     "give one of --parts, --plane, --elements and --grids");
  if (choice.num_parts == 1)
    throw InputError("split.bad-choice", {}, "--parts is 1, which cuts nothing",
                     "give --parts 2 or more, or make one body of the deck by bough reduce");
  Keys keys = choice.num_parts > 0       ? cut_along(structure, choice)
              : !choice.planes.empty()   ? cut_by_planes(structure, choice.planes)
              : !choice.elements.empty() ? cut_by_elements(structure, choice.elements)
                                         : cut_at_grids(structure, choice.grids);
  assign_connectors(structure, keys.key);
  Partition partition;
  const int num_chosen = number_keys(keys.key);
  if (num_chosen < 2)
    throw InputError("split.nothing-separated", structure.locate({}),
                     "the cut separates nothing: all elements are in one part",
                     "name some of the elements, or leave some to the other part");
  int num_pieces = separate_pieces(structure, keys.key, partition.joins_pieces);
  if (keys.merges_small) {
    const auto num_elements = std::count_if(keys.key.begin(), keys.key.end(), [](int key) { return key >= 0; });
    partition.num_merged =
        merge_small(structure, num_pieces, kSmallPiece * static_cast<double>(num_elements) / num_chosen, keys.key);
    num_pieces = number_keys(keys.key);
  }
  partition.num_parts = num_pieces;
  partition.num_pieces = std::max(num_pieces - num_chosen, 0);
  partition.element_part = std::move(keys.key);
  for (std::size_t i = 0; i < partition.element_part.size(); ++i)
    if (const int part = partition.element_part[i]; part >= 0)
      for (const int grid : structure.elements[i].grids) partition.grid_parts[grid].insert(part);
  return partition;
}

void renumber(const std::vector<int>& new_number, Partition& partition) {
  const auto change = [&](int& part) {
    if (part >= 0) part = new_number[static_cast<std::size_t>(part)];
  };
  for (int& part : partition.element_part) change(part);
  for (int& part : partition.rigid_part) change(part);
  for (auto& [grid, parts] : partition.grid_parts) {
    std::set<int> changed;
    for (int part : parts) {
      change(part);
      changed.insert(part);
    }
    parts = std::move(changed);
  }
}

void assign_attached(const Structure& structure, Partition& partition) {
  Diagnostics diagnostics;
  const auto of_elements = partition.grid_parts;
  partition.rigid_part.assign(structure.rigid.size(), -1);
  // Rigid elements without a grid of an element follow those that have one.
  for (bool is_changed = true; is_changed;) {
    is_changed = false;
    for (std::size_t i = 0; i < structure.rigid.size(); ++i) {
      if (partition.rigid_part[i] >= 0) continue;
      const auto& rigid = structure.rigid[i];
      std::set<int> common;
      bool has_any = false;
      for (const bool by_elements : {true, false}) {
        const auto& parts_of = by_elements ? of_elements : partition.grid_parts;
        for (const int grid : rigid.grids) {
          const auto found = parts_of.find(grid);
          if (found == parts_of.end()) continue;
          std::set<int> both;
          if (has_any)
            std::set_intersection(common.begin(), common.end(), found->second.begin(), found->second.end(),
                                  std::inserter(both, both.end()));
          common = has_any ? both : found->second;
          has_any = true;
        }
        if (has_any) break;
      }
      if (!has_any) continue;
      is_changed = true;
      if (common.empty() && partition.joins_pieces[i] != 0) {
        report_pieces(structure, rigid, of_elements, diagnostics);
        partition.rigid_part[i] = 0;
        continue;
      }
      if (common.empty()) {
        diagnostics.error("split.rigid-across-cut", structure.locate(rigid.at),
                          fmt::format("{} joins grids of several parts: the cut goes through it", name_item(rigid)),
                          "move the cut, so that one part has all of its grids");
        partition.rigid_part[i] = 0;
        continue;
      }
      partition.rigid_part[i] = *common.begin();
      for (const int grid : rigid.grids) partition.grid_parts[grid].insert(*common.begin());
    }
  }
  for (int& part : partition.rigid_part) part = std::max(part, 0);
  for (std::size_t i = 0; i < structure.elements.size(); ++i) {
    int& part = partition.element_part[i];
    const auto& element = structure.elements[i];
    if (part >= 0 || element.is_drawn || element.grids.empty()) continue;
    part = partition.find_owner(element.grids.front());
    for (const int grid : element.grids) partition.grid_parts[grid].insert(part);
  }
  diagnostics.throw_if_errors();
}

}  // namespace bough::analysis::splitting
