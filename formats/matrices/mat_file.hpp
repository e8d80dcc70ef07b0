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

  MatValue(double number);  // NOLINT: a number is a value
  template <class Derived>
  MatValue(const Eigen::DenseBase<Derived>& matrix) : MatValue(from_matrix(matrix.derived())) {}
  MatValue(MatArray array);
  MatValue(records::SparseMatrix matrix);
  MatValue(std::string text);
  MatValue(const char* text);
  MatValue(MatFields fields);
  MatValue(MatCells cells);

  static MatArray from_matrix(const Eigen::MatrixXd& matrix);
};

/// Writes under another name and renames. Names begin with a letter and have letters, digits, underscores, 63 at most.
/// Throws ComputationError "matrices.write".
void write_mat(const std::string& path, const MatFields& variables);

}  // namespace bough::matrices
