#include "fe/linear/graph.hpp"

#include <numeric>

namespace bough::linear {
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
  options[METIS_OPTION_UFACTOR] = 50;  // 5 % more than half; its default is 20 %
  std::vector<idx_t> part(graph.weight.size());
  if (graph.neighbours.empty() ||
      METIS_ComputeVertexSeparator(&num, graph.start.data(), graph.neighbours.data(), graph.weight.data(), options,
                                   &size, part.data()) != METIS_OK)
    return {};
  return part;
}

}  // namespace bough::linear
