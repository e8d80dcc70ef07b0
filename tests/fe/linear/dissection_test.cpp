/// The postorder of elimination trees, against trees from the fill of a dense elimination.
#include "fe/linear/dissection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace bough::linear {
namespace {

constexpr int kSize = 40;

/// A symmetric pattern, a few entries a row that do not repeat soon; rows as PETSc has them.
struct Pattern {
  std::vector<PetscInt> start{0}, column;
  std::vector<std::set<int>> rows{std::vector<std::set<int>>(kSize)};

  explicit Pattern(int seed) {
    unsigned state = 12345u + 977u * static_cast<unsigned>(seed);
    const auto next = [&] { return state = 1664525u * state + 1013904223u, static_cast<int>((state >> 8) % kSize); };
    for (int k = 0; k < 45; ++k) {
      const int i = next(), j = next();
      rows[static_cast<std::size_t>(i)].insert(j);
      rows[static_cast<std::size_t>(j)].insert(i);
    }
    for (int i = 0; i < kSize; ++i) {
      rows[static_cast<std::size_t>(i)].insert(i);
      for (const int j : rows[static_cast<std::size_t>(i)]) column.push_back(j);
      start.push_back(static_cast<PetscInt>(column.size()));
    }
  }
  MatrixRows get() const { return {start.data(), column.data(), nullptr}; }
};

/// Parents of the columns of L, in the order `rows`, from which rows fill.
std::vector<int> find_parents(const std::vector<const Pattern*>& patterns, const std::vector<PetscInt>& rows) {
  const auto n = rows.size();
  std::vector<std::set<std::size_t>> below(n);
  for (std::size_t j = 0; j < n; ++j)
    for (const Pattern* pattern : patterns)
      for (std::size_t i = j + 1; i < n; ++i)
        if (pattern->rows[static_cast<std::size_t>(rows[j])].count(static_cast<int>(rows[i])) > 0) below[j].insert(i);
  std::vector<int> parent(n, -1);
  for (std::size_t j = 0; j < n; ++j) {
    if (below[j].empty()) continue;
    const std::size_t first = *below[j].begin();
    parent[j] = static_cast<int>(first);
    below[first].insert(std::next(below[j].begin()), below[j].end());
  }
  return parent;
}

/// Of a part of the rows of one matrix and of two together: every row once, those below a row just before it.
TEST(Postorder, HasSubtreesBeforeTheirRoots) {
  for (int seed = 0; seed < 20; ++seed) {
    const Pattern a(seed), b(seed + 100);
    std::vector<PetscInt> rows;
    for (int i = 0; i < kSize; ++i)
      if ((7 * i + seed) % 5 != 0) rows.push_back((11 * i + seed) % kSize);
    for (const bool both : {false, true}) {
      const MatrixRows of_a = a.get(), of_b = b.get();
      std::vector<const MatrixRows*> matrices{&of_a};
      std::vector<const Pattern*> patterns{&a};
      if (both) matrices.push_back(&of_b), patterns.push_back(&b);
      const std::vector<int> order = calc_postorder(matrices, kSize, rows), parent = find_parents(patterns, rows);
      ASSERT_EQ(order.size(), rows.size());
      std::vector<int> place(order.size(), -1), size(order.size(), 1);
      for (std::size_t k = 0; k < order.size(); ++k) place[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
      EXPECT_EQ(std::count(place.begin(), place.end(), -1), 0);
      std::vector<int> first(order.size());
      for (std::size_t i = 0; i < parent.size(); ++i) first[i] = place[i];
      for (std::size_t i = 0; i < parent.size(); ++i) {
        if (parent[i] < 0) continue;
        const auto p = static_cast<std::size_t>(parent[i]);
        size[p] += size[i];
        first[p] = std::min(first[p], first[i]);
        EXPECT_LT(place[i], place[p]) << seed;
      }
      for (std::size_t i = 0; i < parent.size(); ++i) EXPECT_EQ(place[i] - first[i] + 1, size[i]) << seed << " " << i;
    }
  }
}

}  // namespace
}  // namespace bough::linear
