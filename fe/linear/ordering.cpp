#include "fe/linear/ordering.hpp"

#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "fe/linear/graph.hpp"

namespace bough::linear {
namespace {

static_assert(std::is_same_v<idx_t, PetscInt>, "graphs are handed to METIS as PetscInt");

/// Vertices are groups; two are neighbours where A couples any of their rows.
Graph build_group_graph(const PetscInt* row_start, const PetscInt* columns, const std::vector<int>& group_start) {
  const int num = static_cast<int>(group_start.size()) - 1;
  std::vector<int> group_of(group_start[num]), mark(num, -1);
  for (int g = 0; g < num; ++g)
    for (PetscInt row = group_start[g]; row < group_start[g + 1]; ++row) group_of[row] = g;
  Graph graph;
  for (int g = 0; g < num; ++g) {
    mark[g] = g;
    for (PetscInt k = row_start[group_start[g]]; k < row_start[group_start[g + 1]]; ++k) {
      const int other = group_of[columns[k]];
      if (mark[other] == g) continue;
      mark[other] = g;
      graph.neighbours.push_back(other);
    }
    graph.start.push_back(static_cast<idx_t>(graph.neighbours.size()));
    graph.weight.push_back(group_start[g + 1] - group_start[g]);
  }
  return graph;
}

/// The rows of groups in this order.
std::vector<PetscInt> list_rows(const std::vector<idx_t>& groups, const std::vector<int>& group_start) {
  std::vector<PetscInt> rows;
  for (const idx_t g : groups)
    for (PetscInt row = group_start[g]; row < group_start[g + 1]; ++row) rows.push_back(row);
  return rows;
}

/// Calls `use(graph, group_start)` with the graph of the row groups of A; not where A has none, is smaller than
/// `least`, or lives on several processes.
template <class Use>
void visit_group_graph(const SymmetricMatrix& A, PetscInt min_rows, const Use& use) {
  const auto groups = A.row_order().groups;
  PetscInt size = A.num_rows();
  if (!groups || size < min_rows || initialize_petsc().size > 1) return;
  const PetscInt *row_start = nullptr, *columns = nullptr;
  PetscBool done = PETSC_FALSE;
  check_petsc(MatGetRowIJ(A.sparse(), 0, PETSC_FALSE, PETSC_FALSE, &size, &row_start, &columns, &done));
  if (done) {
    Graph graph = build_group_graph(row_start, columns, *groups);
    if (!graph.neighbours.empty()) use(graph, *groups);
  }
  check_petsc(MatRestoreRowIJ(A.sparse(), 0, PETSC_FALSE, PETSC_FALSE, &size, &row_start, &columns, &done));
}

/// A may have got entries since its parts were found.
bool are_apart(const SymmetricMatrix& A, const TwoParts& parts) {
  PetscInt size = 0;
  const PetscInt *start = nullptr, *columns = nullptr;
  PetscBool done = PETSC_FALSE;
  check_petsc(MatGetRowIJ(A.sparse(), 0, PETSC_FALSE, PETSC_FALSE, &size, &start, &columns, &done));
  bool apart = done == PETSC_TRUE;
  if (apart) {
    std::vector<char> is_second(static_cast<std::size_t>(size), 0);
    for (const PetscInt row : parts.second) is_second[static_cast<std::size_t>(row)] = 1;
    for (const PetscInt row : parts.first)
      for (PetscInt k = start[row]; k < start[row + 1]; ++k)
        apart = apart && is_second[static_cast<std::size_t>(columns[k])] == 0;
  }
  check_petsc(MatRestoreRowIJ(A.sparse(), 0, PETSC_FALSE, PETSC_FALSE, &size, &start, &columns, &done));
  return apart;
}

}  // namespace

void copy_row_order(const SymmetricMatrix& from, const SymmetricMatrix& to) {
  const RowOrder& known = from.row_order();
  RowOrder& copy = to.row_order();
  if (known.groups) copy.groups = known.groups;
  if (known.order) copy.order = known.order;
  if (known.parts) copy.parts = known.parts;
}

void take_row_order(const SymmetricMatrix& whole, const std::vector<int>& kept, const SymmetricMatrix& part) {
  constexpr double kNearlyAll = 0.9;
  const RowOrder& known = whole.row_order();
  if (kept.empty() || !known.groups) return;
  const std::vector<int>& start = *known.groups;
  std::vector<int> own{0};
  for (std::size_t i = 1, group = 0; i < kept.size(); ++i) {
    while (start[group + 1] <= kept[i - 1]) ++group;
    if (kept[i] >= start[group + 1]) own.push_back(static_cast<int>(i));
  }
  own.push_back(static_cast<int>(kept.size()));
  part.row_order().groups = std::make_shared<const std::vector<int>>(std::move(own));

  const auto size = static_cast<std::size_t>(whole.num_rows());
  if (!known.order || static_cast<double>(kept.size()) < kNearlyAll * static_cast<double>(size)) return;
  std::vector<PetscInt> place(size, -1), order;
  for (std::size_t i = 0; i < kept.size(); ++i) place[static_cast<std::size_t>(kept[i])] = static_cast<PetscInt>(i);
  for (const PetscInt whole_row : *known.order)
    if (const PetscInt row = place[static_cast<std::size_t>(whole_row)]; row >= 0) order.push_back(row);
  part.row_order().order = std::make_shared<const std::vector<PetscInt>>(std::move(order));
}

std::shared_ptr<const std::vector<PetscInt>> find_elimination_order(const SymmetricMatrix& A, PetscInt min_rows) {
  auto& known = A.row_order().order;
  if (A.num_rows() < min_rows) return nullptr;
  if (known) return known;
  visit_group_graph(A, min_rows, [&](Graph& graph, const std::vector<int>& group_start) {
    std::vector<PetscInt> order = list_rows(find_dissection(graph), group_start);
    if (!order.empty()) known = std::make_shared<const std::vector<PetscInt>>(std::move(order));
  });
  return known;
}

std::shared_ptr<const TwoParts> find_two_parts(const SymmetricMatrix& A, PetscInt min_rows) {
  if (A.num_rows() < min_rows) return nullptr;
  auto& known = A.row_order().parts;
  if (known && are_apart(A, *known)) return known;
  std::optional<TwoParts> result;
  visit_group_graph(A, min_rows, [&](Graph& graph, const std::vector<int>& group_start) {
    const std::vector<idx_t> part = find_separator(graph);
    if (part.empty()) return;
    std::vector<idx_t> groups[3];
    for (std::size_t g = 0; g < part.size(); ++g) groups[part[g]].push_back(static_cast<idx_t>(g));
    for (std::vector<idx_t>* own : {&groups[0], &groups[1]}) {
      Graph sub = take_vertices(graph, *own);
      const std::vector<idx_t> order = find_dissection(sub);
      if (order.size() != own->size()) return;
      std::vector<idx_t> sorted;
      for (const idx_t v : order) sorted.push_back((*own)[static_cast<std::size_t>(v)]);
      *own = std::move(sorted);
    }
    result = {list_rows(groups[0], group_start), list_rows(groups[1], group_start), list_rows(groups[2], group_start)};
  });
  if (!result) return nullptr;
  known = std::make_shared<const TwoParts>(std::move(*result));
  return known;
}

}  // namespace bough::linear
