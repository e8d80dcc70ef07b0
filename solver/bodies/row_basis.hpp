#pragma once
/// \file Rows of a table that say all there is to say: of modes in one plane most integrals of products are zero or
/// equal, and what is not stored need not be multiplied.
#include <Eigen/Dense>

namespace bough::solver {

/// T = Eᵀ rows, with rows some of T's own.
struct RowBasis {
  Eigen::MatrixXd rows;  ///< r x columns of T
  Eigen::MatrixXd E;     ///< r x rows of T
};

/// Chooses a basis of the rows of T. A row below 1e-15 of `size` is zero; a row that others represent to a relative
/// 1e-14 is dependent.
RowBasis find_row_basis(const Eigen::MatrixXd& T, double size);

}  // namespace bough::solver
