#include "fe/linear/ordering.hpp"

#include <type_traits>
#include <utility>
#include <vector>

#include "fe/linear/graph.hpp"

namespace bough::fe {
namespace {

static_assert(std::is_same_v<idx_t, PetscInt>, "graphs are handed to METIS as PetscInt");

constexpr const char* kGroups = "bough_row_groups";
constexpr const char* kOrder = "bough_elimination_order";
constexpr const char* kParts =
    "bough_two_parts";  // rows of the first, of the second, between; how many there are of each

/// Vertices are groups; two are neighbours where A couples any of their rows.
Graph build_group_graph(const PetscInt* row_start, const PetscInt* columns, const PetscInt* group_start, int num) {
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

}  // namespace

void set_row_groups(Mat A, const std::vector<int>& start) {
  if (initialize_petsc().size > 1) return;  // MUMPS orders
  PetscIs groups;
  check_petsc(ISCreateGeneral(PETSC_COMM_SELF, static_cast<PetscInt>(start.size()), start.data(), PETSC_COPY_VALUES,
                              groups.out()));
  check_petsc(
      PetscObjectCompose(reinterpret_cast<PetscObject>(A), kGroups, reinterpret_cast<PetscObject>(groups.get())));
}

void copy_row_groups(Mat from, Mat to) {
  for (const char* name : {kGroups, kOrder, kParts}) {
    PetscObject object = nullptr;
    check_petsc(PetscObjectQuery(reinterpret_cast<PetscObject>(from), name, &object));
    if (object) check_petsc(PetscObjectCompose(reinterpret_cast<PetscObject>(to), name, object));
  }
}

void take_row_groups(Mat whole, const std::vector<int>& kept, Mat part) {
  constexpr double kNearlyAll = 0.9;
  PetscObject object = nullptr;
  PetscInt size = 0;
  check_petsc(MatGetSize(whole, &size, nullptr));
  if (kept.empty() || initialize_petsc().size > 1) return;
  check_petsc(PetscObjectQuery(reinterpret_cast<PetscObject>(whole), kGroups, &object));
  if (!object) return;
  const PetscInt* start = nullptr;
  check_petsc(ISGetIndices(reinterpret_cast<IS>(object), &start));
  std::vector<int> own{0};
  for (std::size_t i = 1, group = 0; i < kept.size(); ++i) {
    while (start[group + 1] <= kept[i - 1]) ++group;
    if (kept[i] >= start[group + 1]) own.push_back(static_cast<int>(i));
  }
  own.push_back(static_cast<int>(kept.size()));
  check_petsc(ISRestoreIndices(reinterpret_cast<IS>(object), &start));
  set_row_groups(part, own);

  check_petsc(PetscObjectQuery(reinterpret_cast<PetscObject>(whole), kOrder, &object));
  if (!object || static_cast<double>(kept.size()) < kNearlyAll * size) return;
  std::vector<PetscInt> place(static_cast<std::size_t>(size), -1), order;
  for (std::size_t i = 0; i < kept.size(); ++i) place[static_cast<std::size_t>(kept[i])] = static_cast<PetscInt>(i);
  const PetscInt* rows = nullptr;
  check_petsc(ISGetIndices(reinterpret_cast<IS>(object), &rows));
  for (PetscInt i = 0; i < size; ++i)
    if (const PetscInt row = place[static_cast<std::size_t>(rows[i])]; row >= 0) order.push_back(row);
  check_petsc(ISRestoreIndices(reinterpret_cast<IS>(object), &rows));
  PetscIs kept_order;
  check_petsc(ISCreateGeneral(PETSC_COMM_SELF, static_cast<PetscInt>(order.size()), order.data(), PETSC_COPY_VALUES,
                              kept_order.out()));
  check_petsc(ISSetPermutation(kept_order.get()));
  check_petsc(
      PetscObjectCompose(reinterpret_cast<PetscObject>(part), kOrder, reinterpret_cast<PetscObject>(kept_order.get())));
}

namespace {

/// The rows of groups in this order.
std::vector<PetscInt> list_rows(const std::vector<idx_t>& groups, const PetscInt* group_start) {
  std::vector<PetscInt> rows;
  for (const idx_t g : groups)
    for (PetscInt row = group_start[g]; row < group_start[g + 1]; ++row) rows.push_back(row);
  return rows;
}

/// Calls `use(graph, group_start)` with the graph of the row groups of A; not where A has none, is smaller than
/// `least`, or lives on several processes.
template <class Use>
void visit_group_graph(Mat A, PetscInt least, const Use& use) {
  PetscObject object = nullptr;
  check_petsc(PetscObjectQuery(reinterpret_cast<PetscObject>(A), kGroups, &object));
  PetscInt size = 0;
  check_petsc(MatGetSize(A, &size, nullptr));
  if (!object || size < least || initialize_petsc().size > 1) return;
  const IS groups = reinterpret_cast<IS>(object);
  PetscInt num_groups = 0;
  const PetscInt *group_start = nullptr, *row_start = nullptr, *columns = nullptr;
  PetscBool done = PETSC_FALSE;
  check_petsc(ISGetSize(groups, &num_groups));
  --num_groups;
  check_petsc(ISGetIndices(groups, &group_start));
  check_petsc(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &size, &row_start, &columns, &done));
  if (done) {
    Graph graph = build_group_graph(row_start, columns, group_start, num_groups);
    if (!graph.neighbours.empty()) use(graph, group_start);
  }
  check_petsc(MatRestoreRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &size, &row_start, &columns, &done));
  check_petsc(ISRestoreIndices(groups, &group_start));
}

}  // namespace

