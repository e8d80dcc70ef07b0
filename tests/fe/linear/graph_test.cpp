#include "fe/linear/graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace bough::linear {
namespace {

/// Corners of num x num quadrilaterals: neighbours share one.
Graph make_plate(int num) {
  Graph graph;
  for (int j = 0; j <= num; ++j)
    for (int i = 0; i <= num; ++i) {
      for (int y = std::max(0, j - 1); y <= std::min(num, j + 1); ++y)
        for (int x = std::max(0, i - 1); x <= std::min(num, i + 1); ++x)
          if (x != i || y != j) graph.neighbours.push_back(y * (num + 1) + x);
      graph.start.push_back(static_cast<idx_t>(graph.neighbours.size()));
      graph.weight.push_back(6);
    }
  return graph;
}

template <class Use>
void visit_edges(const Graph& graph, const Use& use) {
  for (idx_t v = 0; v < graph.size(); ++v)
    for (idx_t k = graph.start[v]; k < graph.start[v + 1]; ++k) use(v, graph.neighbours[k]);
}

TEST(Graph, SeparatorOfAPlateIsALine) {
  Graph graph = make_plate(60);
  const auto part = find_separator(graph);
  ASSERT_EQ(part.size(), graph.weight.size());
  visit_edges(graph, [&](idx_t v, idx_t other) { EXPECT_FALSE(part[v] == 0 && part[other] == 1); });
  EXPECT_EQ(std::count(part.begin(), part.end(), 2), 61);
  for (const idx_t half : {0, 1}) EXPECT_GT(std::count(part.begin(), part.end(), half), 0.45 * 61 * 61);
}

/// Of edges between parts the ends in the higher one lie between: along a straight cut one line. Parts of halves are of
/// halves of the plate, so that 4 need two lines; 3 and 6 need as many or fewer than a strip each.
TEST(Graph, DissectionNamesEveryVertexOnce) {
  Graph graph = make_plate(20);
  auto order = find_dissection(graph);
  std::sort(order.begin(), order.end());
  ASSERT_EQ(order.size(), graph.weight.size());
  for (idx_t v = 0; v < graph.size(); ++v) EXPECT_EQ(order[v], v);
}

TEST(Graph, VerticesKeepWhatCouplesThem) {
  const Graph graph = make_plate(2), sub = take_vertices(graph, {8, 4, 0});
  EXPECT_EQ(sub.start, (std::vector<idx_t>{0, 1, 3, 4}));
  EXPECT_EQ(sub.neighbours, (std::vector<idx_t>{1, 2, 0, 1}));
  EXPECT_EQ(sub.weight, (std::vector<idx_t>{6, 6, 6}));
}

}  // namespace
}  // namespace bough::linear
