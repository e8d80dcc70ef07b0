#pragma once
/// \file Triangles as CHOLMOD reads them, the numbers of their rows, and its settings for a given order.
///
/// Internal to linear.
#include <algorithm>
#include <vector>

// First: the BLAS header needs PETSc's own names.
#include "fe/linear/petsc.hpp"

#include <cholmod.h>

namespace bough::linear {

/// View of the lower triangle of a symmetric matrix by columns, which CHOLMOD factors without transposing it.
/// \param start  [n + 1] where each column begins in `row`
/// \param value  one per entry of `row`; nullptr: the pattern alone
inline cholmod_sparse view_lower(std::vector<int>& start, std::vector<int>& row, double* value) {
  cholmod_sparse matrix{};
  matrix.nrow = matrix.ncol = start.size() - 1;
  matrix.nzmax = row.size();
  matrix.p = start.data();
  matrix.i = row.data();
  matrix.x = value;
  matrix.stype = -1;
  matrix.itype = CHOLMOD_INT;
  matrix.xtype = value == nullptr ? CHOLMOD_PATTERN : CHOLMOD_REAL;
  matrix.dtype = CHOLMOD_DOUBLE;
  matrix.packed = 1;
  return matrix;
}

/// Inverse of a list of rows: its entry r is the position of row r in the list, -1 if it is not in it.
/// \return [largest row + 1]
inline std::vector<int> number_rows(const std::vector<PetscInt>& rows) {
  std::vector<int> position(static_cast<std::size_t>(*std::max_element(rows.begin(), rows.end())) + 1, -1);
  for (std::size_t i = 0; i < rows.size(); ++i) position[static_cast<std::size_t>(rows[i])] = static_cast<int>(i);
  return position;
}

/// Starts CHOLMOD with supernodes in the order of the rows, which it does not change: separator rows stay last.
inline void start_in_order(cholmod_common& common) {
  cholmod_start(&common);
  common.print = 0;
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_NATURAL;
  common.postorder = 0;
  common.supernodal = CHOLMOD_SUPERNODAL;
}

}  // namespace bough::linear
