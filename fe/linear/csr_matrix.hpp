#pragma once
/// \file Compressed rows as the storage of PETSc's matrices: nothing is copied, and memory can be returned for a while.
#include <memory>
#include <vector>

#include "fe/linear/petsc.hpp"

namespace bough::linear {

/// Rows with their columns ascending, and no room to spare.
struct Csr {
  int num_rows = 0;
  std::unique_ptr<int[]> start, columns;  ///< num_rows + 1; start[num_rows]
  std::unique_ptr<double[]> values;
  std::vector<int> groups;  ///< where the runs of rows with the same elements start, and the end
};

/// Room for the given number of entries, none set.
Csr make_csr(std::size_t num_rows, std::size_t num_entries);

/// The rows of a rank, from row `first` on: columns of local rows, counted from these, and all others, as PETSc keeps
/// them.
std::vector<Csr> split_columns(const Csr& rows, int first);

/// A square matrix on these arrays, which outlive it: the rows on this process alone, or split by columns on all of
/// several. PETSc's own way copies entry by entry: a tenth of a second for 240,000 rows.
PetscMat make_matrix(const std::vector<Csr>& storage, int size);

/// Gives the memory of columns and values back to the system; what is read there afterwards is zero.
void give_back_entries(const Csr& rows);
/// The entries of `from` into `to`, which has as many in each row.
void copy_entries(const Csr& from, const Csr& to);

}  // namespace bough::linear
