#include "analysis/split/connectors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

namespace bough::analysis::splitting {

namespace {

/// Index of each shell in the elements of the structure, by id.
std::unordered_map<int, std::size_t> index_shells(const Structure& structure) {
  std::unordered_map<int, std::size_t> index;
  for (std::size_t i = 0; i < structure.elements.size(); ++i)
    if (const auto& card = structure.elements[i].card; card.starts_with("CQUAD") || card.starts_with("CTRIA"))
      index.emplace(structure.elements[i].id, i);
  return index;
}

}  // namespace

std::optional<double> calc_mean_coordinate(const DeckItem& element, const std::map<int, double>& coordinate) {
  double sum = 0;
  int count = 0;
  for (const int grid : element.grids)
    if (const auto found = coordinate.find(grid); found != coordinate.end()) sum += found->second, ++count;
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

std::vector<std::pair<double, double>> list_joined_ranges(const Structure& structure,
                                                          const std::map<int, double>& coordinate) {
  const auto index = index_shells(structure);
  std::vector<std::pair<double, double>> ranges;
  for (const auto& element : structure.elements) {
    std::optional<std::pair<double, double>> range;
    for (const int shell : element.shells) {
      const auto mean = calc_mean_coordinate(structure.elements[index.at(shell)], coordinate);
      if (!mean) continue;
      if (!range) range = {*mean, *mean};
      range = {std::min(range->first, *mean), std::max(range->second, *mean)};
    }
    if (range) ranges.push_back(*range);
  }
  return ranges;
}

void assign_connectors(const Structure& structure, std::vector<int>& keys) {
  const auto index = index_shells(structure);
  Diagnostics diagnostics;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto& connector = structure.elements[i];
    if (connector.shells.empty()) continue;
    const int first = connector.shells.front(), key = keys[index.at(first)];
    const auto other = std::find_if(connector.shells.begin(), connector.shells.end(),
                                    [&](int shell) { return keys[index.at(shell)] != key; });
    std::string what;
    if (other != connector.shells.end())
      what = fmt::format("{} joins the shells {} and {}, which are in two parts", name_item(connector), first, *other);
    else if (keys[i] != -1 && keys[i] != key)
      what = fmt::format("{} is in another part of --elements than its shell {}", name_item(connector), first);
    if (!what.empty())
      diagnostics.error("split.connector-across-cut", structure.locate(connector.at),
                        what + ": the cut goes through it",
                        "move the cut to shells next to it, so that one part has the shells of both sides");
    keys[i] = key;
  }
  diagnostics.throw_if_errors();
}

}  // namespace bough::analysis::splitting
