#include "fe/matrices/factor_need.hpp"

#include <cholmod.h>
#include <metis.h>

#include <algorithm>
#include <vector>

#include "base/diagnostic.hpp"
#include "fe/linear/memory_need.hpp"
#include "fe/linear/petsc.hpp"

namespace bough::fe {
namespace {

/// The graph of grids; METIS' memory.
struct MeshGraph {
  idx_t num = 0;
  idx_t *start = nullptr, *neighbours = nullptr;
  MeshGraph() = default;
  MeshGraph(const MeshGraph&) = delete;
  MeshGraph& operator=(const MeshGraph&) = delete;
  ~MeshGraph() {
    METIS_Free(start);
    METIS_Free(neighbours);
  }
};

/// False where METIS has no graph for it.
bool make_graph(const Model& model, MeshGraph& graph) {
  std::vector<int> node_of(static_cast<std::size_t>(model.num_gdofs()), 0);
  for (std::size_t k = 0; k < model.nodes().size(); ++k)
    for (int d = 0; d < model.nodes()[k].num_dofs; ++d)
      node_of[static_cast<std::size_t>(model.nodes()[k].first_gdof + d)] = static_cast<int>(k);
  std::vector<idx_t> first{0}, of_element;
  for (const auto& element : model.elements()) {
    const auto begin = static_cast<std::ptrdiff_t>(of_element.size());
    for (const int dof : element->gdofs()) of_element.push_back(node_of[static_cast<std::size_t>(dof)]);
    std::sort(of_element.begin() + begin, of_element.end());
    of_element.erase(std::unique(of_element.begin() + begin, of_element.end()), of_element.end());
    first.push_back(static_cast<idx_t>(of_element.size()));
  }
  graph.num = static_cast<idx_t>(model.nodes().size());
  idx_t num_elements = static_cast<idx_t>(first.size()) - 1, base = 0;
  return num_elements > 0 && METIS_MeshToNodal(&num_elements, &graph.num, first.data(), of_element.data(), &base,
                                               &graph.start, &graph.neighbours) == METIS_OK;
}

/// Entries of L of the graph's matrix in this order.
double count_entries(const MeshGraph& graph, const std::vector<idx_t>& order, const std::vector<idx_t>& place) {
  std::vector<int> start{0}, rows;
  for (idx_t j = 0; j < graph.num; ++j) {
    const idx_t node = order[static_cast<std::size_t>(j)];
    for (idx_t k = graph.start[node]; k < graph.start[node + 1]; ++k)
      if (const idx_t i = place[static_cast<std::size_t>(graph.neighbours[k])]; i < j) rows.push_back(i);
    rows.push_back(j);
    start.push_back(static_cast<int>(rows.size()));
  }
  const auto n = static_cast<std::size_t>(graph.num);
  cholmod_common common;
  cholmod_start(&common);
  common.print = 0;
  cholmod_sparse upper{};
  upper.nrow = upper.ncol = n;
  upper.nzmax = rows.size();
  upper.p = start.data();
  upper.i = rows.data();
  upper.stype = 1;
  upper.itype = CHOLMOD_INT;
  upper.xtype = CHOLMOD_PATTERN;
  upper.dtype = CHOLMOD_DOUBLE;
  upper.packed = 1;
  std::vector<int> parent(n), post(n), count(n), rest(2 * n);
  double sum = 0;
  // The counts are of the lower triangle by rows: its transpose.
  cholmod_sparse* lower = cholmod_ptranspose(&upper, 0, nullptr, nullptr, 0, &common);
  if (lower && cholmod_etree(&upper, parent.data(), &common) &&
      cholmod_postorder(parent.data(), n, nullptr, post.data(), &common) == static_cast<int>(n) &&
      cholmod_rowcolcounts(lower, nullptr, 0, parent.data(), post.data(), nullptr, count.data(), rest.data(),
                           rest.data() + n, &common))
    for (const int one : count) sum += one;
  cholmod_free_sparse(&lower, &common);
  cholmod_finish(&common);
  return sum;
}

}  // namespace

double estimate_factor_entries(const Model& model) {
  MeshGraph graph;
  if (!make_graph(model, graph)) return 0;
  std::vector<idx_t> order(static_cast<std::size_t>(graph.num)), place(order.size());
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  if (METIS_NodeND(&graph.num, graph.start, graph.neighbours, nullptr, options, order.data(), place.data()) != METIS_OK)
    return 0;
  const double dofs_of_grid = static_cast<double>(model.num_fdofs()) / std::max<double>(1, graph.num);
  return dofs_of_grid * dofs_of_grid * count_entries(graph, order, place);
}

void require_memory_for_factor(const Model& model, int min_fdofs) {
  constexpr double kMaxCounted = 2147483647;
  if (model.num_fdofs() < min_fdofs || linear::initialize_petsc().size > 1) return;
  const double num_entries = estimate_factor_entries(model), num_equations = model.num_fdofs();
  linear::require_memory(num_equations, num_entries, linear::calc_free_memory());
  if (num_entries > kMaxCounted)
    throw ComputationError("fe.out-of-memory", {},
                           "the factor of " + std::to_string(model.num_fdofs()) + " equations needs about " +
                               linear::format_bytes(linear::calc_factor_bytes(num_entries)) +
                               ": more entries than CHOLMOD counts on one process",
                           "run on two processes or more, where MUMPS factors (mpirun -n 2 bough ...)");
}

}  // namespace bough::fe
