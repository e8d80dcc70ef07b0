#include "fe/linear/graph.hpp"

#include <algorithm>
#include <numeric>

namespace bough::fe {
namespace {

/// By edges, in recursive halves; `share`: of the first of two parts, else all alike. Empty where METIS fails.
std::vector<idx_t> cut_by_edges(Graph& graph, idx_t num_parts, double share = 0) {
  idx_t num = graph.size(), constraints = 1, edges = 0, options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_NCUTS] = 4;
  std::vector<real_t> shares;
  if (share > 0) shares = {static_cast<real_t>(share), static_cast<real_t>(1 - share)};
  std::vector<idx_t> part(graph.weight.size());
  if (num < num_parts || graph.neighbours.empty() ||
      METIS_PartGraphRecursive(&num, &constraints, graph.start.data(), graph.neighbours.data(), graph.weight.data(),
                               nullptr, nullptr, &num_parts, shares.empty() ? nullptr : shares.data(), nullptr, options,
                               &edges, part.data()) != METIS_OK)
    return {};
  return part;
}

std::vector<idx_t> list_where(const std::vector<idx_t>& part, bool is_first) {
  std::vector<idx_t> which;
  for (std::size_t v = 0; v < part.size(); ++v)
    if ((part[v] == 0) == is_first) which.push_back(static_cast<idx_t>(v));
  return which;
}

/// Numbers the parts of `vertices` of the whole from `first` on; false where METIS fails.
bool cut_further(Graph& graph, const std::vector<idx_t>& vertices, idx_t first, idx_t num_parts,
                 std::vector<idx_t>& part) {
  if (num_parts == 1) {
    for (const idx_t v : vertices) part[static_cast<std::size_t>(v)] = first;
    return true;
  }
  // The vertices between go with the second half: they are its ends of what couples the two.
  const idx_t lower = num_parts / 2;
  const std::vector<idx_t> half =
      num_parts % 2 == 0 ? find_separator(graph) : cut_by_edges(graph, 2, static_cast<double>(lower) / num_parts);
  for (const bool is_first : {true, false}) {
    const std::vector<idx_t> own = list_where(half, is_first);
    if (own.empty()) return false;
    std::vector<idx_t> of_whole;
    for (const idx_t v : own) of_whole.push_back(vertices[static_cast<std::size_t>(v)]);
    Graph sub = take_vertices(graph, own);
    if (!cut_further(sub, of_whole, is_first ? first : first + lower, is_first ? lower : num_parts - lower, part))
      return false;
  }
  return true;
}

bool have_all_weight(const Graph& graph, const std::vector<idx_t>& part, idx_t num_parts) {
  if (part.empty()) return false;
  std::vector<char> has(static_cast<std::size_t>(num_parts), 0);
  for (std::size_t v = 0; v < part.size(); ++v)
    if (graph.weight[v] > 0) has[static_cast<std::size_t>(part[v])] = 1;
  return std::all_of(has.begin(), has.end(), [](char one) { return one != 0; });
}

}  // namespace

Graph take_vertices(const Graph& graph, const std::vector<idx_t>& which) {
  std::vector<idx_t> place(graph.weight.size(), -1);
  for (std::size_t i = 0; i < which.size(); ++i) place[static_cast<std::size_t>(which[i])] = static_cast<idx_t>(i);
  Graph sub;
  for (const idx_t v : which) {
    for (idx_t k = graph.start[v]; k < graph.start[v + 1]; ++k)
      if (const idx_t other = place[static_cast<std::size_t>(graph.neighbours[k])]; other >= 0)
        sub.neighbours.push_back(other);
    sub.start.push_back(static_cast<idx_t>(sub.neighbours.size()));
    sub.weight.push_back(graph.weight[static_cast<std::size_t>(v)]);
  }
  return sub;
}

std::vector<idx_t> find_dissection(Graph& graph) {
  std::vector<idx_t> order(graph.weight.size()), place(order.size());
  std::iota(order.begin(), order.end(), 0);
  if (graph.neighbours.empty()) return order;
  idx_t num = graph.size(), options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  if (METIS_NodeND(&num, graph.start.data(), graph.neighbours.data(), graph.weight.data(), options, order.data(),
                   place.data()) != METIS_OK)
    return {};
  return order;
}

std::vector<idx_t> find_separator(Graph& graph) {
  idx_t num = graph.size(), size = 0, options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_NUMBERING] = 0;
  options[METIS_OPTION_UFACTOR] = 50;  // a twentieth more than half; by itself it takes a fifth
  std::vector<idx_t> part(graph.weight.size());
  if (graph.neighbours.empty() ||
      METIS_ComputeVertexSeparator(&num, graph.start.data(), graph.neighbours.data(), graph.weight.data(), options,
                                   &size, part.data()) != METIS_OK)
    return {};
  return part;
}

std::vector<idx_t> cut_into_parts(Graph& graph, idx_t num_parts) {
  std::vector<idx_t> part(graph.weight.size(), 0), all(graph.weight.size());
  std::iota(all.begin(), all.end(), 0);
  if (num_parts > 1 && cut_further(graph, all, 0, num_parts, part) && have_all_weight(graph, part, num_parts))
    return part;
  part = cut_by_edges(graph, num_parts);
  return have_all_weight(graph, part, num_parts) ? part : std::vector<idx_t>();
}

}  // namespace bough::fe