PetscIs find_elimination_order(Mat A, PetscInt least) {
  PetscObject known = nullptr;
  check_petsc(PetscObjectQuery(reinterpret_cast<PetscObject>(A), kOrder, &known));
  PetscInt size = 0;
  check_petsc(MatGetSize(A, &size, nullptr));
  if (size < least) return {};
  if (known) {
    check_petsc(PetscObjectReference(known));
    return PetscIs(reinterpret_cast<IS>(known));
  }
  PetscIs result;
  visit_group_graph(A, least, [&](Graph& graph, const PetscInt* group_start) {
    const std::vector<PetscInt> order = list_rows(find_dissection(graph), group_start);
    if (order.empty()) return;
    check_petsc(ISCreateGeneral(PETSC_COMM_SELF, static_cast<PetscInt>(order.size()), order.data(), PETSC_COPY_VALUES,
                                result.out()));
    check_petsc(ISSetPermutation(result.get()));
    check_petsc(
        PetscObjectCompose(reinterpret_cast<PetscObject>(A), kOrder, reinterpret_cast<PetscObject>(result.get())));
  });
  return result;
}

namespace {

std::optional<TwoParts> find_known_parts(Mat A) {
  PetscObject object = nullptr;
  check_petsc(PetscObjectQuery(reinterpret_cast<PetscObject>(A), kParts, &object));
  if (!object) return std::nullopt;
  const IS all = reinterpret_cast<IS>(object);
  PetscInt size = 0;
  const PetscInt* rows = nullptr;
  check_petsc(ISGetSize(all, &size));
  check_petsc(ISGetIndices(all, &rows));
  const PetscInt* num = rows + size - 3;
  TwoParts parts;
  for (auto* part : {&parts.first, &parts.second, &parts.between}) {
    part->assign(rows, rows + *num);
    rows += *num++;
  }
  rows -= size - 3;
  check_petsc(ISRestoreIndices(all, &rows));
  return parts;
}

/// A may have got entries since its parts were found.
bool are_apart(Mat A, const TwoParts& parts) {
  PetscInt size = 0;
  const PetscInt *start = nullptr, *columns = nullptr;
  PetscBool done = PETSC_FALSE;
  check_petsc(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &size, &start, &columns, &done));
  bool apart = done == PETSC_TRUE;
  if (apart) {
    std::vector<char> is_second(static_cast<std::size_t>(size), 0);
    for (const PetscInt row : parts.second) is_second[static_cast<std::size_t>(row)] = 1;
    for (const PetscInt row : parts.first)
      for (PetscInt k = start[row]; k < start[row + 1]; ++k)
        apart = apart && is_second[static_cast<std::size_t>(columns[k])] == 0;
  }
  check_petsc(MatRestoreRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &size, &start, &columns, &done));
  return apart;
}

void keep_parts(const TwoParts& parts, Mat A) {
  std::vector<PetscInt> all, sizes;
  for (const auto* part : {&parts.first, &parts.second, &parts.between}) {
    all.insert(all.end(), part->begin(), part->end());
    sizes.push_back(static_cast<PetscInt>(part->size()));
  }
  all.insert(all.end(), sizes.begin(), sizes.end());
  PetscIs kept;
  check_petsc(
      ISCreateGeneral(PETSC_COMM_SELF, static_cast<PetscInt>(all.size()), all.data(), PETSC_COPY_VALUES, kept.out()));
  check_petsc(PetscObjectCompose(reinterpret_cast<PetscObject>(A), kParts, reinterpret_cast<PetscObject>(kept.get())));
}

}  // namespace

std::optional<TwoParts> find_two_parts(Mat A, PetscInt least) {
  PetscInt size = 0;
  check_petsc(MatGetSize(A, &size, nullptr));
  if (size < least) return std::nullopt;
  std::optional<TwoParts> result = find_known_parts(A);
  if (result && are_apart(A, *result)) return result;
  result.reset();
  visit_group_graph(A, least, [&](Graph& graph, const PetscInt* group_start) {
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
  if (result) keep_parts(*result, A);
  return result;
}

}  // namespace bough::fe
