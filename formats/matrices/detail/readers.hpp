#pragma once
/// \file The reader of each format; read_matrices picks one. Each throws InputError "matrices.*".
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/matrices/detail/input.hpp"
#include "formats/matrices/matrix.hpp"

namespace bough::matrices::detail {

/// Reads all DMIG of a deck or punch file; the dofs are those of the cards.
std::vector<Matrix> read_dmig(const std::string& path, Diagnostics& diagnostics);
/// Reads a Matrix Market file, coordinate or array; it has no dofs.
std::vector<Matrix> read_matrix_market(const std::string& path);
/// Lines "row column value"; the dofs from a file of the same name that ends in .dof, when there is one.
std::vector<Matrix> read_triplet_lines(const std::string& path);
/// Abaqus matrix input: "node, dof, node, dof, value".
std::vector<Matrix> read_abaqus_labels(const std::string& path);
/// The dofs from a file of the same name that ends in .mapping, when there is one.
std::vector<Matrix> read_harwell_boeing(const std::string& path);
/// Reads the sparse matrices of an HDF5 file of Bough, with its dof_map.
std::vector<Matrix> read_hdf5(const std::string& path);
/// Reads the numeric matrices of a MATLAB file, level 5 or 7.3.
std::vector<Matrix> read_mat(const std::string& path);

}  // namespace bough::matrices::detail
