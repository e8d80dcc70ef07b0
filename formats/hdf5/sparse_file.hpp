#pragma once
/// \file Sparse matrices of any HDF5 file that keeps them as SciPy's compressed rows, Bough's own among them.
#include <string>
#include <utility>
#include <vector>

#include "formats/records/static_result.hpp"

namespace bough::hdf5 {

struct SparseFile {
  /// Matrices by path without the first slash: every group that holds data, indices, indptr and shape.
  std::vector<std::pair<std::string, records::SparseMatrix>> matrices;
  Eigen::MatrixXi dof_map;  ///< ndof x 2: node id, code; 0 x 2 where the file has none
};

/// Throws InputError "hdf5.cannot-open", "hdf5.truncated", "hdf5.shape", "hdf5.value", "hdf5.nan".
SparseFile read_sparse_file(const std::string& path);

}  // namespace bough::hdf5
