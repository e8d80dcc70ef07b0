#include "fe/linear/dissection.hpp"

#include <algorithm>
#include <utility>

namespace bough::linear {
namespace {

/// Rows between the parts, of all: their dense blocks are factored three times.
constexpr double kMaxSeparatorShare = 0.12;

}  // namespace

std::vector<int> calc_postorder(const std::vector<const MatrixRows*>& matrices, PetscInt size,
                                const std::vector<PetscInt>& rows) {
  const auto n = static_cast<int>(rows.size());
  std::vector<int> place(static_cast<std::size_t>(size), n);
  for (int i = 0; i < n; ++i) place[static_cast<std::size_t>(rows[static_cast<std::size_t>(i)])] = i;
  // The root of the tree so far that i is in, by short cuts that every search adds.
  std::vector<int> parent(rows.size(), -1), above(rows.size(), -1);
  for (int j = 0; j < n; ++j)
    for (const MatrixRows* matrix : matrices) {
      const PetscInt row = rows[static_cast<std::size_t>(j)];
      for (PetscInt k = matrix->start[row]; k < matrix->start[row + 1]; ++k)
        for (int i = place[static_cast<std::size_t>(matrix->column[k])]; i < j;) {
          const int next = std::exchange(above[static_cast<std::size_t>(i)], j);
          if (next < 0) parent[static_cast<std::size_t>(i)] = j;
          i = next < 0 ? j : next;
        }
    }
  // Children before their parents, ascending.
  std::vector<int> first_child(rows.size(), -1), sibling(rows.size(), -1), order(rows.size()), stack;
  for (int i = n - 1; i >= 0; --i)
    if (const int p = parent[static_cast<std::size_t>(i)]; p >= 0)
      sibling[static_cast<std::size_t>(i)] = std::exchange(first_child[static_cast<std::size_t>(p)], i);
  auto at = order.rbegin();  // from the end: a parent, then its last child and all below it
  for (int root = n - 1; root >= 0; --root) {
    if (parent[static_cast<std::size_t>(root)] >= 0) continue;
    stack.push_back(root);
    while (!stack.empty()) {
      const int i = stack.back();
      stack.pop_back();
      *at++ = i;
      for (int c = first_child[static_cast<std::size_t>(i)]; c >= 0; c = sibling[static_cast<std::size_t>(c)])
        stack.push_back(c);
    }
  }
  return order;
}

std::optional<TwoParts> find_parts(const SymmetricMatrix& A, PetscInt min_rows) {
  const auto size_of = [](const auto& rows) { return static_cast<double>(rows.size()); };
  if (get_num_threads() > 1) {
    const auto two = find_two_parts(A, min_rows);
    const double first = two ? size_of(two->first) : 0, second = two ? size_of(two->second) : 0;
    if (two && size_of(two->between) < kMaxSeparatorShare * (first + second) &&
        std::min(first, second) > 0.3 * std::max(first, second))
      return *two;
  }
  const auto order = find_elimination_order(A, min_rows);
  if (!order) return std::nullopt;
  return TwoParts{*order, {}, {}};
}

}  // namespace bough::linear
