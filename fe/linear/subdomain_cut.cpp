/// Which rows are inner ones of a rank and which lie between.
#include <algorithm>
#include <numeric>
#include <utility>

#include "fe/linear/graph.hpp"
#include "fe/linear/low_rank_sum.hpp"
#include "fe/linear/ordering.hpp"
#include "fe/linear/own_entries.hpp"
#include "fe/linear/ranks.hpp"
#include "fe/linear/subdomains.hpp"

namespace bough::fe {
namespace {

using Eigen::Index;

/// Rows between, whose dense block every rank holds twice and works on for n³ operations: 580 MB, five seconds.
constexpr PetscInt kMostRowsBetween = 6000;
/// Of all rows, where they are too many to cost nothing: two to four parts of solids have 3 to 10 %.
constexpr double kMostShare = 0.12;
constexpr PetscInt kFewBetween = 1000;

std::vector<int> list_group_of(const std::vector<PetscInt>& group_start) {
  std::vector<int> group_of(static_cast<std::size_t>(group_start.back()));
  for (std::size_t g = 0; g + 1 < group_start.size(); ++g)
    std::fill(group_of.begin() + group_start[g], group_of.begin() + group_start[g + 1], static_cast<int>(g));
  return group_of;
}

/// Concatenated on the first rank.
std::vector<int> collect(const std::vector<int>& own, const MpiWorld& world) {
  const int num = static_cast<int>(own.size());
  std::vector<int> nums(static_cast<std::size_t>(world.size)), starts(nums.size(), 0), all;
  MPI_Gather(&num, 1, MPI_INT, nums.data(), 1, MPI_INT, 0, PETSC_COMM_WORLD);
  if (world.rank == 0) {
    std::partial_sum(nums.begin(), nums.end() - 1, starts.begin() + 1);
    all.resize(static_cast<std::size_t>(starts.back() + nums.back()));
  }
  MPI_Gatherv(own.data(), num, MPI_INT, all.data(), nums.data(), starts.data(), MPI_INT, 0, PETSC_COMM_WORLD);
  return all;
}

/// From the rows that each rank holds, on the first; groups begin anew with the rows of a rank.
Graph build_group_graph(Mat A, Mat B, const std::vector<PetscInt>& group_start, const MpiWorld& world) {
  const std::vector<int> group_of = list_group_of(group_start);
  PetscInt first = 0, last = 0, num = 0;
  check_petsc(MatGetOwnershipRange(A, &first, &last));
  const PetscInt* columns = nullptr;
  const int num_groups = static_cast<int>(group_start.size()) - 1;
  std::vector<int> degree, neighbours, mark(static_cast<std::size_t>(num_groups), -1);
  for (int g = 0; g < num_groups; ++g) {
    if (group_start[g] < first || group_start[g] >= last) continue;
    const std::size_t before = neighbours.size();
    mark[g] = g;
    for (PetscInt row = group_start[g]; row < group_start[g + 1]; ++row)
      for (Mat matrix : {A, B}) {
        check_petsc(MatGetRow(matrix, row, &num, &columns, nullptr));
        for (PetscInt k = 0; k < num; ++k)
          if (const int other = group_of[columns[k]]; mark[other] != g) mark[other] = g, neighbours.push_back(other);
        check_petsc(MatRestoreRow(matrix, row, &num, &columns, nullptr));
      }
    degree.push_back(static_cast<int>(neighbours.size() - before));
  }
  degree = collect(degree, world);
  Graph graph;
  graph.neighbours = collect(neighbours, world);
  if (world.rank != 0) return graph;
  for (int g = 0; g < num_groups; ++g) {
    graph.start.push_back(graph.start.back() + degree[g]);
    graph.weight.push_back(group_start[g + 1] - group_start[g]);
  }
  return graph;
}

/// The part of every group, `num_parts` for those between: of an edge between two parts the end in the higher one, so
/// that one line along a cut is enough. Empty where there are none or a part has no inner group.
std::vector<idx_t> cut(Graph& graph, idx_t num_parts) {
  const std::vector<idx_t> home = cut_into_parts(graph, num_parts);
  std::vector<idx_t> part = home;
  std::vector<char> has_inner(static_cast<std::size_t>(num_parts) + 1, 0);
  for (std::size_t g = 0; g < part.size(); ++g) {
    for (idx_t k = graph.start[g]; k < graph.start[g + 1]; ++k)
      if (home[static_cast<std::size_t>(graph.neighbours[k])] < home[g]) part[g] = num_parts;
    has_inner[static_cast<std::size_t>(part[g])] = 1;
  }
  if (std::any_of(has_inner.begin(), has_inner.end() - 1, [](char has) { return has == 0; })) return {};
  return part;
}

/// The rows of the groups of this rank's part in the order of a nested dissection. visit(i, use): use(j) with the inner
/// rows, numbered as in `inner`, that the i-th couples to, -1 for others.
template <class Visit>
std::vector<PetscInt> order_inner(const std::vector<PetscInt>& inner, const std::vector<int>& group_of,
                                  const Visit& visit) {
  Graph graph;
  std::vector<idx_t> first_row, vertex(inner.size());
  for (std::size_t i = 0; i < inner.size(); ++i) {
    if (i == 0 || group_of[inner[i]] != group_of[inner[i - 1]])
      graph.weight.push_back(0), first_row.push_back(static_cast<idx_t>(i));
    ++graph.weight.back();
    vertex[i] = graph.size() - 1;
  }
  std::vector<idx_t> mark(graph.weight.size(), -1);
  for (idx_t v = 0; v < graph.size(); ++v) {
    mark[v] = v;
    for (idx_t i = first_row[v]; i < first_row[v] + graph.weight[v]; ++i)
      visit(i, [&](PetscInt j) {
        if (j < 0) return;
        const idx_t other = vertex[static_cast<std::size_t>(j)];
        if (mark[other] != v) mark[other] = v, graph.neighbours.push_back(other);
      });
    graph.start.push_back(static_cast<idx_t>(graph.neighbours.size()));
  }
  const std::vector<idx_t> order = find_dissection(graph);
  if (order.empty()) return inner;
  std::vector<PetscInt> rows;
  for (const idx_t v : order)
    for (idx_t i = first_row[v]; i < first_row[v] + graph.weight[v]; ++i)
      rows.push_back(inner[static_cast<std::size_t>(i)]);
  return rows;
}

std::vector<PetscInt> order_inner(Mat A, const Subdomains& domains, const std::vector<int>& group_of) {
  const PetscInt n_p = domains.num_inner();
  if (!domains.by_parts) {
    const SubdomainMatrix sub(A, domains);
    return order_inner(domains.inner, group_of, [&](PetscInt i, const auto& use) {
      for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator entry(sub.rows(), i); entry; ++entry)
        use(entry.col() < n_p ? static_cast<PetscInt>(entry.col()) : -1);
    });
  }
  const OwnEntries own(A);
  std::vector<PetscInt> place(static_cast<std::size_t>(own.last() - own.first()), -1);
  for (PetscInt i = 0; i < n_p; ++i) place[static_cast<std::size_t>(domains.inner[i] - own.first())] = i;
  return order_inner(domains.inner, group_of, [&](PetscInt i, const auto& use) {
    own.visit(domains.inner[i], [&](PetscInt column, double) {
      use(column >= own.first() && column < own.last() ? place[static_cast<std::size_t>(column - own.first())] : -1);
    });
  });
}

/// Inner rows and those between, by METIS; false where there are no parts. Shares of the rows between are alike.
bool cut_rows(Mat A, Mat B, const std::vector<PetscInt>& group_start, const MpiWorld& world, Subdomains& result) {
  const int num_groups = static_cast<int>(group_start.size()) - 1;
  std::vector<idx_t> part;
  {
    Graph graph = build_group_graph(A, B, group_start, world);
    if (world.rank == 0) part = cut(graph, world.size);
  }
  int is_cut = part.empty() ? 0 : 1;
  MPI_Bcast(&is_cut, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  if (is_cut == 0) return false;
  part.resize(static_cast<std::size_t>(num_groups));
  MPI_Bcast(part.data(), num_groups, MPI_INT, 0, PETSC_COMM_WORLD);
  for (int g = 0; g < num_groups; ++g)
    for (PetscInt row = group_start[g]; row < group_start[g + 1]; ++row)
      if (part[g] == world.rank)
        result.inner.push_back(row);
      else if (part[g] == world.size)
        result.between.push_back(row);
  const auto between = static_cast<long long>(result.between.size());
  result.first_shared = static_cast<PetscInt>(between * world.rank / world.size);
  result.num_shared = static_cast<PetscInt>(between * (world.rank + 1) / world.size) - result.first_shared;
  return true;
}

/// The same of rows that are by parts already: of those of two ranks that couple the ones of the higher rank lie
/// between, with all of their group. Nothing but their numbers is sent, and a rank's share of them are its own.
bool take_parts(Mat A, Mat B, const std::vector<PetscInt>& group_start, Subdomains& result) {
  const OwnEntries a(A), b(B);
  const PetscInt first = a.first(), last = a.last();
  std::vector<int> between;
  auto group = std::lower_bound(group_start.begin(), group_start.end(), first);
  for (; group != group_start.end() && *group < last; ++group) {
    bool reaches_below = false;
    for (PetscInt row = *group; row < group[1]; ++row)
      for (const OwnEntries* matrix : {&a, &b})
        matrix->visit(row, [&](PetscInt column, double) { reaches_below = reaches_below || column < first; });
    auto& rows = reaches_below ? between : result.inner;
    for (PetscInt row = *group; row < group[1]; ++row) rows.push_back(row);
  }
  result.between = join_over_ranks(between);
  result.first_shared = static_cast<PetscInt>(std::lower_bound(result.between.begin(), result.between.end(), first) -
                                              result.between.begin());
  result.num_shared = static_cast<PetscInt>(between.size());
  return are_all(!result.inner.empty());
}

PetscInt get_id(Mat B) {
  PetscObjectId id = 0;
  check_petsc(PetscObjectGetId(reinterpret_cast<PetscObject>(B), &id));
  return static_cast<PetscInt>(id);
}

constexpr const char* kSubdomains = "bough_subdomains";  // inner rows, those between, and the numbers of Subdomains

void keep(const Subdomains& domains, Mat A, Mat B) {
  std::vector<PetscInt> all = domains.inner;
  all.insert(all.end(), domains.between.begin(), domains.between.end());
  all.insert(all.end(),
             {domains.num_between(), domains.first_shared, domains.num_shared, domains.by_parts ? 1 : 0, get_id(B)});
  PetscIs kept;
  check_petsc(
      ISCreateGeneral(PETSC_COMM_SELF, static_cast<PetscInt>(all.size()), all.data(), PETSC_COPY_VALUES, kept.out()));
  check_petsc(
      PetscObjectCompose(reinterpret_cast<PetscObject>(A), kSubdomains, reinterpret_cast<PetscObject>(kept.get())));
}

std::optional<Subdomains> find_known(Mat A, Mat B) {
  PetscObject object = nullptr;
  check_petsc(PetscObjectQuery(reinterpret_cast<PetscObject>(A), kSubdomains, &object));
  if (!object) return std::nullopt;
  const IS all = reinterpret_cast<IS>(object);
  PetscInt size = 0;
  const PetscInt* numbers = nullptr;
  check_petsc(ISGetSize(all, &size));
  check_petsc(ISGetIndices(all, &numbers));
  const PetscInt *end = numbers + size - 5, *between = end - end[0];
  Subdomains domains{{numbers, between}, {between, end}, end[1], end[2], 0, end[3] == 1};
  const bool is_same = end[4] == get_id(B);
  check_petsc(ISRestoreIndices(all, &numbers));
  check_petsc(MatGetSize(A, &domains.size, nullptr));
  if (!is_same) return std::nullopt;
  return domains;
}

}  // namespace

std::optional<Subdomains> find_subdomains(Mat A, Mat B, PetscInt least) {
  const MpiWorld world = initialize_petsc();
  Subdomains result;
  check_petsc(MatGetSize(A, &result.size, nullptr));
  if (world.size == 1 || result.size < least || find_low_rank(A) || find_low_rank(B)) return std::nullopt;
  if (auto known = find_known(A, B)) return known;
  const std::vector<PetscInt> group_start = get_row_groups(A);
  if (group_start.size() < 2) return std::nullopt;
  result.by_parts = are_rows_by_parts(A);
  if (!(result.by_parts ? take_parts(A, B, group_start, result) : cut_rows(A, B, group_start, world, result)))
    return std::nullopt;
  const auto between = static_cast<long long>(result.between.size());
  if (between > kMostRowsBetween || (between > kFewBetween && static_cast<double>(between) > kMostShare * result.size))
    return std::nullopt;
  result.inner = order_inner(A, result, list_group_of(group_start));
  keep(result, A, B);
  return result;
}

}  // namespace bough::fe
