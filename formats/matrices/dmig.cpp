#include <algorithm>

#include "formats/matrices/detail/dofs.hpp"
#include "formats/matrices/detail/readers.hpp"
#include "formats/matrices/detail/triplets.hpp"
#include "formats/nastran/reader.hpp"

namespace bough::matrices::detail {
namespace {

Matrix make_matrix(const records::DirectMatrix& direct) {
  Matrix matrix;
  matrix.name = direct.name;
  matrix.form = direct.form == 6 ? kSymmetric : direct.form == 1 ? kSquare : kRectangular;
  const bool is_square = matrix.form != kRectangular;
  const bool has_numbered_columns = direct.form == 9;
  DofNumbers rows, columns;
  Triplets entries;
  int num_columns = 0;
  for (const auto& e : direct.entries) {
    const int row = rows.find_or_add({e.gi, e.ci});
    int column = e.gj - 1;
    if (!has_numbered_columns) column = (is_square ? rows : columns).find_or_add({e.gj, e.cj});
    num_columns = std::max(num_columns, column + 1);
    entries.add(row, column, e.value, e.imaginary);
  }
  const auto row_places = rows.sort(matrix.row_dofs);
  std::vector<int> column_places = row_places;
  if (has_numbered_columns) {
    column_places.resize(static_cast<std::size_t>(num_columns));
    for (std::size_t i = 0; i < column_places.size(); ++i) column_places[i] = static_cast<int>(i);
  } else if (!is_square) {
    column_places = columns.sort(matrix.column_dofs);
    num_columns = columns.size();
  } else {
    matrix.column_dofs = matrix.row_dofs;
    num_columns = rows.size();
  }
  entries.renumber(row_places, column_places);
  if (matrix.form == kSymmetric) entries.mirror(Triangle::Mirror);
  entries.compress(rows.size(), num_columns, direct.is_complex, matrix);
  return matrix;
}

}  // namespace

std::vector<Matrix> read_dmig(const std::string& path, Diagnostics& diagnostics) {
  const auto deck = nastran::read_deck(path, {}, diagnostics);
  diagnostics.throw_if_errors();
  std::vector<Matrix> matrices;
  for (const auto& direct : deck.direct_matrices) {
    const auto big = std::find_if(direct.entries.begin(), direct.entries.end(),
                                  [&](const auto& e) { return direct.form == 9 && (e.gj < 1 || e.gj > kMaxRows); });
    if (big != direct.entries.end())
      throw InputError("matrices.size", deck.locate(direct.at),
                       "matrix " + direct.name + " has a column " + std::to_string(big->gj) + ", expected 1 to " +
                           std::to_string(kMaxRows));
    matrices.push_back(make_matrix(direct));
  }
  return matrices;
}

}  // namespace bough::matrices::detail
