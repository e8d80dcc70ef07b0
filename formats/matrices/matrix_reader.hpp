#pragma once
/// \file Matrices of other programs (docs/formats/matrices-of-others.md): one function for every format.
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/matrices/matrix.hpp"

namespace bough::matrices {

enum class Format {
  Op4Text,
  Op4Binary,
  Dmig,
  MatrixMarket,
  Hdf5,
  Mat,
  HarwellBoeing,
  AbaqusLabels,  ///< node, dof, node, dof, value
  Triplets,      ///< row column value: CalculiX .sti and .mas, Abaqus COORDINATE
};

/// "Nastran OUTPUT4, binary", ...
std::string_view get_format_name(Format format);

/// From the content, never from the ending. Throws InputError "matrices.cannot-open", "matrices.empty",
/// "matrices.unknown-format".
Format detect_format(const std::string& path);

/// Every matrix of the file, in its order. Throws InputError "matrices.*" with file and line, or record and byte
/// offset. Warnings (a DMIG deck may have some) go to `diagnostics`.
std::vector<Matrix> read_matrices(const std::string& path, Diagnostics& diagnostics);

/// The matrix called `name` (letters of either case; HDF5: a path such as "KG/LOAD_1"). An empty name takes the only
/// matrix of the file; where the format has no names, any name takes it. Throws InputError "matrices.unknown-name"
/// (with what there is), "matrices.several".
Matrix read_matrix(const std::string& path, const std::string& name, Diagnostics& diagnostics);

/// read_matrix for K, M, K_G: throws InputError "matrices.complex" when a value has an imaginary part,
/// "matrices.not-square".
Matrix read_real_square_matrix(const std::string& path, const std::string& name, Diagnostics& diagnostics);

}  // namespace bough::matrices
