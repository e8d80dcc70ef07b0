#pragma once
/// \file MATLAB files of level 5 (docs/formats/mat.md), through libmatio.
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "formats/records/static_result.hpp"

namespace bough::matrices {

struct MatValue;
using MatFields = std::vector<std::pair<std::string, MatValue>>;  ///< of a struct, in order
using MatCells = std::vector<MatValue>;                           ///< a column of cells

/// An array of two or more dimensions, first index fastest.
struct MatArray {
  std::vector<std::size_t> dims;
  std::vector<double> data;
};

struct MatValue {
  std::variant<MatArray, records::SparseMatrix, std::string, MatFields, MatCells> value;

  /// A real scalar, 1 x 1.
  MatValue(double number);  // NOLINT: a number is a value
  /// A real matrix, rows x columns.
  template <class Derived>
  MatValue(const Eigen::DenseBase<Derived>& matrix) : MatValue(from_matrix(matrix.derived())) {}
  /// A real array of any number of dimensions.
  MatValue(MatArray array);
  /// A sparse real matrix.
  MatValue(records::SparseMatrix matrix);
  /// A row of characters.
  MatValue(std::string text);
  /// A row of characters; `text` ends with a zero.
  MatValue(const char* text);
  /// A struct, 1 x 1.
  MatValue(MatFields fields);
  /// A cell array, n x 1.
  MatValue(MatCells cells);

  /// Copies a matrix to an array of two dimensions, column by column.
  static MatArray from_matrix(const Eigen::MatrixXd& matrix);
};

/// Writes under another name and renames. Names begin with a letter and have letters, digits, underscores, 63 at most.
/// Throws ComputationError "matrices.write".
void write_mat(const std::string& path, const MatFields& variables);

}  // namespace bough::matrices
