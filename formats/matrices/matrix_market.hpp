#pragma once
/// \file Matrix Market text (Boisvert, Pozo & Remington, NISTIR 5935).
#include <ostream>
#include <string>

#include "formats/matrices/matrix.hpp"

namespace bough::matrices {

/// Coordinate real symmetric: the lower triangle of a symmetric matrix. `comment`: one line after '%'.
void write_matrix_market(std::ostream& out, const records::SparseMatrix& matrix, const std::string& comment);

}  // namespace bough::matrices
