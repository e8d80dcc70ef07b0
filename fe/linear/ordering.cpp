#include "fe/linear/ordering.hpp"

#include <metis.h>

#include <type_traits>

namespace bough::fe {
namespace {

static_assert(std::is_same_v<idx_t, PetscInt>, "graphs are handed to METIS as PetscInt");

constexpr const char* kGroups = "bough_row_groups";
constexpr const char* kOrder = "bough_elimination_order";
/// Below this the solver's own order costs less than it could gain.
constexpr PetscInt kSmall = 3000;
/// Neighbours of a vertex, on average, of a mesh; of beams in lines there are two. Minimum degree eliminates a line
/// from its free end, which loses fewer digits than dissection does by condensing pieces that nothing holds.
constexpr std::size_t kMesh = 4;

struct Graph {
  std::vector<idx_t> start{0}, neighbours, weight;
};

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
  PetscIs groups;
  check_petsc(ISCreateGeneral(PETSC_COMM_SELF, static_cast<PetscInt>(start.size()), start.data(), PETSC_COPY_VALUES,
                              groups.out()));
  check_petsc(
      PetscObjectCompose(reinterpret_cast<PetscObject>(A), kGroups, reinterpret_cast<PetscObject>(groups.get())));
}

void copy_row_groups(Mat from, Mat to) {
  for (const char* name : {kGroups, kOrder}) {
    PetscObject object = nullptr;
    check_petsc(PetscObjectQuery(reinterpret_cast<PetscObject>(from), name, &object));
    if (object) check_petsc(PetscObjectCompose(reinterpret_cast<PetscObject>(to), name, object));
  }
}

PetscIs find_elimination_order(Mat A) {
  PetscObject object = nullptr;
  check_petsc(PetscObjectQuery(reinterpret_cast<PetscObject>(A), kGroups, &object));
  PetscInt size = 0;
  check_petsc(MatGetSize(A, &size, nullptr));
  if (!object || size < kSmall || initialize_petsc().size > 1) return {};
  PetscObject known = nullptr;
  check_petsc(PetscObjectQuery(reinterpret_cast<PetscObject>(A), kOrder, &known));
  if (known) {
    check_petsc(PetscObjectReference(known));
    return PetscIs(reinterpret_cast<IS>(known));
  }

  const IS groups = reinterpret_cast<IS>(object);
  PetscInt num_groups = 0;
  const PetscInt *group_start = nullptr, *row_start = nullptr, *columns = nullptr;
  PetscBool done = PETSC_FALSE;
  check_petsc(ISGetSize(groups, &num_groups));
  --num_groups;
  check_petsc(ISGetIndices(groups, &group_start));
  check_petsc(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &size, &row_start, &columns, &done));
  std::vector<PetscInt> order;
  if (done) {
    Graph graph = build_group_graph(row_start, columns, group_start, num_groups);
    std::vector<idx_t> rank(num_groups), inverse(num_groups);
    idx_t num = num_groups, options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    if (!graph.neighbours.empty() &&
        METIS_NodeND(&num, graph.start.data(), graph.neighbours.data(), graph.weight.data(), options, rank.data(),
                     inverse.data()) == METIS_OK)
      for (const idx_t g : rank)
        for (PetscInt row = group_start[g]; row < group_start[g + 1]; ++row) order.push_back(row);
  }
  check_petsc(MatRestoreRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &size, &row_start, &columns, &done));
  check_petsc(ISRestoreIndices(groups, &group_start));
  PetscIs result;
  if (order.empty()) return result;
  check_petsc(ISCreateGeneral(PETSC_COMM_SELF, static_cast<PetscInt>(order.size()), order.data(), PETSC_COPY_VALUES,
                              result.out()));
  check_petsc(ISSetPermutation(result.get()));
  check_petsc(
      PetscObjectCompose(reinterpret_cast<PetscObject>(A), kOrder, reinterpret_cast<PetscObject>(result.get())));
  return result;
}

}  // namespace bough::fe
