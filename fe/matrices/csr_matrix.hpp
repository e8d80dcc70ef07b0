#pragma once
/// \file A matrix of PETSc on arrays of ours: nothing is copied, and its memory can be given back for a while.
#include <memory>
#include <vector>

#include "fe/linear/petsc.hpp"

namespace bough::fe {

/// Rows with their columns ascending, and no room to spare.
struct Csr {
  int num_rows = 0;
  std::unique_ptr<int[]> start, columns;  ///< num_rows + 1; start[num_rows]
  std::unique_ptr<double[]> values;
  std::vector<int> groups;  ///< where the runs of rows with the same elements start, and the end
};

/// Room for so many entries, none set.
Csr make_csr(std::size_t num_rows, std::size_t num_entries);

/// On this process alone. PETSc's own way copies entry by entry: a tenth of a second for 240,000 rows.
PetscMat make_matrix(Csr rows, int num_columns);
/// On all processes, square: `rows` are this one's, from row `first` on, of `size` on all. Collective. PETSc keeps the
/// columns of its own rows apart from the others, and so do these arrays.
PetscMat make_matrix_of_ranks(Csr rows, int first, int size);

/// Gives the memory of the entries back to the system; until fill_entries() nobody may read them. False, and nothing
/// happens, where A is not of make_matrix().
bool drop_entries(Mat A);
/// The same entries again: as many in each row.
void fill_entries(Mat A, const Csr& rows);

}  // namespace bough::fe
