#include "fe/model/named_grid.hpp"

namespace bough::fe {
namespace {

void report_missing(int grid, const std::string& card, const SourceLocation& at, Diagnostics& diagnostics) {
  diagnostics.error("fe.missing-grid", at,
                    card + " names grid " + std::to_string(grid) + ", which the deck does not define",
                    "add the GRID or correct the id");
}

}  // namespace

int find_named_grid(const NodeTable& nodes, int grid, const std::string& card, const SourceLocation& at,
                    Diagnostics& diagnostics) {
  const int index = nodes.find_node(grid);
  if (index < 0 && !nodes.is_refused(grid)) report_missing(grid, card, at, diagnostics);
  return index;
}

int find_named_six(const NodeTable& nodes, int grid, const std::string& card, const SourceLocation& at,
                   Diagnostics& diagnostics) {
  const int index = find_named_grid(nodes, grid, card, at, diagnostics);
  if (index < 0 || nodes.node(index).num_dofs == 6) return index;
  report_missing(grid, card, at, diagnostics);
  return -1;
}

}  // namespace bough::fe
