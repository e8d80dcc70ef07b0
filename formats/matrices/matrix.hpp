#pragma once
/// \file A matrix as another program's file gives it: values, form, and the dofs of its rows where the file names them.
#include <string>
#include <vector>

#include "formats/records/static_result.hpp"

namespace bough::matrices {

/// Nastran's matrix forms, the ones that matter to a reader.
inline constexpr int kSquare = 1, kRectangular = 2, kDiagonal = 3, kSymmetric = 6;

struct Matrix {
  std::string name;  ///< as in the file, in its letters; empty if the format has no names
  int form = kSquare;
  records::SparseMatrix values;  ///< real parts; symmetric matrices are whole, whatever the file stores
  bool is_complex = false;
  std::vector<double> imaginary;  ///< of values.data, in its order; empty for a real matrix
  Eigen::MatrixXi row_dofs;       ///< rows x 2: node id, code 1..6 (0 for a scalar point); 0 x 2 when not known
  Eigen::MatrixXi column_dofs;    ///< the same for the columns; those of the rows in a square matrix

  /// Returns true if the file names the dofs of the rows.
  bool has_dofs() const { return row_dofs.rows() > 0; }
};

}  // namespace bough::matrices
