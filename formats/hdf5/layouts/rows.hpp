#pragma once
/// \file Layouts by kind of file, and the rows that several kinds share.
#include <initializer_list>

#include "formats/hdf5/layouts.hpp"

namespace bough::hdf5 {

/// Joins lists of rows.
std::vector<LayoutRow> join_rows(std::initializer_list<std::vector<LayoutRow>> lists);

/// Root attributes of every file.
std::vector<LayoutRow> list_root_rows();
/// /grids and /mesh of files with a drawing.
std::vector<LayoutRow> list_mesh_rows();

/// Rows of the file of `reduce`.
Layout make_flex_body_layout();
/// Rows of the file of `modes` with real modes or load factors.
Layout make_modes_layout();
/// Rows of the file of `modes` with complex modes.
Layout make_complex_modes_layout();
/// Rows of the file of `static`.
Layout make_static_layout();
/// Rows of the file of `matrices`.
Layout make_matrices_layout();
/// Rows of the file of `linearize`.
Layout make_linear_layout();
/// Rows of the file of `linearize --sweep` and `--each`.
Layout make_sweep_layout();
/// Rows of the file of `response`.
Layout make_response_layout();
/// Rows of the files of `frequency` and `transient`, of which the page has one table.
Layout make_frequency_layout();
/// Rows of the file of `transient`.
Layout make_transient_layout();
/// Rows of the file of `response --budget`.
Layout make_budget_layout();

}  // namespace bough::hdf5
