#include "formats/hdf5/layouts/rows.hpp"

namespace bough::hdf5 {

std::vector<LayoutRow> join_rows(std::initializer_list<std::vector<LayoutRow>> lists) {
  std::vector<LayoutRow> rows;
  for (const auto& list : lists) rows.insert(rows.end(), list.begin(), list.end());
  return rows;
}

std::vector<LayoutRow> list_root_rows() {
  return {
      {.path = "/@format", .kind = ArrayKind::Text, .note = "kind of file"},
      {.path = "/@format_version", .kind = ArrayKind::Text, .note = "any 1.x is readable, 2.0 is refused"},
      {.path = "/@bough_version", .kind = ArrayKind::Text, .note = "program that wrote the file"},
      {.path = "/@source",
       .kind = ArrayKind::Text,
       .shape = "inputs, 2",
       .note = "file name and SHA-256 of each input"},
  };
}

std::vector<LayoutRow> list_mesh_rows() {
  constexpr const char* kDrawing = "with elements to draw";
  return {
      {"/grids/id", ArrayKind::Integer, "g", "1", "ids of all grids", kDrawing},
      {"/grids/xyz", ArrayKind::Real, "g, 3", "L", "their positions in the body frame", kDrawing},
      {"/mesh/grid_id", ArrayKind::Integer, "g", "1", "ids of all grids", kDrawing, "", "second name of `/grids/id`"},
      {"/mesh/grid_xyz", ArrayKind::Real, "g, 3", "L", "their positions in the body frame", kDrawing, "",
       "second name of `/grids/xyz`"},
      {"/mesh/elements/{type}/connectivity", ArrayKind::Integer, "e, k", "1",
       "a row per element: its grids as 0-based indices into /grids/id", kDrawing},
      {"/mesh/elements/{type}/id", ArrayKind::Integer, "e", "1", "element ids", kDrawing},
      {"/mesh/elements/{type}@type", ArrayKind::Text, "", "", "", kDrawing, "", "`line2`, `tri3`, `quad4`, ..."},
      {"/mesh/elements/{type}@order", ArrayKind::Integer, "", "", "", kDrawing, "", "place among the groups, from 0"},
  };
}

const std::vector<Layout>& get_layouts() {
  static const std::vector<Layout> layouts{make_flex_body_layout(), make_modes_layout(),    make_complex_modes_layout(),
                                           make_static_layout(),    make_matrices_layout(), make_linear_layout(),
                                           make_sweep_layout(),     make_response_layout(), make_budget_layout(),
                                           make_frequency_layout(), make_transient_layout()};
  return layouts;
}

}  // namespace bough::hdf5
